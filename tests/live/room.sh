# A gallery room without hardware: a display, a microphone, a loudspeaker, each virtual and private to this run.
# Sourced by run.sh. Everything started here is ended by the trap, however the run ends.
#
#   paplay -d mic_in F.wav     somebody makes a sound before the microphone
#   parec -d speakers.monitor  what the loudspeaker plays
#   parec -d air.monitor       both at once on one clock: the first channel is what the microphone hears
#
# All sound is in one sink, which is a timer, not hardware: `norewinds` keeps it from swallowing the first two seconds
# of a stream. Microphone and loudspeaker are channels of it.

room=$(mktemp -d)
started=()

leave_room() {
    local pid
    for pid in "${started[@]}"; do
        kill "$pid" 2>/dev/null || true
    done
    for pid in "${started[@]}"; do
        for _ in {1..30}; do
            kill -0 "$pid" 2>/dev/null || continue 2
            sleep 0.1
        done
        kill -9 "$pid" 2>/dev/null || true
    done
    wait 2>/dev/null || true
    if [ -n "${SOFFIO_LIVE_KEEP:-}" ]; then
        mkdir -p "$SOFFIO_LIVE_KEEP"
        find "$room" -maxdepth 1 -type f -exec cp -t "$SOFFIO_LIVE_KEEP" {} +
    fi
    rm -rf "$room"
}
trap leave_room EXIT
trap 'exit 130' INT TERM

# Runs a command in the background, ended with the room at the latest. Its id is in $last.
start() {
    local log=$1
    shift
    "$@" >"$room/$log.out" 2>"$room/$log.err" &
    last=$!
    started+=("$last")
}

# Waits up to so many seconds until a command succeeds, which is tried every tenth of a second, or every $pause.
within() {
    local end=$((SECONDS + $1))
    shift
    until "$@" >/dev/null 2>&1; do
        [ "$SECONDS" -lt "$end" ] || return 1
        sleep "${pause:-0.1}"
    done
}

# Pixels of the display, WIDTHxHEIGHT.
screen_size=1280x720
enter_room() { # enter_room [SCREEN_SIZE]
    screen_size=${1:-$screen_size}
    mkdir -p "$room/run" "$room/home"
    chmod 700 "$room/run"
    # As it is shipped, with fewer pictures and works.
    sed "s/^software_fps = .*/software_fps = $few_pictures/; s/^show = .*/show = [\"steel-fish\", \"pendulum\"]/" "$root/kiosk-config/kiosk.toml" >"$room/kiosk.toml"
    # Software graphics compile shaders for seconds: once for all rooms.
    export MESA_SHADER_CACHE_DIR=${MESA_SHADER_CACHE_DIR:-${XDG_CACHE_HOME:-$HOME/.cache}}
    export HOME=$room/home XDG_RUNTIME_DIR=$room/run PULSE_SERVER=unix:$room/run/pulse/native
    export XDG_CONFIG_HOME=$room/home/.config XDG_CACHE_HOME=$room/home/.cache
    unset WAYLAND_DISPLAY RUST_LOG PULSE_SINK PULSE_SOURCE XDG_STATE_HOME STATE_DIRECTORY
    cat >"$room/room.pa" <<'PA'
load-module module-native-protocol-unix auth-anonymous=1
load-module module-null-sink sink_name=air rate=48000 channels=3 channel_map=aux0,aux1,aux2 format=float32le norewinds=1
load-module module-remap-sink sink_name=mic_in master=air channels=1 channel_map=mono master_channel_map=aux0 remix=no
PA
    start_server
    # The server finds a free number itself and says which.
    start xvfb Xvfb -displayfd 1 -screen 0 "${screen_size}x24" -nolisten tcp
    within 30 test -s "$room/xvfb.out" || { cat "$room/xvfb.err" >&2; return 1; }
    DISPLAY=:$(cat "$room/xvfb.out")
    export DISPLAY
    # Without a window manager no window becomes fullscreen.
    start openbox openbox
    within 30 xdotool get_desktop
}

# The sound server, with both plugs in. Its id is in $server.
start_server() {
    start pulse pulseaudio -n -F "$room/room.pa" --daemonize=no --exit-idle-time=-1 --use-pid-file=no --disallow-exit \
        --realtime=no --high-priority=no
    server=$last
    within 30 pactl info || { cat "$room/pulse.err" >&2; return 1; }
    plug_microphone
    plug_loudspeaker
}

# The plugs of microphone and loudspeaker.
plug_microphone() {
    pactl load-module module-remap-source source_name=mic master=air.monitor channels=1 channel_map=mono \
        master_channel_map=aux0 remix=no >"$room/plug"
    pactl set-default-source mic
}
plug_loudspeaker() {
    pactl load-module module-remap-sink sink_name=speakers master=air channels=2 channel_map=front-left,front-right \
        master_channel_map=aux1,aux2 remix=no >"$room/speaker-plug"
    pactl set-default-sink speakers
}
pull_loudspeaker() {
    pactl unload-module "$(cat "$room/speaker-plug")"
}
pull_microphone() {
    pactl unload-module "$(cat "$room/plug")"
}

# Pictures a second where a part looks at single ones: each costs a software renderer up to a quarter of a second, and other
# rooms draw too. Whoever watches as a visitor does has the shipped configuration.
few_pictures=3.0

