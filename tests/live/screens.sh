# Every screen of the kiosk in a real window, reached and left by synthetic keys and pointer, in every language of the work;
# sourced by run.sh. A screen is known by how much of the glass it changes: the page covers all of it, the panel a part, a
# closed house is black. Languages are told by the title's corner, in which nothing else changes.

# A picture of the whole glass.
shot() { import -window root "$room/$1.png"; }
# Share of the glass that differs between two such pictures, or of a part of it.
differs() { changed "$room/$1.png" "$room/$2.png" "${3:-1280x720+0+0}"; }
# A swinging bob and its shadow on the wall change less.
SWINGS=0.05
# Of the title's corner: another language, and the same one. Letters cover a tenth of it.
ANOTHER=0.01
SAME=0.001
# The page is paper from edge to edge.
PAGE=0.3

# Presses L until the first picture is there again: how many languages, each unlike the one before.
languages() { # languages NAME CORNER
    local i alike=0
    shot "$1-0"
    for i in {1..12}; do
        xdotool key l
        # Software graphics may take a second for a picture.
        within 5 turns "$1-$i" "$1-$((i - 1))" "$2" || alike=$((alike + 1))
        holds "$(differs "$1-0" "$1-$i" "$2") < $SAME" && break
    done
    echo "$i $alike"
}

every_screen() {
    local toml=$room/screens.toml count alike wanted back left share code=0 seen
    # What this machine's fonts cannot write is not offered: Korean.
    wanted=$(grep -c '^\[label\.' "$root/exhibits/pendulum/exhibit.toml")
    "$soffio" doctor >"$room/doctor.out" 2>&1 || true
    if grep -q 'Korean: none found' "$room/doctor.out"; then wanted=$((wanted - 1)); fi
    site() {
        printf '[exhibits]\nfolder = "%s"\nshow = ["pendulum", "steel-fish"]\n[visit]\ncalm = true\n[attract]\nidle_s = 45\n%s\n' \
            "$root/exhibits" "${1:-}" >"$toml"
    }
    site
    launch_kiosk screens --config "$toml"
    within 30 picture || true
    within 20 grep -q 'supervisor: microphone: ' "$room/screens.err" || true
    sleep 3

    read -r count alike < <(languages walk-up 400x90+0+620)
    bar "walk-up: languages" "$count == $wanted && $alike == 0" "$count of $wanted, $alike like the one before"
    shot front
    xdotool key Tab
    sleep 1.5
    shot page
    share=$(differs front page)
    read -r count alike < <(languages page 500x300+0+80)
    bar "page: languages" "$share > $PAGE && $count == $wanted && $alike == 0" "$share of the glass; $count of $wanted, $alike like the one before"
    xdotool key Tab
    sleep 1.5
    shot left
    xdotool key Tab
    sleep 1
    before_microphone "$room/strong.wav"
    sleep 1.5
    shot blown
    bar "page: left" "$(differs front left) < $SWINGS && $(differs page blown) > $PAGE" \
        "by its key, $(differs front left) from before; by a breath, $(differs page blown) from the page"

    # The panel has no PIN here: it shows everything and changes nothing.
    xdotool key ctrl+alt+s
    sleep 1.5
    shot panel
    xdotool key ctrl+alt+s
    sleep 1.5
    shot after
    share=$(differs blown panel)
    bar "staff: opened and left" "$share > 0.1 && $(differs panel after) > 0.1" "$share of the glass"

    # The page closes by itself, and then nobody is here.
    xdotool key Tab
    sleep 1.5
    shot page
    within 40 left_page && left=1 || left=0
    within 40 grep -q 'attract mode begins' "$room/screens.err" && seen=1 || seen=0
    sleep 2
    shot attract
    xdotool mousemove 640 300 mousedown 1 sleep 0.3 mouseup 1
    within 2 grep -q 'somebody is here' "$room/screens.err" && back=1 || back=0
    bar "attract: comes, yields" "$left == 1 && $seen == 1 && $back == 1" "the page closed by itself; a touch within 2 s"

    # Closed, opened by staff, closed again, and open by the hours.
    site "[opening]
holidays = [\"$(date +%F)\"]"
    within 5 dark && left=1 || left=0
    xdotool key ctrl+alt+o
    within 5 picture && seen=1 || seen=0
    xdotool key ctrl+alt+o
    within 5 dark || left=0
    shot closed
    site
    within 5 picture && back=1 || back=0
    bar "closed and open" "$left == 1 && $seen == 1 && $back == 1" "by the hours, by staff, and by the hours again"
    end_launcher || code=$?
    bar "no way out" "$code == 130 && $(grep -c 'died' "$room/screens.err") == 0" "it ran until the launcher was ended"
}
turns() { shot "$1" && holds "$(differs "$2" "$1" "$3") > $ANOTHER"; }
left_page() { shot now && holds "$(differs page now) > $PAGE"; }
dark() { ! picture; }
