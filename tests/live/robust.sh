# What a kiosk meets that nobody guards: it is killed, its graphics device dies, the disk is full, its configuration
# breaks, the clock is set, the display goes dark, it dies again and again. Sourced by run.sh after room.sh; each part is
# a function, and ends what it has begun.

state() { # state KEY: a number or word of what is kept, or none
    local found
    found=$(sed -nE "s/^ *\"$1\": \"?([^\",]*)\"?,?\$/\\1/p" "$HOME/.local/state/soffio/state.json" 2>/dev/null)
    echo "${found:-none}"
}
# Seconds of breath that the first work was given today.
given() { awk '/"day"/ { inside = 1 } inside && /^ *[0-9.]+$/ { print $1; exit }' "$HOME/.local/state/soffio/state.json" 2>/dev/null; }

# The kiosk under its launcher, which starts it again; the id of the launcher is in $kiosk.
launch_kiosk() {
    local name=$1
    shift
    rm -rf "$HOME/.local/state/soffio"
    [[ " $* " == *" --config "* ]] || set -- --config "$room/kiosk.toml" "$@"
    start "$name" "$root/kiosk-config/launch" "$soffio" kiosk "$@"
    kiosk=$last
    within 60 grep -q 'pixels on' "$room/$name.err" || true
}

# The program that the launcher runs now.
child() {
    tr ' ' '\n' <"/proc/$kiosk/task/$kiosk/children" | while read -r id; do
        [ "$(readlink "/proc/$id/exe")" != "$soffio" ] || echo "$id"
    done
}

# Ends the launcher as a service manager would; its exit code.
end_launcher() {
    local code=0
    kill -TERM "$kiosk" 2>/dev/null || true
    wait "$kiosk" || code=$?
    return "$code"
}

