# Robustness of an unattended kiosk: it is killed, its graphics device dies, the disk is full, its configuration breaks, the clock is
# set, the display goes dark, it crashes repeatedly. Sourced by run.sh after environment.sh. Each part is a function that ends all
# processes it has started.

state() { # state KEY: a value of the persisted state, or none
    local found
    found=$(sed -nE "s/^ *\"$1\": \"?([^\",]*)\"?,?\$/\\1/p" "$HOME/.local/state/soffio/state.json" 2>/dev/null)
    echo "${found:-none}"
}
# Seconds of breath at the first exhibit today.
given() { awk '/"day"/ { inside = 1 } inside && /^ *[0-9.]+$/ { print $1; exit }' "$HOME/.local/state/soffio/state.json" 2>/dev/null; }

# Starts the kiosk under its launcher, which restarts it; the process id of the launcher is in $kiosk.
launch_kiosk() {
    local name=$1
    shift
    rm -rf "$HOME/.local/state/soffio"
    [[ " $* " == *" --config "* ]] || set -- --config "$workdir/kiosk.toml" "$@"
    start "$name" "$root/kiosk-config/launch" "$soffio" kiosk "$@"
    kiosk=$last
    within 60 grep -q 'pixels on' "$workdir/$name.err" || true
}

# Process id of the program that the launcher runs.
child() {
    tr ' ' '\n' <"/proc/$kiosk/task/$kiosk/children" | while read -r id; do
        [ "$(readlink "/proc/$id/exe")" != "$soffio" ] || echo "$id"
    done
}

# Ends the launcher as a service manager would; returns its exit code.
end_launcher() {
    local code=0
    kill -TERM "$kiosk" 2>/dev/null || true
    wait "$kiosk" || code=$?
    return "$code"
}

