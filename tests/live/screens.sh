# Every screen of the kiosk in a real window, reached and left by synthetic keys and pointer, in every language of the exhibit. Sourced by
# run.sh. A screen is recognised by the share of the display that it changes: the page covers all of it, the panel a part, and a closed
# venue is black. Languages are recognised by the title's corner, in which nothing else changes.

# Saves a picture of the whole display, uncompressed for speed.
shot() { import -window root "$workdir/$1.ppm"; }
# Share of the display, or of a part of it, that differs between two such pictures.
differs() { changed "$workdir/$1.ppm" "$workdir/$2.ppm" "${3:-1280x720+0+0}"; }
# A swinging bob and its shadow on the wall change less than this share.
SWINGS=0.05
# Shares of the title's corner for another language and for the same one. Letters cover a tenth of it.
ANOTHER=0.01
SAME=0.001
# Shares of the page, which covers the display, and of the panel, which stands beside the picture.
PAGE=0.3
PANEL=0.1

# True where a new picture differs from another one by more than a share, on all of the display or a part of it.
becomes() { shot "$1" && holds "$(differs "$2" "$1" "${4:-}") > $3"; } # becomes NEW OLD SHARE [PART]
# Waits until it does, since software graphics may take seconds for a picture, and then until the picture is stable.
changes() {
    pause=0.3 within 15 becomes "$@" || true
    sleep 0.7
    shot "$1"
}

# Presses L until the first picture returns; prints the number of languages, and of those that look like the one before.
languages() { # languages NAME CORNER
    local i alike=0
    shot "$1-0"
    for i in {1..12}; do
        xdotool key l
        # Software graphics may take a second for a picture.
        pause=0.3 within 15 becomes "$1-$i" "$1-$((i - 1))" $ANOTHER "$2" || alike=$((alike + 1))
        holds "$(differs "$1-0" "$1-$i" "$2") < $SAME" && break
    done
    echo "$i $alike"
}

# Labels as a curator writes them in Hebrew and Arabic.
from_the_right() {
    cat <<'TOML'

[label.he]
title = "מטוטלת"
maker = "Soffio"
body = "מוט פלדה, משקולת פליז וציר אחד. נשפו בקצב שלה, מעט בכל תנודה, והיא תתנדנד רחוק יותר."
alt = "מוט פלדה דק ובקצהו משקולת פליז עגולה."
text = { invite = "נשפו בעדינות." }
caption = { wind = "[הנשימה חולפת]" }

[label.ar]
title = "البندول"
maker = "Soffio"
body = "قضيب من الفولاذ وثقل من النحاس ومفصل واحد. انفخوا على إيقاعه، قليلا في كل تأرجح، فيذهب أبعد."
alt = "قضيب رفيع من الفولاذ في طرفه ثقل مستدير من النحاس."
text = { invite = "انفخوا برفق." }
caption = { wind = "[النفس يمر]" }
TOML
}