# Is a picture on the glass? The gallery's wall is light, the display without a window black.
picture() {
    [ "$(import -window root -crop "64x64+$((${screen_size%x*} / 2 - 32))+$((${screen_size#*x} / 7))" -depth 8 gray:- 2>/dev/null | od -An -v -tu1 |
        awk '{ for (i = 1; i <= NF; i++) s += $i; n += NF } END { print (n && s / n > 60) ? 1 : 0 }')" = 1 ]
}

# Seconds until a picture is there again, to a tenth.
until_picture() {
    local from=$1
    until picture; do
        [ "$(awk "BEGIN { print ($(now) - $from > 30) }")" = 0 ] || break
        sleep 0.05
    done
    awk "BEGIN { printf \"%.1f\", $(now) - $from }"
}

# ---- in the compositor, as the shipped unit starts it: a picture, again after kill -9, and nothing left without it ------
# The compositor takes no orders from root; its outputs are windows of this room's display.
compositor() {
    local glass=$room/glass as=() from took left
    for tool in cage Xwayland; do
        command -v "$tool" >/dev/null || { cannot "compositor" "$tool is missing: apt-get install cage xwayland"; return; }
    done
    [ "$(id -u)" != 0 ] || as=(setpriv --reuid=65534 --regid=65534 --clear-groups)
    mkdir -p "$glass/exhibits" "$glass/run"
    cp -r "$root/exhibits/pendulum" "$glass/exhibits/"
    cp "$soffio" "$root/kiosk-config/launch" "$glass/"
    configured "$glass/kiosk.toml" '[exhibits]\nfolder = "%s"\nshow = ["pendulum"]\n' "$glass/exhibits"
    chmod 700 "$glass/run"
    [ "$(id -u)" != 0 ] || { chown -R 65534:65534 "$glass" && chmod 711 "$room"; }
    start cage env -u WAYLAND_DISPLAY XDG_RUNTIME_DIR="$glass/run" HOME="$glass" XDG_CACHE_HOME="$glass/cache" MESA_SHADER_CACHE_DIR="$glass/cache" \
        XDG_CONFIG_HOME="$glass/config" PULSE_SERVER= WLR_BACKENDS=x11 WLR_RENDERER=pixman WLR_LIBINPUT_NO_DEVICES=1 \
        "${as[@]}" cage -d -- "$glass/launch" "$glass/soffio" kiosk --config "$glass/kiosk.toml"
    left=$last
    within 40 picture && took=1 || took=0
    bar "compositor: a picture" "$took == 1" "in a window of Wayland"
    from=$(now)
    pkill -9 -f "^$glass/soffio kiosk"
    within 5 dark || true
    took=$(until_picture "$from")
    bar "compositor: again" "$took < 4" "$took s after kill -9"
    kill -9 "$left"
    within 10 nothing_of "$glass" && left=0 || left=1
    bar "compositor: gone" "$left == 0" "kiosk and launcher end with it"
}
nothing_of() { ! pgrep -f "$1/(launch|soffio)" >/dev/null; }

# ---- kill -9: the same work is back, muted as it was, and nothing that was counted is lost ----------------------------
killed() {
    local t took before after pid second
    configured "$room/killed.toml" '[exhibits]\nfolder = "%s"\nshow = ["pendulum", "steel-fish"]\n[attract]\nenabled = false\n' "$root/exhibits"
    launch_kiosk killed --config "$room/killed.toml"
    within 30 picture || true
    # Another work than the first, two held breaths, and mute.
    within 20 grep -q 'supervisor: microphone: ' "$room/killed.err" || true
    sleep 2
    xdotool key Next
    within 20 grep -q 'steel-fish is on show' "$room/killed.err" || true
    for _ in 1 2; do
        hold killed 1
        sleep 0.5
    done
    xdotool key ctrl+alt+m
    sleep 2.5
    before=$(state hold)
    pid=$(child)
    t=$(now)
    kill -9 "$pid"
    # The display has to have lost the old picture first.
    until ! picture; do sleep 0.02; done
    took=$(until_picture "$t")
    bar "killed: picture back" "$took < 4" "$took s after kill -9"
    within 10 test "$(child)" != "" || true
    sleep 3
    hold killed 1
    sleep 3
    after=$(state hold)
    bar "killed: counters kept" "\"$before\" == \"2\" && \"$after\" == \"3\" && $(state starts) == 2" \
        "$before held breaths before, $after after another one, $(state starts) starts"
    second=$(grep -c 'steel-fish is on show\|goes on with what it kept' "$room/killed.err")
    bar "killed: as it was left" "\"$(state on_show)\" == \"steel-fish\" && \"$(state muted)\" == \"true\" && $second == 2" \
        "$(state on_show) on show, muted: $(state muted)"
    local code=0
    end_launcher || code=$?
    bar "killed: an end is an end" "$code == 130 && \"$(state life)\" == \"ended\"" "exit code $code, life: $(state life)"
}

# ---- it dies again and again: safe mode, a built-in work, and staff are told ------------------------------------------
crash_loop() {
    local i pid saw
    launch_kiosk loop --exhibit "$exhibit" --no-attract
    for i in 1 2 3; do
        within 20 pixels loop "$i" || true
        sleep 0.5
        kill -9 "$(child)"
    done
    within 20 pixels loop 4 || true
    within 20 picture || true
    sleep 2.5
    saw=$(grep -c 'safe mode: the kiosk died' "$room/loop.err" || true)
    bar "crash loop: safe mode" "$saw == 1 && \"$(state on_show)\" == \"pendulum\" && $(state deaths) == 3" \
        "$(state deaths) deaths, $(state on_show) on show, staff told $saw times"
    end_launcher || true
    # Where nothing can be kept the launcher has counted.
    XDG_STATE_HOME=/dev/null launch_kiosk unkept --exhibit "$exhibit" --no-attract
    for i in 1 2 3; do
        within 20 pixels unkept "$i" || true
        kill -9 "$(child)"
    done
    within 20 pixels unkept 4 || true
    saw=$(grep -c 'safe mode: the kiosk died' "$room/unkept.err" || true)
    bar "crash loop: without a disk" "$saw == 1 && $(grep -c 'nothing outlives this run' "$room/unkept.err") == 4" \
        "staff told $saw times"
    end_launcher || true
}
pixels() { [ "$(grep -c 'pixels on' "$room/$1.err")" -ge "$2" ]; }

# ---- the graphics device dies: a new one in the old window, the motion never stopped -----------------------------------
gpu_lost() {
    local t took rows gaps code=0
    start_kiosk gpu --no-attract --lose-device-at 5 --trace "$room/gpu.csv" --for 16
    within 15 grep -q 'graphics device is destroyed' "$room/gpu.err" || true
    t=$(log_times gpu 'graphics device is destroyed' | tail -1)
    # A picture of the new device: the moment a held breath is seen in one.
    within 15 grep -q 'a new graphics device' "$room/gpu.err" || true
    took=$(awk "BEGIN { printf \"%.1f\", $(log_times gpu 'a new graphics device' | tail -1) - $t }")
    import -window root "$room/gpu.png"
    picture && seen=1 || seen=0
    bar "graphics lost: back" "$took < 3 && $seen == 1" "$took s to the first picture of the new device"
    end_kiosk gpu || code=$?
    read -r rows gaps < <(gaps "$room/gpu.csv")
    bar "graphics lost: motion" "$code == 0 && $rows >= 950 && $gaps == 0" "$rows moments in 16 s, $gaps gaps, exit code $code"
}
# Moments of a trace, 60 a second, and how many are missing between them.
gaps() {
    awk -F, 'FNR > 2 && $1 - t > 0.018 { gaps++ } FNR > 1 { t = $1; times[$1] } END { print length(times), gaps + 0 }' "$1"
}

# ---- microphone and loudspeaker are out for long, and come back: heard and sounding within three seconds ----------------
devices_out() {
    local t ears voice rows gaps code=0
    # By its name, or another loudspeaker takes its place.
    configured "$room/out.toml" '[exhibits]\nshow = ["steel-fish"]\n[audio]\noutput = "speakers"\n'
    start_kiosk out --no-attract --config "$room/out.toml" --trace "$room/out.csv" --for 28
    within 30 grep -q 'supervisor: microphone: ' "$room/out.err" || true
    within 30 grep -q 'supervisor: loudspeaker: ' "$room/out.err" || true
    pull_microphone
    pull_loudspeaker
    # Longer than the growing pauses between two tries need to be at their longest.
    sleep 12
    t=$(now)
    plug_loudspeaker
    plug_microphone
    within 10 spoken out 'supervisor: microphone: ' 2 || true
    within 10 spoken out 'supervisor: loudspeaker: ' 2 || true
    end_kiosk out || code=$?
    ears=$(awk "BEGIN { printf \"%.3f\", $(log_times out 'supervisor: microphone: ' | tail -1) - $t }")
    voice=$(awk "BEGIN { printf \"%.3f\", $(log_times out 'supervisor: loudspeaker: ' | tail -1) - $t }")
    bar "devices out: back" "$code == 0 && $ears > 0 && $ears < 3 && $voice > 0 && $voice < 3" \
        "the microphone after $ears s, the loudspeaker after $voice s"
    read -r rows gaps < <(gaps "$room/out.csv")
    bar "devices out: motion" "$rows >= 1670 && $gaps == 0" "$rows moments in 28 s, $gaps gaps"
}

# ---- what the suite asks of real devices, and of a sound server that dies ---------------------------------------------
devices() { # devices SUITE
    local code=0 test
    "$1" realtime::server --ignored --skip a_lost_server --test-threads 1 >"$room/devices.out" 2>&1 || code=$?
    bar "devices of the suite" "$code == 0 && $(grep -c '^test .* ok$' "$room/devices.out") == 2" \
        "$(grep '^test result' "$room/devices.out")"
    start lost "$1" realtime::server::a_lost_server --ignored --nocapture
    test=$last
    sleep 3
    kill -9 "$server"
    sleep 3
    # Who is killed leaves the socket behind.
    rm -f "$room/run/pulse/native"
    start_server
    wait "$test" && code=0 || code=$?
    bar "the server dies" "$code == 0 && $(grep -c '^test .* ok$' "$room/lost.out") == 1" \
        "$(grep '^test result' "$room/lost.out")"
}

# ---- the disk is full: said once, and the kiosk goes on ----------------------------------------------------------------
# No file may grow beyond nothing (RLIMIT_FSIZE), which is what a full disk does to a write; the log is a pipe.
disk_full() {
    local seen code=0 said
    configured "$room/full.toml" '[exhibits]\nshow = ["steel-fish"]\n[staff]\nmetrics = "%s"\nstate = "%s"\n' "$room/full.prom" "$room/full"
    mkdir -p "$room/full"
    mkfifo "$room/full.pipe"
    # shellcheck disable=SC2016
    start full sh -c 'cat "$0" >&2' "$room/full.pipe"
    # shellcheck disable=SC2016
    start filled bash -c 'trap "" XFSZ; ulimit -f 0; exec "$@" >"$0" 2>&1' "$room/full.pipe" \
        timeout --kill-after=20 60 "$soffio" kiosk --exhibit "$exhibit" --config "$room/full.toml" --no-attract --for 22
    kiosk=$last
    within 60 grep -q 'pixels on' "$room/full.err" || true
    sleep 4
    hold full 1
    picture && seen=1 || seen=0
    wait "$kiosk" || code=$?
    said=$(grep -c 'WARN.*cannot write' "$room/full.err" || true)
    bar "disk full: goes on" "$code == 0 && $seen == 1 && $(breaths full hold begins | wc -l) == 1" \
        "exit code $code, a picture, $(breaths full hold begins | wc -l) breath"
    # The start, the copy of the configuration, the state and the metrics: once each, however often they are tried.
    bar "disk full: said once" "$said == 4 && $(find "$room/full" -type f | wc -l) == 0" \
        "$said warnings, $(find "$room/full" -type f | wc -l) half-written files"
}

# ---- the configuration breaks while it runs, and at the next start ------------------------------------------------------
config_broken() {
    local t took code=0 toml=$room/site.toml
    configured "$toml" '[exhibits]\nfolder = "%s"\nshow = ["pendulum"]\n[visit]\nbreath = false\n' "$root/exhibits"
    launch_kiosk site --config "$toml" --no-attract
    within 20 picture || true
    sleep 1
    printf '[visit]\nbreth = tru\n[[[' >"$toml"
    within 5 grep -q 'last good configuration stays' "$room/site.err" || true
    picture && seen=1 || seen=0
    bar "config broken: stays" "$seen == 1 && $(grep -c 'last good configuration stays' "$room/site.err") == 1" "refused, the picture stays"
    # And killed in this state: no guard is there to mend the file.
    t=$(now)
    kill -9 "$(child)"
    until ! picture; do sleep 0.02; done
    took=$(until_picture "$t")
    # And once more: the copy is of the good one still.
    sleep 1
    kill -9 "$(child)"
    until ! picture; do sleep 0.02; done
    within 10 picture || true
    bar "config broken: restart" "$took < 4 && $(grep -c 'taken instead' "$room/site.err") == 2 && \"$(state on_show)\" == \"pendulum\"" \
        "$took s to a picture, with the last good configuration, and again"
    configured "$toml" '[exhibits]\nfolder = "%s"\nshow = ["pendulum"]\n[visit]\nbreath = true\n' "$root/exhibits"
    within 5 grep -q 'changed configuration is taken over' "$room/site.err" && seen=1 || seen=0
    bar "config mended" "$seen == 1" "taken over"
    end_launcher || code=$?
}

# ---- the wall clock is set, a day on and two back: motion, visits and counters know nothing of it -----------------------
clock_set() {
    local rows gaps code=0 library given began lasted
    library=$(find /usr/lib -name libfaketimeMT.so.1 2>/dev/null | head -1)
    if [ -z "$library" ]; then
        cannot "clock set" "libfaketimeMT.so.1 is missing: apt-get install faketime"
        return
    fi
    rm -rf "$HOME/.local/state/soffio"
    echo '+0d' >"$room/clock"
    # The clock that only goes forward is not touched, as when a real clock is set.
    LD_PRELOAD=$library FAKETIME_TIMESTAMP_FILE=$room/clock FAKETIME_NO_CACHE=1 DONT_FAKE_MONOTONIC=1 \
        FAKETIME_DONT_FAKE_MONOTONIC=1 limit=200 start_kiosk clock --no-attract --trace "$room/clock.csv"
    began=$(now)
    sleep 3
    for offset in +1d -1d +0d; do
        hold clock 1
        sleep 2
        given="${given:-} $(given)"
        echo "$offset" >"$room/clock"
        sleep 1
    done
    hold clock 1
    sleep 1
    lasted=$(awk "BEGIN { print $(now) - $began }")
    leave_kiosk clock || code=$?
    read -r rows gaps < <(gaps "$room/clock.csv")
    bar "clock set: motion" "$code == 0 && $rows >= 60 * $lasted - 120 && $gaps == 0" "$rows moments in $lasted s, of which two may go by before the first, $gaps gaps"
    bar "clock set: counters" "$(state hold) == 4 && $(cut -c1-10 "$room/clock.err" | sort -u | grep -c '^20') >= 3" \
        "$(state hold) held breaths on $(cut -c1-10 "$room/clock.err" | sort -u | grep -c '^20') dates, seconds given each day:$given"
}

# ---- the display goes dark, small, and comes back ------------------------------------------------------------------------
# To a program a display that is switched off is an output that goes, and a window that is off the screen. Both happen
# here, and another display of another size takes its place for a while. Power saving (DPMS) this display does not have.
monitor_off() {
    local window rows gaps code=0 t took seen
    start_kiosk dark --no-attract --trace "$room/dark.csv" --for 30
    within 15 picture || true
    window=$(xdotool search --name '^Soffio$' | tail -1)
    xrandr --fb 1280x720 --output screen --off
    xdotool windowminimize "$window"
    sleep 4
    picture && seen=1 || seen=0
    bar "monitor off: dark" "$seen == 0 && $(xrandr | grep -c '1280x720+0+0') == 0" "no output, no window on it"
    t=$(now)
    xrandr --output screen --auto
    xdotool windowactivate "$window"
    took=$(until_picture "$t")
    bar "monitor on: picture" "$took < 3" "$took s"
    # Another display: the window is as large as it is, and the picture in it.
    xrandr --newmode small 50 960 1000 1100 1200 540 550 560 580
    xrandr --addmode screen small
    xrandr --output screen --mode small
    within 3 width_of "$window" 960 && seen=1 || seen=0
    t=$(now)
    xrandr --output screen --mode 1280x720
    within 3 width_of "$window" 1280 || seen=0
    took=$(until_picture "$t")
    bar "monitor changed: picture" "$seen == 1 && $took < 3" "as large as 960x540 and as 1280x720; a picture after $took s"
    end_kiosk dark || code=$?
    read -r rows gaps < <(gaps "$room/dark.csv")
    bar "monitor off: motion" "$code == 0 && $rows >= 1790 && $gaps == 0" "$rows moments in 30 s, $gaps gaps, exit code $code"
}
width_of() { xdotool getwindowgeometry "$1" | grep -q "Geometry: $2x"; }

# ---- a broker in the house: status, state, orders, and the last will ----------------------------------------------------
broker() {
    local port=18830 toml=$room/broker.toml heard=$room/broker.heard topic=museum/hall-2/soffio
    local PATH=$PATH:/usr/sbin
    if ! command -v mosquitto >/dev/null || ! command -v mosquitto_sub >/dev/null; then
        cannot "broker" "a broker or its client is missing: apt-get install mosquitto mosquitto-clients"
        return
    fi
    while (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do port=$((port + 1)); done
    # Whoever has no password is not heard.
    touch "$room/mosquitto.passwords"
    mosquitto_passwd -b "$room/mosquitto.passwords" hall secret 2>/dev/null
    printf 'listener %s 127.0.0.1\nallow_anonymous false\npassword_file %s\n' "$port" "$room/mosquitto.passwords" >"$room/mosquitto.conf"
    chmod 755 "$room"
    chmod 644 "$room/mosquitto.passwords"
    configured "$toml" '[exhibits]\nfolder = "%s"\nshow = ["pendulum", "steel-fish"]\n[mqtt]\nbroker = "127.0.0.1:%s"\ntopic = "%s"\nuser = "hall"\npassword = "secret"\n' \
        "$root/exhibits" "$port" "$topic"
    # The kiosk is first, and the broker comes later.
    launch_kiosk broker --config "$toml" --no-attract
    start mosquitto mosquitto -c "$room/mosquitto.conf"
    local server=$last
    local at=(-p "$port" -u hall -P secret)
    within 10 mosquitto_pub "${at[@]}" -t x -m x || true
    start heard mosquitto_sub "${at[@]}" -t "$topic/#" -F '%t %r %p'
    within 15 said_by_kiosk "$topic/status . online" || true
    within 15 said_by_kiosk "\"exhibit\":\"pendulum\"" || true
    bar "broker: status and state" "$(grep -c "$topic/status . online" "$room/heard.out") >= 1 && $(grep -c '"exhibit":"pendulum"' "$room/heard.out") >= 1" \
        "$(head -c 300 "$room/heard.out" | tr '\n' ' ' | cut -c1-120)"
    local tell=(mosquitto_pub "${at[@]}" -t "$topic/cmd" -q 1)
    "${tell[@]}" -m 'exhibit steel-fish'
    within 10 said_by_kiosk '"exhibit":"steel-fish"' || true
    "${tell[@]}" -m 'mute on'
    within 10 said_by_kiosk '"muted":true' || true
    "${tell[@]}" -m blank
    within 10 said_by_kiosk '"blank":true' || true
    sleep 1
    picture && seen=1 || seen=0
    bar "broker: blank is black" "$seen == 0" "no picture"
    "${tell[@]}" -m wake
    within 10 picture && seen=1 || seen=0
    "${tell[@]}" -m reload
    within 10 test "$(grep -c 'steel-fish is on show' "$room/broker.err")" -ge 1 || true
    "${tell[@]}" -m shutdown
    within 5 grep -q '"shutdown" is no order' "$room/broker.err" || true
    sleep 2
    bar "broker: orders" "$seen == 1 && $(grep -c 'steel-fish is on show' "$room/broker.err") == 2 && $(grep -c '"muted":true' "$room/heard.out") >= 1 && $(grep -c 'is no order' "$room/broker.err") == 1" \
        "another work, mute, blank, wake, reload; no other word"
    # It is killed, and the launcher with it: the broker itself says so.
    local pid
    pid=$(child)
    kill -9 "$kiosk"
    kill -9 "$pid"
    wait "$kiosk" 2>/dev/null || true
    within 10 said_by_kiosk "$topic/status . offline" && seen=1 || seen=0
    bar "broker: last will" "$seen == 1" "offline, by the broker, after kill -9"
    # An order from before its time is not obeyed, and a broker that goes away stops nothing.
    "${tell[@]}" -r -m blank
    launch_kiosk broker_gone --config "$toml" --no-attract
    within 10 grep -q 'is told as' "$room/broker_gone.err" || true
    kill "$server"
    wait "$server" 2>/dev/null || true
    sleep 3
    picture && seen=1 || seen=0
    bar "broker: gone" "$seen == 1 && $(grep -c '"blank" is not obeyed' "$room/broker_gone.err") == 1 && $(grep -c 'does not answer' "$room/broker_gone.err") == 1" "said once, the picture stays"
    end_launcher || true
}
said_by_kiosk() { grep -q "$1" "$room/heard.out"; }
