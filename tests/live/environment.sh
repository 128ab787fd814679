# A test environment without hardware: a virtual display, microphone and loudspeaker that are private to this run.
# Sourced by run.sh. A trap ends every process that is started here, however the run ends.
#
#   paplay -d mic_in F.wav     plays a sound at the microphone
#   parec -d speakers.monitor  records the loudspeaker
#   parec -d air.monitor       records both on one clock; the first channel is the microphone
#
# All sound is in one null sink, driven by a timer; microphone and loudspeaker are channels of it. Without `norewinds` it would drop the
# first two seconds of a stream.

workdir=$(mktemp -d)
started=()

stop_environment() {
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
        find "$workdir" -maxdepth 1 -type f -exec cp -t "$SOFFIO_LIVE_KEEP" {} +
    fi
    rm -rf "$workdir"
}
trap stop_environment EXIT
trap 'exit 130' INT TERM

# Runs a command in the background until the environment ends at the latest. Its process id is in $last.
start() {
    local log=$1
    shift
    "$@" >"$workdir/$log.out" 2>"$workdir/$log.err" &
    last=$!
    started+=("$last")
}

# Waits until a command succeeds, for a number of seconds at most. It is tried every tenth of a second, or every $pause.
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
start_environment() { # start_environment [SCREEN_SIZE]
    screen_size=${1:-$screen_size}
    mkdir -p "$workdir/run" "$workdir/home"
    chmod 700 "$workdir/run"
    # The shipped configuration, with fewer pictures and exhibits.
    sed "s/^software_fps = .*/software_fps = $few_pictures/; s/^show = .*/show = [\"steel-fish\", \"pendulum\"]/" "$root/kiosk-config/kiosk.toml" >"$workdir/kiosk.toml"
    # Software graphics take seconds to compile shaders, so all environments share the cache.
    export MESA_SHADER_CACHE_DIR=${MESA_SHADER_CACHE_DIR:-${XDG_CACHE_HOME:-$HOME/.cache}}
    export HOME=$workdir/home XDG_RUNTIME_DIR=$workdir/run PULSE_SERVER=unix:$workdir/run/pulse/native
    export XDG_CONFIG_HOME=$workdir/home/.config XDG_CACHE_HOME=$workdir/home/.cache
    unset WAYLAND_DISPLAY RUST_LOG PULSE_SINK PULSE_SOURCE XDG_STATE_HOME STATE_DIRECTORY
    cat >"$workdir/pulse.pa" <<'PA'
load-module module-native-protocol-unix auth-anonymous=1
load-module module-null-sink sink_name=air rate=48000 channels=3 channel_map=aux0,aux1,aux2 format=float32le norewinds=1
load-module module-remap-sink sink_name=mic_in master=air channels=1 channel_map=mono master_channel_map=aux0 remix=no
PA
    start_server
    # The server chooses a free display number and prints it.
    start xvfb Xvfb -displayfd 1 -screen 0 "${screen_size}x24" -nolisten tcp
    within 30 test -s "$workdir/xvfb.out" || { cat "$workdir/xvfb.err" >&2; return 1; }
    DISPLAY=:$(cat "$workdir/xvfb.out")
    export DISPLAY
    # Without a window manager no window becomes fullscreen.
    start openbox openbox
    within 30 xdotool get_desktop
}

# The sound server, with both plugs in. Its id is in $server.
start_server() {
    start pulse pulseaudio -n -F "$workdir/pulse.pa" --daemonize=no --exit-idle-time=-1 --use-pid-file=no --disallow-exit \
        --realtime=no --high-priority=no
    server=$last
    within 30 pactl info || { cat "$workdir/pulse.err" >&2; return 1; }
    plug_microphone
    plug_loudspeaker
}

# The plugs of microphone and loudspeaker.
plug_microphone() {
    pactl load-module module-remap-source source_name=mic master=air.monitor channels=1 channel_map=mono \
        master_channel_map=aux0 remix=no >"$workdir/plug"
    pactl set-default-source mic
}
plug_loudspeaker() {
    pactl load-module module-remap-sink sink_name=speakers master=air channels=2 channel_map=front-left,front-right \
        master_channel_map=aux1,aux2 remix=no >"$workdir/speaker-plug"
    pactl set-default-sink speakers
}
pull_loudspeaker() {
    pactl unload-module "$(cat "$workdir/speaker-plug")"
}
pull_microphone() {
    pactl unload-module "$(cat "$workdir/plug")"
}

# Pictures a second in parts that compare single pictures. A software renderer takes up to a quarter of a second for one, and other
# parts draw too. Parts that test motion use the shipped configuration.
few_pictures=3.0

# Writes a configuration with few pictures and further lines: `configured FILE FORMAT …`, with the arguments of printf.
configured() {
    local file=$1
    shift
    # shellcheck disable=SC2059
    { printf '[screen]\nsoftware_fps = %s\n' "$few_pictures" && printf "$@"; } >"$file"
}