every_screen() {
    local toml=$workdir/screens.toml works=$workdir/works count alike wanted back left share code=0 seen
    # One exhibit has labels in right-to-left languages as well.
    mkdir -p "$works"
    cp -r "$root/exhibits/pendulum" "$root/exhibits/steel-fish" "$works"
    from_the_right >>"$works/pendulum/exhibit.toml"
    # Languages without a font on this computer are not offered.
    wanted=$(grep -c '^\[label\.' "$works/pendulum/exhibit.toml")
    "$soffio" doctor >"$workdir/doctor.out" 2>&1 || true
    wanted=$((wanted - $(grep -cE '(Korean|Hebrew|Urdu): none found' "$workdir/doctor.out" || true)))
    site() {
        configured "$toml" '[exhibits]\nfolder = "%s"\nshow = ["pendulum", "steel-fish"]\n[visit]\nreduced_motion = true\npage_closes_s = 18\n[attract]\nidle_s = 24\n%s\n' \
            "$works" "${1:-}"
    }
    site
    launch_kiosk screens --config "$toml"
    within 30 picture || true
    within 20 grep -q 'supervisor: microphone: ' "$workdir/screens.err" || true
    sleep 3

    read -r count alike < <(languages walk-up 400x90+0+620)
    bar "walk-up: languages" "$count == $wanted && $alike == 0" "$count of $wanted, $alike like the one before"
    shot front
    xdotool key Tab
    changes page front $PAGE
    share=$(differs front page)
    read -r count alike < <(languages page 500x300+0+80)
    bar "page: languages" "$share > $PAGE && $count == $wanted && $alike == 0" "$share of the glass; $count of $wanted, $alike like the one before"
    xdotool key Tab
    changes left page $PAGE
    xdotool key Tab
    changes page left $PAGE
    before_microphone "$workdir/strong.wav"
    changes blown page $PAGE
    bar "page: left" "$(differs front left) < $SWINGS && $(differs page blown) > $PAGE" \
        "by its key, $(differs front left) from before; by a breath, $(differs page blown) from the page"

    # Without a PIN the panel shows everything and changes nothing.
    xdotool key ctrl+alt+s
    changes panel blown $PANEL
    xdotool key ctrl+alt+s
    changes after panel $PANEL
    share=$(differs blown panel)
    bar "staff: opened and left" "$share > $PANEL && $(differs panel after) > $PANEL" "$share of the glass"

    # The page closes by itself when the visitor has left.
    xdotool key Tab
    changes page after $PAGE
    pause=0.5 within 40 becomes now page $PAGE && left=1 || left=0
    within 40 grep -q 'attract mode begins' "$workdir/screens.err" && seen=1 || seen=0
    sleep 2
    shot attract
    xdotool mousemove 640 300 mousedown 1 sleep 0.3 mouseup 1
    # The suite tests that it yields in the step of the touch. The window receives a touch between two pictures, which are slow here.
    within 8 grep -q 'attract mode ends' "$workdir/screens.err" && back=1 || back=0
    bar "attract: comes, yields" "$left == 1 && $seen == 1 && $back == 1" "the page closed by itself; a touch gave it back"

    # Closed by its hours, opened by staff, closed again, and open by its hours.
    site "[opening]
holidays = [\"$(date +%F)\"]"
    within 15 dark && left=1 || left=0
    xdotool key ctrl+alt+o
    within 15 picture && seen=1 || seen=0
    xdotool key ctrl+alt+o
    within 15 dark || left=0
    shot closed
    site
    within 15 picture && back=1 || back=0
    bar "closed and open" "$left == 1 && $seen == 1 && $back == 1" "by the hours, by staff, and by the hours again"
    end_launcher || code=$?
    bar "no way out" "$code == 130 && $(grep -c 'died' "$workdir/screens.err") == 0" "it ran until the launcher was ended"
}
# The staff panel: its keypad, a wrong PIN and the right one, each page by its tab, and the cleaning mode.
staff_pages() {
    local toml=$workdir/staff.toml tabs="815,20 879,20 946,20 1005,20 1062,20 1138,20 832,62 903,62 949,62" tab other
    local number=0 alike=0 shut covered pressed back code=0
    # The picture keeps moving beside the panel, and only the first language's title is in its corner.
    local panel=490x720+790+0 title=400x90+0+620 another
    configured "$toml" '[exhibits]\nfolder = "%s"\nshow = ["pendulum"]\n[maintenance]\ncleaning_s = 15\n[attract]\nenabled = false\nidle_s = 20\n[staff]\n%s\nstate = "%s"\nmetrics = "%s"\n' \
        "$root/exhibits" "$(echo 271828 | "$soffio" pin)" "$workdir/staff.state" "$workdir/staff.prom"
    launch_kiosk staff --config "$toml"
    within 30 picture || true
    sleep 3
    shot first
    xdotool key l
    within 15 becomes other first $ANOTHER "$title" && another=1 || another=0
    xdotool key ctrl+alt+s
    changes keypad other $PANEL
    xdotool type 000000
    xdotool key Return
    # Argon2 takes a moment, and a wrong PIN two seconds more.
    sleep 4
    shot wrong
    xdotool type 271828
    xdotool key Return
    within 10 becomes entered keypad $PANEL $panel && shut=1 || shut=0
    bar "staff: only by the PIN" "$(differs keypad wrong $panel) < 0.05 && $shut == 1" \
        "$(differs keypad wrong $panel) of the keypad changed by a wrong one"
    for tab in $tabs; do
        xdotool mousemove "${tab%,*}" "${tab#*,}" click 1
        # The first one is open already.
        if [ "$number" = 0 ]; then shot staff-0; else pause=0.3 within 15 becomes "staff-$number" "staff-$((number - 1))" $ANOTHER $panel || true; fi
        for ((other = 0; other < number; other++)); do
            holds "$(differs "staff-$other" "staff-$number" $panel) > $ANOTHER" || alike=$((alike + 1))
        done
        number=$((number + 1))
    done
    bar "staff: every page" "$alike == 0" "$number pages, $alike like another"

    # All input is off for the cleaning time: neither a key nor a finger ends it; then the picture returns.
    xdotool mousemove 815 20 click 1
    changes before-cleaning "staff-$((number - 1))" $ANOTHER $panel
    xdotool mousemove 855 110 click 1
    changes cleaning before-cleaning $PAGE
    xdotool mousemove 640 300 mousedown 1 sleep 0.3 mouseup 1 key Tab key space
    sleep 1.5
    shot cleaned
    covered=$(differs before-cleaning cleaning)
    pressed=$(differs cleaning cleaned)
    pause=0.5 within 70 becomes now cleaning $PAGE && back=1 || back=0
    bar "cleaning" "$covered > $PAGE && $pressed < 0.02 && $back == 1 && $(breaths staff hold begins | wc -l) == 0" \
        "$covered of the display; $pressed of it changed when pressed; over by itself"
    # The first language returns after the last visitor, without attract mode.
    pause=0.5 within 40 resembles first "$title" && back=1 || back=0
    bar "reset without attract" "$another == 1 && $back == 1" "another language, and the first one after the last visitor"
    end_launcher || true
    if command -v promtool >/dev/null; then
        promtool check metrics <"$workdir/staff.prom" >"$workdir/promtool.out" 2>&1 && code=0 || code=1
        promtool check rules "$root/kiosk-config/prometheus/soffio.rules.yml" >>"$workdir/promtool.out" 2>&1 || code=1
        bar "promtool" "$code == 0 && $(grep -c '^kiosk_' "$workdir/staff.prom") > 20" \
            "$(grep -c '^kiosk_' "$workdir/staff.prom") samples and the alert rules"
    else
        cannot "promtool" "promtool is missing: apt-get install prometheus"
    fi
}
resembles() { shot now && holds "$(differs "$1" now "$2") < $SAME"; }
dark() { ! picture; }