# The site's configuration with its own words and few pictures: `configured FILE WORDS`, as printf takes them.
configured() {
    local file=$1
    shift
    # shellcheck disable=SC2059
    { printf '[screen]\nsoftware_fps = %s\n' "$few_pictures" && printf "$@"; } >"$file"
}

# Kiosk under test: its log is $room/$1.err. A debug build on software graphics opens its window within seconds.
start_kiosk() {
    local name=$1
    shift
    [[ " $* " == *" --config "* ]] || set -- --config "$room/kiosk.toml" "$@"
    start "$name" timeout --kill-after=20 "${limit:-120}" "$soffio" kiosk --exhibit "$exhibit" "$@"
    kiosk=$last
    within 60 grep -q 'pixels on' "$room/$name.err"
}

# Waits for the kiosk's own end; its exit code, or 0 for the one that is wanted: `end_kiosk NAME [CODE]`.
end_kiosk() {
    local code=0
    wait "$kiosk" || code=$?
    [ "$code" -ne "${2:-0}" ] || code=0
    [ "$code" -eq 0 ] || sed "s/^/    /" "$room/$1.err" >&2
    return "$code"
}

# Ends the kiosk as a service manager would, before its own time is over; its exit code, 0 for an orderly end.
leave_kiosk() {
    local code=0
    kill -TERM "$kiosk" 2>/dev/null || true
    end_kiosk "$1" 130 || code=$?
    return "$code"
}

# What the loudspeaker plays comes back to the microphone, 60 ms late and so much louder (dB).
close_the_loop() {
    pactl load-module module-loopback source=speakers.monitor sink=mic_in latency_msec=60 >"$room/loop"
    within 30 loopback
    pactl set-sink-input-volume "$(loopback | head -1)" "$1dB"
}
loopback() {
    pactl list sink-inputs | awk '/^Sink Input #/ { id = substr($3, 2) } /module-loopback/ { print id; n++ } END { exit !n }'
}
open_the_loop() {
    pactl unload-module "$(cat "$room/loop")"
}

# A file, whatever its rate, played before the microphone; returns when it has been heard.
before_microphone() {
    paplay -d mic_in "$1"
}

# A gallery is never silent: pink noise at −60 dB of full scale, as long as the room lasts.
room_tone() {
    sox -n -r 48000 -c 1 -e float -b 32 "$room/tone.wav" synth 60 pinknoise norm -47
    start tone sh -c "while paplay -d mic_in '$room/tone.wav'; do :; done"
}

# The processes that a process has started, those that they have started, and so on.
descendants() {
    local id
    cat "/proc/$1/task/"*/children 2>/dev/null | xargs -rn 1 | while read -r id; do
        echo "$id"
        descendants "$id"
    done
}

# Wall clock, s.
now() {
    date +%s.%N
}

# Wall-clock times, s, of the lines of a kiosk's log that hold a text.
log_times() {
    { grep -F -- "$2" "$room/$1.err" || true; } | while read -r stamp _; do date -d "$stamp" +%s.%N; done
}

# The kiosk's own time, s, of the breaths from a source that begin: `breaths FILE SOURCE begins|ends`.
breaths() {
    sed -nE "s/.* ([0-9.]+) s: a breath $3 \($2\).*/\1/p" "$room/$1.err"
}

# Holds the key that blows so long, from when the kiosk says that this breath begins: an event waits for the picture that is
# drawn meanwhile, and returns when it has ended.
hold() { # hold KIOSK SECONDS
    local held
    held=$(breaths "$1" hold begins | wc -l)
    xdotool keydown space
    within 20 held_times "$1" begins $((held + 1)) || true
    sleep "$2"
    xdotool keyup space
    within 20 held_times "$1" ends $((held + 1)) || true
}
held_times() { [ "$(breaths "$1" hold "$2" | wc -l)" -ge "$3" ]; }

# Level of a recording between two moments, dB of full scale (RMS over both channels); −140 for silence, or where it has ended.
level() { # level RAW FROM SECONDS
    { sox -t raw -r 48000 -c 2 -e float -b 32 "$1" -n trim "$2" "$3" stats 2>&1 || true; } |
        awk '/^RMS lev dB/ { print ($4 == "-inf" || $4 < -140) ? -140 : $4; found = 1 } END { if (!found) print -140 }'
}

# Moments, s, at which one channel (from 1) of a recording of the air, or a mix of some (as sox' remix has it), gets louder
# than a level (dB of full scale, 5 ms) after at least a second below it.
onsets() { # onsets RAW CHANNEL LEVEL
    sox -t raw -r 48000 -c 3 -e float -b 32 "$1" -t raw -c 1 -e float -b 32 - remix "$2" | od -An -v -w960 -tf4 |
        awk -v loud="$3" '{
            sum = 0
            for (i = 1; i <= NF; i++) sum += $i * $i
            if (10 * log(sum / NF + 1e-14) / log(10) > loud) { if (quiet >= 200) print (NR - 1) / 200; quiet = 0 }
            else quiet++
        }'
}

# Longest block of a kiosk's device, ms.
block() { # block KIOSK microphone|loudspeaker
    sed -nE "s/.* $2 in blocks of ([0-9.]+) ms.*/\\1/p" "$room/$1.err" | tail -1
}

# Is an arithmetic comparison true?
holds() {
    awk "BEGIN { exit !($*) }"
}