# True where a picture is on the display: the gallery's wall is light, and a display without a window is black.
picture() {
    [ "$(import -window root -crop "64x64+$((${screen_size%x*} / 2 - 32))+$((${screen_size#*x} / 7))" -depth 8 gray:- 2>/dev/null | od -An -v -tu1 |
        awk '{ for (i = 1; i <= NF; i++) s += $i; n += NF } END { print (n && s / n > 60) ? 1 : 0 }')" = 1 ]
}

# Seconds until a picture is shown again, to a tenth.
until_picture() {
    local from=$1
    until picture; do
        [ "$(awk "BEGIN { print ($(now) - $from > 30) }")" = 0 ] || break
        sleep 0.05
    done
    awk "BEGIN { printf \"%.1f\", $(now) - $from }"
}

# ---- in the compositor, as the shipped unit starts it: a picture, also after kill -9, and an end with the compositor ----
# The compositor does not run as root; its outputs are windows of this environment's display.
compositor() {
    local glass=$workdir/glass as=() from took left
    for tool in cage Xwayland; do
        command -v "$tool" >/dev/null || { cannot "compositor" "$tool is missing: apt-get install cage xwayland"; return; }
    done
    [ "$(id -u)" != 0 ] || as=(setpriv --reuid=65534 --regid=65534 --clear-groups)
    mkdir -p "$glass/exhibits" "$glass/run"
    cp -r "$root/exhibits/pendulum" "$glass/exhibits/"
    cp "$soffio" "$root/kiosk-config/launch" "$glass/"
    configured "$glass/kiosk.toml" '[exhibits]\nfolder = "%s"\nshow = ["pendulum"]\n' "$glass/exhibits"
    chmod 700 "$glass/run"
    [ "$(id -u)" != 0 ] || { chown -R 65534:65534 "$glass" && chmod 711 "$workdir"; }
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

# ---- kill -9: the same exhibit returns, still muted, with all its counters ---------------------------------------------
killed() {
    local t took before after pid second
    configured "$workdir/killed.toml" '[exhibits]\nfolder = "%s"\nshow = ["pendulum", "steel-fish"]\n[attract]\nenabled = false\n' "$root/exhibits"
    launch_kiosk killed --config "$workdir/killed.toml"
    within 30 picture || true
    # Another exhibit than the first, two held breaths, and mute.
    within 20 grep -q 'supervisor: microphone: ' "$workdir/killed.err" || true
    sleep 2
    xdotool key Next
    within 20 grep -q 'steel-fish is on show' "$workdir/killed.err" || true
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
    # Wait until the old picture has gone.
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
    second=$(grep -c 'steel-fish is on show\|restores its state' "$workdir/killed.err")
    bar "killed: state restored" "\"$(state on_show)\" == \"steel-fish\" && \"$(state muted)\" == \"true\" && $second == 2" \
        "$(state on_show) on show, muted: $(state muted)"
    local code=0
    end_launcher || code=$?
    bar "killed: orderly end" "$code == 130 && \"$(state phase)\" == \"ended\"" "exit code $code, phase: $(state phase)"
}

# ---- repeated crashes: safe mode with a built-in exhibit, and a message for staff -------------------------------------
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
    saw=$(grep -c 'safe mode: the kiosk crashed' "$workdir/loop.err" || true)
    bar "crash loop: safe mode" "$saw == 1 && \"$(state on_show)\" == \"pendulum\" && $(state start_crashes) == 3" \
        "$(state start_crashes) crashes, $(state on_show) on show, $saw messages for staff"
    end_launcher || true
    # With another exhibit on offer, the one that was on show is set aside instead.
    rm -rf "$workdir/home/.local/state/soffio"
    configured "$workdir/two.toml" '[exhibits]\nfolder = "%s"\nshow = ["steel-fish", "chains"]\n' "$root/exhibits"
    launch_kiosk two --config "$workdir/two.toml" --no-attract
    for i in 1 2 3; do
        within 20 pixels two "$i" || true
        sleep 0.5
        kill -9 "$(child)"
    done
    within 20 pixels two 4 || true
    within 20 picture || true
    sleep 2.5
    saw=$(grep -c 'steel-fish is set aside' "$workdir/two.err" || true)
    bar "crash loop: set aside" "$saw >= 1 && \"$(state on_show)\" == \"chains\" && $(grep -c 'safe mode' "$workdir/two.err") == 0" \
        "$(state on_show) on show, $saw messages for staff"
    end_launcher || true
    rm -rf "$workdir/home/.local/state/soffio"
    # Where no state can be stored, the launcher counts.
    XDG_STATE_HOME=/dev/null launch_kiosk unkept --exhibit "$exhibit" --no-attract
    for i in 1 2 3; do
        within 20 pixels unkept "$i" || true
        kill -9 "$(child)"
    done
    within 20 pixels unkept 4 || true
    saw=$(grep -c 'safe mode: the kiosk crashed' "$workdir/unkept.err" || true)
    bar "crash loop: without a disk" "$saw == 1 && $(grep -c 'no state is kept after this run' "$workdir/unkept.err") == 4" \
        "$saw messages for staff"
    end_launcher || true
}
pixels() { [ "$(grep -c 'pixels on' "$workdir/$1.err")" -ge "$2" ]; }

# ---- the graphics device dies: a new one in the old window, and the motion never stops --------------------------------
gpu_lost() {
    local t took rows gaps code=0
    start_kiosk gpu --no-attract --lose-device-at 5 --trace "$workdir/gpu.csv" --for 16
    within 15 grep -q 'graphics device is destroyed' "$workdir/gpu.err" || true
    t=$(log_times gpu 'graphics device is destroyed' | tail -1)
    # A picture of the new device is one that shows the held breath.
    within 15 grep -q 'a new graphics device' "$workdir/gpu.err" || true
    took=$(awk "BEGIN { printf \"%.1f\", $(log_times gpu 'a new graphics device' | tail -1) - $t }")
    import -window root "$workdir/gpu.png"
    picture && seen=1 || seen=0
    bar "graphics lost: back" "$took < 3 && $seen == 1" "$took s to the first picture of the new device"
    end_kiosk gpu || code=$?
    read -r rows gaps < <(gaps "$workdir/gpu.csv")
    bar "graphics lost: motion" "$code == 0 && $rows >= 950 && $gaps == 0" "$rows moments in 16 s, $gaps gaps, exit code $code"
}
# Number of moments in a trace (60 a second), and of gaps between them.
gaps() {
    awk -F, 'FNR > 2 && $1 - t > 0.018 { gaps++ } FNR > 1 { t = $1; times[$1] } END { print length(times), gaps + 0 }' "$1"
}

# ---- microphone and loudspeaker are unplugged for long: both work again within three seconds ----------------------------
devices_out() {
    local t microphone loudspeaker rows gaps code=0
    # The loudspeaker is configured by name, or another one would replace it.
    configured "$workdir/out.toml" '[exhibits]\nshow = ["steel-fish"]\n[audio]\noutput = "speakers"\n'
    start_kiosk out --no-attract --config "$workdir/out.toml" --trace "$workdir/out.csv" --for 28
    within 30 grep -q 'supervisor: microphone: ' "$workdir/out.err" || true
    within 30 grep -q 'supervisor: loudspeaker: ' "$workdir/out.err" || true
    pull_microphone
    pull_loudspeaker
    # Long enough for the growing pauses between two tries to reach their maximum.
    sleep 12
    t=$(now)
    plug_loudspeaker
    plug_microphone
    within 10 spoken out 'supervisor: microphone: ' 2 || true
    within 10 spoken out 'supervisor: loudspeaker: ' 2 || true
    end_kiosk out || code=$?
    microphone=$(awk "BEGIN { printf \"%.3f\", $(log_times out 'supervisor: microphone: ' | tail -1) - $t }")
    loudspeaker=$(awk "BEGIN { printf \"%.3f\", $(log_times out 'supervisor: loudspeaker: ' | tail -1) - $t }")
    bar "devices out: back" "$code == 0 && $microphone > 0 && $microphone < 3 && $loudspeaker > 0 && $loudspeaker < 3" \
        "the microphone after $microphone s, the loudspeaker after $loudspeaker s"
    read -r rows gaps < <(gaps "$workdir/out.csv")
    bar "devices out: motion" "$rows >= 1670 && $gaps == 0" "$rows moments in 28 s, $gaps gaps"
}

# ---- the suite's tests with real devices, and with a sound server that dies --------------------------------------------
devices() { # devices SUITE
    local code=0 test
    "$1" realtime::server --ignored --skip a_lost_server --test-threads 1 >"$workdir/devices.out" 2>&1 || code=$?
    bar "devices of the suite" "$code == 0 && $(grep -c '^test .* ok$' "$workdir/devices.out") == 2" \
        "$(grep '^test result' "$workdir/devices.out")"
    start lost "$1" realtime::server::a_lost_server --ignored --nocapture
    test=$last
    sleep 3
    kill -9 "$server"
    sleep 3
    # A killed server leaves its socket behind.
    rm -f "$workdir/run/pulse/native"
    start_server
    wait "$test" && code=0 || code=$?
    bar "the server dies" "$code == 0 && $(grep -c '^test .* ok$' "$workdir/lost.out") == 1" \
        "$(grep '^test result' "$workdir/lost.out")"
}

# ---- the disk is full: reported once, and the kiosk keeps running -------------------------------------------------------
# A file size limit of 0 (RLIMIT_FSIZE) makes every write fail, as on a full disk; the log is a pipe.
disk_full() {
    local seen code=0 said
    configured "$workdir/full.toml" '[exhibits]\nshow = ["steel-fish"]\n[staff]\nmetrics = "%s"\nstate = "%s"\n' "$workdir/full.prom" "$workdir/full"
    mkdir -p "$workdir/full"
    mkfifo "$workdir/full.pipe"
    # shellcheck disable=SC2016
    start full sh -c 'cat "$0" >&2' "$workdir/full.pipe"
    # shellcheck disable=SC2016
    start filled bash -c 'trap "" XFSZ; ulimit -f 0; exec "$@" >"$0" 2>&1' "$workdir/full.pipe" \
        timeout --kill-after=20 60 "$soffio" kiosk --exhibit "$exhibit" --config "$workdir/full.toml" --no-attract --for 22
    kiosk=$last
    within 60 grep -q 'pixels on' "$workdir/full.err" || true
    sleep 4
    hold full 1
    picture && seen=1 || seen=0
    wait "$kiosk" || code=$?
    said=$(grep -c 'WARN.*cannot write' "$workdir/full.err" || true)
    bar "disk full: keeps running" "$code == 0 && $seen == 1 && $(breaths full hold begins | wc -l) == 1" \
        "exit code $code, a picture, $(breaths full hold begins | wc -l) breath"
    # Start, copy of the configuration, state and metrics are reported once each, however often they are tried.
    bar "disk full: reported once" "$said == 4 && $(find "$workdir/full" -type f ! -name kiosk.lock | wc -l) == 0" \
        "$said warnings, $(find "$workdir/full" -type f ! -name kiosk.lock | wc -l) half-written files"
}

# ---- the configuration breaks while it runs, and at the next start ------------------------------------------------------
config_broken() {
    local t took code=0 toml=$workdir/site.toml
    configured "$toml" '[exhibits]\nfolder = "%s"\nshow = ["pendulum"]\n[visit]\nbreath = false\n' "$root/exhibits"
    launch_kiosk site --config "$toml" --no-attract
    within 20 picture || true
    sleep 1
    printf '[visit]\nbreth = tru\n[[[' >"$toml"
    within 5 grep -q 'last valid configuration stays' "$workdir/site.err" || true
    picture && seen=1 || seen=0
    bar "config broken: stays" "$seen == 1 && $(grep -c 'last valid configuration stays' "$workdir/site.err") == 1" "refused, the picture stays"
    # It is killed in this state, while the file is still broken.
    t=$(now)
    kill -9 "$(child)"
    until ! picture; do sleep 0.02; done
    took=$(until_picture "$t")
    # Once more: the copy must still be the valid one.
    sleep 1
    kill -9 "$(child)"
    until ! picture; do sleep 0.02; done
    within 10 picture || true
    bar "config broken: restart" "$took < 4 && $(grep -c 'taken instead' "$workdir/site.err") == 2 && \"$(state on_show)\" == \"pendulum\"" \
        "$took s to a picture, with the last good configuration, and again"
    configured "$toml" '[exhibits]\nfolder = "%s"\nshow = ["pendulum"]\n[visit]\nbreath = true\n' "$root/exhibits"
    within 5 grep -q 'changed configuration is taken over' "$workdir/site.err" && seen=1 || seen=0
    bar "config mended" "$seen == 1" "taken over"
    end_launcher || code=$?
}

# ---- the wall clock is set a day forward and two back, without effect on motion, visits and counters --------------------
clock_set() {
    local rows gaps code=0 library given began lasted
    library=$(find /usr/lib -name libfaketimeMT.so.1 2>/dev/null | head -1)
    if [ -z "$library" ]; then
        cannot "clock set" "libfaketimeMT.so.1 is missing: apt-get install faketime"
        return
    fi
    rm -rf "$HOME/.local/state/soffio"
    echo '+0d' >"$workdir/clock"
    # The monotonic clock is not changed, as when a real clock is set.
    LD_PRELOAD=$library FAKETIME_TIMESTAMP_FILE=$workdir/clock FAKETIME_NO_CACHE=1 DONT_FAKE_MONOTONIC=1 \
        FAKETIME_DONT_FAKE_MONOTONIC=1 limit=200 start_kiosk clock --no-attract --trace "$workdir/clock.csv"
    began=$(now)
    sleep 3
    for offset in +1d -1d +0d; do
        hold clock 1
        sleep 2
        given="${given:-} $(given)"
        echo "$offset" >"$workdir/clock"
        sleep 1
    done
    hold clock 1
    sleep 1
    lasted=$(awk "BEGIN { print $(now) - $began }")
    leave_kiosk clock || code=$?
    read -r rows gaps < <(gaps "$workdir/clock.csv")
    bar "clock set: motion" "$code == 0 && $rows >= 60 * $lasted - 120 && $gaps == 0" "$rows moments in $lasted s, of which two may go by before the first, $gaps gaps"
    bar "clock set: counters" "$(state hold) == 4 && $(cut -c1-10 "$workdir/clock.err" | sort -u | grep -c '^20') >= 3" \
        "$(state hold) held breaths on $(cut -c1-10 "$workdir/clock.err" | sort -u | grep -c '^20') dates, seconds given each day:$given"
}

# ---- the display is switched off, replaced by a smaller one, and switched on again --------------------------------------
# A program sees a display that is switched off as a removed output, and its window as off the screen. Both happen here, and a display of
# another size replaces it for a while. The virtual display has no power saving (DPMS).
monitor_off() {
    local window rows gaps code=0 t took seen
    start_kiosk dark --no-attract --trace "$workdir/dark.csv" --for 30
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
    # Another display: the window must fill it, with a picture.
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
    read -r rows gaps < <(gaps "$workdir/dark.csv")
    bar "monitor off: motion" "$code == 0 && $rows >= 1790 && $gaps == 0" "$rows moments in 30 s, $gaps gaps, exit code $code"
}
width_of() { xdotool getwindowgeometry "$1" | grep -q "Geometry: $2x"; }

# ---- an MQTT broker: status, state, commands, and the last will -----------------------------------------------------------
broker() {
    local port=18830 toml=$workdir/broker.toml topic=museum/hall-2/soffio
    local PATH=$PATH:/usr/sbin
    if ! command -v mosquitto >/dev/null || ! command -v mosquitto_sub >/dev/null; then
        cannot "broker" "a broker or its client is missing: apt-get install mosquitto mosquitto-clients"
        return
    fi
    while (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do port=$((port + 1)); done
    # Clients without a password are refused.
    touch "$workdir/mosquitto.passwords"
    mosquitto_passwd -b "$workdir/mosquitto.passwords" hall secret 2>/dev/null
    printf 'listener %s 127.0.0.1\nallow_anonymous false\npassword_file %s\n' "$port" "$workdir/mosquitto.passwords" >"$workdir/mosquitto.conf"
    chmod 755 "$workdir"
    chmod 644 "$workdir/mosquitto.passwords"
    configured "$toml" '[exhibits]\nfolder = "%s"\nshow = ["pendulum", "steel-fish"]\n[mqtt]\nbroker = "127.0.0.1:%s"\ntopic = "%s"\nuser = "hall"\npassword = "secret"\nobeys = ["reload", "blank", "wake", "mute", "exhibit"]\n' \
        "$root/exhibits" "$port" "$topic"
    # The kiosk starts before the broker.
    launch_kiosk broker --config "$toml" --no-attract
    start mosquitto mosquitto -c "$workdir/mosquitto.conf"
    local server=$last
    local at=(-p "$port" -u hall -P secret)
    within 10 mosquitto_pub "${at[@]}" -t x -m x || true
    start messages mosquitto_sub "${at[@]}" -t "$topic/#" -F '%t %r %p'
    within 15 published "$topic/status . online" || true
    within 15 published "\"exhibit\":\"pendulum\"" || true
    bar "broker: status and state" "$(grep -c "$topic/status . online" "$workdir/messages.out") >= 1 && $(grep -c '"exhibit":"pendulum"' "$workdir/messages.out") >= 1" \
        "$(head -c 300 "$workdir/messages.out" | tr '\n' ' ' | cut -c1-120)"
    local command=(mosquitto_pub "${at[@]}" -t "$topic/cmd" -q 1)
    "${command[@]}" -m 'exhibit steel-fish'
    within 10 published '"exhibit":"steel-fish"' || true
    "${command[@]}" -m 'mute on'
    within 10 published '"muted":true' || true
    "${command[@]}" -m blank
    within 10 published '"blank":true' || true
    sleep 1
    picture && seen=1 || seen=0
    bar "broker: blank is black" "$seen == 0" "no picture"
    "${command[@]}" -m wake
    within 10 picture && seen=1 || seen=0
    "${command[@]}" -m reload
    within 10 reloaded || true
    # A burst: the last one counts, and the kiosk goes on.
    local i before burst
    before=$(grep -c 'is on show' "$workdir/broker.err")
    for i in {1..3000}; do echo "exhibit pendulum"; echo "exhibit steel-fish"; done | mosquitto_pub "${at[@]}" -t "$topic/cmd" -q 1 -l
    sleep 3
    "${command[@]}" -m 'mute off'
    within 5 published '"muted":false' && seen=$((seen + 1)) || true
    burst=$(($(grep -c 'is on show' "$workdir/broker.err") - before))
    bar "broker: a burst" "$seen == 2 && $burst <= 12" "6000 commands load $burst exhibits, and the next command is obeyed within 5 s"
    seen=$((seen - 1))
    "${command[@]}" -m shutdown
    within 5 grep -q '"shutdown" is no command' "$workdir/broker.err" || true
    sleep 2
    bar "broker: commands" "$seen == 1 && $(grep -c 'steel-fish is on show' "$workdir/broker.err") >= 2 && $(grep -c '"muted":true' "$workdir/messages.out") >= 1 && $(grep -c 'is no command' "$workdir/broker.err") == 1" \
        "another exhibit, mute, blank, wake, reload; no other command"
    # Kiosk and launcher are killed: the broker publishes the last will.
    local pid
    pid=$(child)
    kill -9 "$kiosk"
    kill -9 "$pid"
    wait "$kiosk" 2>/dev/null || true
    within 10 published "$topic/status . offline" && seen=1 || seen=0
    bar "broker: last will" "$seen == 1" "offline, by the broker, after kill -9"
    # A retained command from before its start is ignored, and a broker that goes away stops nothing.
    "${command[@]}" -r -m blank
    launch_kiosk broker_gone --config "$toml" --no-attract
    within 10 grep -q 'mqtt: connected to' "$workdir/broker_gone.err" || true
    kill "$server"
    wait "$server" 2>/dev/null || true
    sleep 3
    picture && seen=1 || seen=0
    bar "broker: gone" "$seen == 1 && $(grep -c '"blank" is ignored' "$workdir/broker_gone.err") == 1 && $(grep -c 'mqtt: no connection to' "$workdir/broker_gone.err") == 1" "reported once, the picture stays"
    end_launcher || true
}
reloaded() { [ "$(grep -c 'steel-fish is on show' "$workdir/broker.err")" -ge 2 ]; }

# ---- an encrypted connection, on which broker and kiosk show certificates -------------------------------------------
broker_encrypted() {
    local port=18930 toml=$workdir/encrypted.toml files=$workdir/certificates name
    local PATH=$PATH:/usr/sbin
    if ! command -v mosquitto >/dev/null || ! command -v openssl >/dev/null; then
        cannot "broker encrypted" "a broker or openssl is missing: apt-get install mosquitto openssl"
        return
    fi
    while (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do port=$((port + 1)); done
    mkdir -m 755 "$files"
    for name in ca other; do
        openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2 -subj "/CN=$name" \
            -keyout "$files/$name.key" -out "$files/$name.pem" 2>/dev/null
    done
    for name in localhost kiosk; do
        openssl req -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -subj "/CN=$name" -addext "subjectAltName=DNS:$name" \
            -keyout "$files/$name.key" -out "$files/$name.csr" 2>/dev/null
        openssl x509 -req -days 2 -in "$files/$name.csr" -CA "$files/ca.pem" -CAkey "$files/ca.key" -copy_extensions copy \
            -out "$files/$name.pem" 2>/dev/null
    done
    chmod 644 "$files"/*
    chmod 755 "$workdir"
    printf 'listener %s 127.0.0.1\nallow_anonymous true\ncafile %s/ca.pem\ncertfile %s/localhost.pem\nkeyfile %s/localhost.key\nrequire_certificate true\n' \
        "$port" "$files" "$files" "$files" >"$workdir/encrypted.conf"
    start mosquitto_encrypted mosquitto -c "$workdir/encrypted.conf"
    for name in ca other; do
        configured "$toml" '[exhibits]\nfolder = "%s"\nshow = ["pendulum"]\n[mqtt]\nbroker = "localhost:%s"\nauthority = "%s/%s.pem"\ncertificate = "%s/kiosk.pem"\nkey = "%s/kiosk.key"\n' \
            "$root/exhibits" "$port" "$files" "$name" "$files" "$files"
        launch_kiosk "encrypted_$name" --config "$toml" --no-attract
        within 10 grep -qE 'mqtt: (connected to|no connection)' "$workdir/encrypted_$name.err" || true
        end_launcher || true
    done
    bar "broker encrypted" "$(grep -c 'mqtt: connected to' "$workdir/encrypted_ca.err") >= 1 && $(grep -c 'mqtt: connected to' "$workdir/encrypted_other.err") == 0 && $(grep -c 'mqtt: no connection' "$workdir/encrypted_other.err") == 1" \
        "connected with certificates; refused where the broker's comes from another authority"
}
published() { grep -q "$1" "$workdir/messages.out"; }