# Starts the kiosk under test; its log is $workdir/$1.err. A debug build on software graphics opens its window within seconds.
start_kiosk() {
    local name=$1
    shift
    [[ " $* " == *" --config "* ]] || set -- --config "$workdir/kiosk.toml" "$@"
    start "$name" timeout --kill-after=20 "${limit:-120}" "$soffio" kiosk --exhibit "$exhibit" "$@"
    kiosk=$last
    within 60 grep -q 'pixels on' "$workdir/$name.err"
}

# Waits for the kiosk to end. Returns its exit code, or 0 for the expected one: `end_kiosk NAME [CODE]`.
end_kiosk() {
    local code=0
    wait "$kiosk" || code=$?
    [ "$code" -ne "${2:-0}" ] || code=0
    [ "$code" -eq 0 ] || sed "s/^/    /" "$workdir/$1.err" >&2
    return "$code"
}

# Ends the kiosk before its time, as a service manager would. Returns its exit code, 0 for an orderly end.
leave_kiosk() {
    local code=0
    kill -TERM "$kiosk" 2>/dev/null || true
    end_kiosk "$1" 130 || code=$?
    return "$code"
}

# Connects the loudspeaker to the microphone, with a delay of 60 ms and a gain (dB).
close_the_loop() {
    pactl load-module module-loopback source=speakers.monitor sink=mic_in latency_msec=60 >"$workdir/loop"
    within 30 loopback
    pactl set-sink-input-volume "$(loopback | head -1)" "$1dB"
}
loopback() {
    pactl list sink-inputs | awk '/^Sink Input #/ { id = substr($3, 2) } /module-loopback/ { print id; n++ } END { exit !n }'
}
open_the_loop() {
    pactl unload-module "$(cat "$workdir/loop")"
}

# Plays a file of any sample rate at the microphone; returns at its end.
before_microphone() {
    paplay -d mic_in "$1"
}

# Ambient noise, as in a gallery: pink noise at −60 dB of full scale, until the environment ends.
ambient_noise() {
    sox -n -r 48000 -c 1 -e float -b 32 "$workdir/tone.wav" synth 60 pinknoise norm -47
    start tone sh -c "while paplay -d mic_in '$workdir/tone.wav'; do :; done"
}

# All descendants of a process.
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
    { grep -F -- "$2" "$workdir/$1.err" || true; } | while read -r stamp _; do date -d "$stamp" +%s.%N; done
}

# The kiosk's own time, s, of the breaths from a source that begin: `breaths FILE SOURCE begins|ends`.
breaths() {
    sed -nE "s/.* ([0-9.]+) s: a breath $3 \($2\).*/\1/p" "$workdir/$1.err"
}

# Holds the blow key for a number of seconds after the kiosk has logged the breath, since events wait for the picture that is being
# drawn. Returns when the breath has ended.
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

# Level of a part of a recording, dB of full scale (RMS over both channels); −140 for silence, or after its end.
level() { # level RAW FROM SECONDS
    { sox -t raw -r 48000 -c 2 -e float -b 32 "$1" -n trim "$2" "$3" stats 2>&1 || true; } |
        awk '/^RMS lev dB/ { print ($4 == "-inf" || $4 < -140) ? -140 : $4; found = 1 } END { if (!found) print -140 }'
}

# Levels of a channel (from 1) of a recording of the air, or of a mix of several (as in sox' remix): dB of full scale, a line each 5 ms.
levels() { # levels RAW CHANNEL
    sox -t raw -r 48000 -c 3 -e float -b 32 "$1" -t raw -c 1 -e float -b 32 - remix "$2" | od -An -v -w960 -tf4 |
        awk '{ sum = 0; for (i = 1; i <= NF; i++) sum += $i * $i; print 10 * log(sum / NF + 1e-14) / log(10) }'
}

# Onsets, s: times at which a channel rises above a level after at least a second below it.
onsets() { # onsets RAW CHANNEL LEVEL
    levels "$1" "$2" | awk -v loud="$3" '$1 > loud { if (quiet >= 200) print (NR - 1) / 200; quiet = -1 } { quiet++ }'
}

# True where a channel was below a level during the last 1.5 s of a recording that goes on. A frame has 12 bytes.
is_silent() { # is_silent RAW CHANNEL LEVEL
    local frames
    frames=$(($(stat -c %s "$1") / 12))
    tail -c +$((12 * (frames - 72000) + 1)) "$1" >"$workdir/lately.raw"
    levels "$workdir/lately.raw" "$2" | awk -v loud="$3" '$1 > loud { exit 1 }'
}

# Longest block of one of the kiosk's devices, ms.
block() { # block KIOSK microphone|loudspeaker
    sed -nE "s/.* $2 in blocks of ([0-9.]+) ms.*/\\1/p" "$workdir/$1.err" | tail -1
}

# True where an arithmetic comparison in awk's syntax holds.
holds() {
    awk "BEGIN { exit !($*) }"
}
