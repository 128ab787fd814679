#!/usr/bin/env bash
# The live tests: the real kiosk with a virtual microphone, loudspeaker and display (environment.sh).
#
#   tests/live/run.sh target/ci/soffio
#
# SOFFIO_LIVE_SECONDS=7200 adds a soak of that length with the visitors of SOFFIO_LIVE_SEED (soak.sh),
# SOFFIO_LIVE_STREAM=600 a stream of breaths whose delays are measured,
# SOFFIO_LIVE_LOAD=600 sound under a load of one process more than there are processors;
# SOFFIO_LIVE_SUITE=target/ci/deps/suite-… the suite's own tests of the devices, which need this environment;
# SOFFIO_LIVE_PARTS names the parts to run; SOFFIO_LIVE_KEEP=FOLDER keeps pictures, logs, traces and sounds.
# It prints one line per bar, and one for the time of each part; comments give the reason of each threshold. No result depends on the
# drawing speed. Each run has an environment of its own, so several can run in parallel (lanes.sh).
# A test that this computer cannot run is skipped and reported; with SOFFIO_REQUIRE_ALL or CI=true it counts as a missed bar.
# Many functions are called by their names in variables, and some only by other files.
# shellcheck source-path=SCRIPTDIR disable=SC2317
set -euo pipefail
here=$(dirname "$(readlink -f "$0")")
root=$(readlink -f "$here/../..")
soffio=$(readlink -f "${1:?usage: tests/live/run.sh PATH-OF-SOFFIO}")
exhibit=$root/exhibits/steel-fish
recordings=$exhibit/breaths
correlate=$(dirname "$soffio")/examples/correlate
for tool in Xvfb openbox xdotool import compare pulseaudio pactl paplay parec sox espeak-ng; do
    command -v "$tool" >/dev/null || { echo "live: $tool is missing; ./check installs it" >&2; exit 3; }
done
[ "${CI:-}" != true ] || export SOFFIO_REQUIRE_ALL=1
. "$here/environment.sh"
. "$here/robust.sh"
. "$here/faults.sh"
. "$here/soak.sh"
. "$here/screens.sh"
. "$here/parts.sh"

failed=0
bar() { # bar NAME "CONDITION in awk's arithmetic" "what was measured"
    if holds "$2"; then
        printf 'live: good  %-24s %s\n' "$1" "$3"
    else
        printf 'live: BAD   %-24s %s (wanted: %s)\n' "$1" "$3" "$2"
        failed=1
    fi
}

# Reports a test that this computer cannot run, and the remedy: skipped, or missed where everything is required.
cannot() { # cannot NAME "why, and what to install"
    if [ -n "${SOFFIO_REQUIRE_ALL:-}" ]; then
        printf 'live: BAD   %-24s %s\n' "$1" "$2"
        failed=1
    else
        printf 'live: SKIP  %-24s %s\n' "$1" "$2"
    fi
}

# Largest rotation and displacement of all bodies, or of one, in a span of a trace: "DEGREES MM".
motion() { # motion TRACE FROM TO [BODY]
    awk -F, -v from="$2" -v to="$3" -f "$here/turn.awk" "$1" |
        awk -v body="${4:-}" 'body == "" || $1 == body { if ($2 > t) t = $2; if ($3 > s) s = $3 } END { print t + 0, s + 0 }'
}

# Share of the pixels of two screenshots that differ visibly (by more than 4 % of full scale), of a region.
changed() { # changed BEFORE DURING GEOMETRY
    local count
    count=$(compare -metric AE -fuzz 4% -extract "$3" "$1" "$2" null: 2>&1 || true)
    awk -v n="$count" -v g="$3" 'BEGIN { split(g, s, /[x+]/); print n / (s[1] * s[2]) }'
}

# Converts a recorded breath to the sound server's sample rate.
breath() { sox "$recordings/$1.wav" -r 48000 -e float -b 32 "$workdir/$1.wav"; }

# Prints 1 where a replay of the record ends in the kiosk's final state, else 0.
replays() { # replays RUN
    (cd "$root" && "$soffio" replay "$workdir/$1.jsonl") >"$workdir/replay.out" 2>&1 || true
    [ -n "$(hash_in "$workdir/$1.out")" ] && [ "$(hash_in "$workdir/replay.out")" = "$(hash_in "$workdir/$1.out")" ] && echo 1 || echo 0
}
hash_in() { sed -n 's/.*"state_hash":"\([0-9a-f]*\)".*/\1/p' "$1"; }

# ---- a breath moves the sculpture and sounds; speech does neither ----------------------------------------------
a_visitor() {
    local before during speech t_on t_off at differ
    start_kiosk visitor --config "$root/kiosk-config/kiosk.toml" --no-attract --trace "$workdir/visitor.csv" --record "$workdir/visitor.jsonl" --for 30
    within 30 grep -q 'supervisor: microphone: ' "$workdir/visitor.err"
    start speakers parec -d speakers.monitor --rate=48000 --channels=2 --format=float32le --latency-msec=20 \
        --raw
    local recorder=$last t_rec
    within 30 test -s "$workdir/speakers.out"
    t_rec=$(now)
    # The detector has learnt the noise floor after 0.25 s.
    sleep 3
    for speech in "$workdir"/speech-*.wav; do before_microphone "$speech"; done
    # Speech with peaks at full scale is as loud as a shout into the microphone; wait until the detector has recovered.
    sleep 4
    import -window root "$workdir/before.png"
    t_on=$(now)
    before_microphone "$workdir/strong.wav" &
    sleep 2
    import -window root "$workdir/during.png"
    wait $!
    t_off=$(now)
    end_kiosk visitor
    kill "$recorder"
    wait "$recorder" 2>/dev/null || true
    bar "replayed to the bit" "$(replays visitor) == 1" "the record of this run, run again: $(hash_in "$workdir/replay.out")"

    at=$(breaths visitor microphone begins | head -1)
    bar "breath detected" "${at:-0} > 8 && $(breaths visitor microphone begins | wc -l) == 1" \
        "begins at ${at:-never} s, once"
    at=${at:-25}
    # A gentle push turns the boom by 5° within seconds; the strong one does much more.
    read -r turn _ < <(motion "$workdir/visitor.csv" "$at" 99 Boom)
    bar "breath turns the boom" "$turn > 5" "$turn degrees"
    # The exhibit fills the middle of the picture, the ring of the breath meter about 1 % of it.
    share=$(changed "$workdir/before.png" "$workdir/during.png" 1024x504+128+72)
    bar "breath is seen" "$share > 0.02" "$share of the pixels changed"
    before=$(level "$workdir/speakers.out" "$(awk "BEGIN { print $t_on - $t_rec - 2 }")" 1.5)
    during=$(level "$workdir/speakers.out" "$(awk "BEGIN { print $t_on - $t_rec + 0.7 }")" 1.2)
    after=$(level "$workdir/speakers.out" "$(awk "BEGIN { print $t_off - $t_rec + 3 }")" 1.5)
    bar "wind is heard" "$during > $before + 15 && $during > $after + 10" "$before, $during, $after dBFS before, during, after"
    # Ambient wind moves the exhibit a little, equally in every run; speech must not change a digit of it.
    "$soffio" play "$exhibit" --trace "$workdir/empty.csv" --seconds 30 >/dev/null
    local rows
    read -r rows differ < <(awk -F, -v to="$(awk "BEGIN { print $at - 0.05 }")" '
        NR == FNR { empty[FNR] = $0; next }
        FNR > 1 && $1 < to { rows++; differ += empty[FNR] != $0 }
        END { print rows + 0, differ + 0 }' "$workdir/empty.csv" "$workdir/visitor.csv")
    bar "speech moves nothing" "$rows > 1000 && $differ == 0" "$differ of $rows rows differ from a run without speech"
}

# Both loudspeaker channels as one, wherever the wind is panned.
both=2v0.71,3v0.71

# ---- from the lips to wind, sound and picture -----------------------------------------------------------------------
# Sound is measured on one clock, from the breath at the microphone (5 ms above −45 dBFS) to the loudspeaker (−60 dBFS). Wind and
# picture are measured by the kiosk's own time stamps. The drawing time of a debug build on software graphics is not representative;
# the test is that the next picture shows the wind.
latency() {
    local breaths=(strong normal strong normal strong normal strong normal strong) name took seen
    start_kiosk latency --config "$root/kiosk-config/kiosk.toml" --no-attract
    within 30 grep -q 'supervisor: microphone: ' "$workdir/latency.err"
    start air parec -d air.monitor --rate=48000 --channels=3 --channel-map=aux0,aux1,aux2 --format=float32le \
        --latency-msec=20 --raw
    local recorder=$last
    within 30 test -s "$workdir/air.out"
    sleep 3
    for name in "${breaths[@]}"; do
        before_microphone "$workdir/$name.wav"
        # A sound has an onset only in silence; the sheets of the fish strike each other for seconds after a breath.
        sleep 2
        within 15 is_silent "$workdir/air.out" "$both" -60 || true
    done
    kill "$recorder"
    wait "$recorder" 2>/dev/null || true
    leave_kiosk latency
    # Onsets at the microphone and at the loudspeakers, in blocks of 240 frames; each breath is paired with the first sound after it. Where
    # a late strike rings, the sound of the breath has no onset.
    took=$(awk 'NR == FNR { sound[++n] = $1; next } { for (i = 1; i <= n && sound[i] < $1; i++); if (i <= n && sound[i] < $1 + 1.5) print int(1000 * (sound[i] - $1)) }' \
        <(onsets "$workdir/air.out" "$both" -60) <(onsets "$workdir/air.out" 1 -45) | sort -n | xargs)
    local median most
    median=$(echo "$took" | tr ' ' '\n' | rank 0.5)
    most=${took##* }
    # The detector may take 140 ms. A block of the microphone, one of the loudspeaker, a step and the attack of the sound are added.
    bar "breath to sound" "$(echo "$took" | wc -w) >= 6 && $median <= 220 && $most <= 350" \
        "$took ms after the breaths that began in quiet, blocks of $(block latency microphone) and $(block latency loudspeaker) ms"
    seen=$(sed -nE 's/.* seen ([0-9.]+) ms after it, in the next frame.*/\1/p' "$workdir/latency.err" | xargs)
    bar "breath to picture" "$(echo "$seen" | wc -w) == 9" "$seen ms after its first wind, each time in the next picture"
}

# ---- the latency from microphone to wind does not grow ---------------------------------------------------------------
# A breath every few seconds. Sound is measured on one clock, as above. Wind is taken from the kiosk's log and compared with that clock,
# so only changes count. Medians of the first and of the last third are compared. They may differ by a block, since the positions of
# frames and blocks vary.
streaming() {
    local blown=0 t_rec end block winds sounds median slow late_sound late_wind
    limit=$(($1 + 90)) start_kiosk stream --config "$root/kiosk-config/kiosk.toml" --no-attract --for "$1"
    within 30 grep -q 'supervisor: microphone: ' "$workdir/stream.err"
    end=$((SECONDS + $1 - 20))
    start stream_air parec -d air.monitor --rate=48000 --channels=3 --channel-map=aux0,aux1,aux2 --format=float32le \
        --latency-msec=20 --raw
    local recorder=$last
    within 30 test -s "$workdir/stream_air.out"
    t_rec=$(now)
    sleep 3
    while [ "$SECONDS" -lt "$end" ]; do
        before_microphone "$workdir/strong.wav"
        blown=$((blown + 1))
        sleep 2
    done
    kill "$recorder"
    wait "$recorder" 2>/dev/null || true
    end_kiosk stream
    onsets "$workdir/stream_air.out" 1 -45 | sed 's/^/breath /' >"$workdir/stream.times"
    onsets "$workdir/stream_air.out" "$both" -60 | sed 's/^/sound /' >>"$workdir/stream.times"
    log_times stream 'begins (microphone)' | awk -v t="$t_rec" '{ print "wind", $1 - t }' >>"$workdir/stream.times"
    # Each breath is paired with the first wind and the first sound near it; a sound has no onset while an earlier chime lasts.
    awk '$1 == "breath" { at[++n] = $2 } $1 != "breath" { for (i = n; i && at[i] > $2 + 0.5; i--); if (i && $2 < at[i] + 1.5 && !((i, $1) in d)) d[i, $1] = 1000 * ($2 - at[i]) }
        END { for (i = 1; i <= n; i++) for (k in d) { split(k, w, SUBSEP); if (w[1] == i) printf "%s %.2f %.1f\n", w[2], at[i], d[k] } }' \
        "$workdir/stream.times" >"$workdir/stream.delays"
    winds=$(delays wind | wc -l)
    sounds=$(delays sound | wc -l)
    median=$(delays sound | rank 0.5)
    slow=$(delays sound | rank 0.9)
    late_sound=$(delays sound | later)
    late_wind=$(delays wind | later)
    block=$(printf '%s\n' "$(block stream microphone)" "$(block stream loudspeaker)" | sort -n | tail -1)
    bar "every breath is wind" "$winds == $blown && $winds >= 9" "$winds of $blown in $1 s"
    bar "breath to sound" "$sounds > 0.9 * $blown && $median <= 220 && $slow <= 350" \
        "$median ms, nine in ten within $slow ms, of $sounds that began in quiet"
    bar "the delay is constant" "$late_sound <= $block && $late_sound >= -$block && $late_wind <= $block && $late_wind >= -$block" \
        "after $1 s wind comes $late_wind ms and sound $late_sound ms later, blocks of $block ms; $(tail -1 "$workdir/stream.err" | grep -o 'dropped.*' || true)"
}
# The delays of one kind, in the order of the breaths.
delays() { awk -v kind="$1" '$1 == kind { print $3 }' "$workdir/stream.delays"; }
# Quantile of the numbers on stdin: `rank SHARE`.
rank() { sort -n | awk -v share="$1" '{ x[NR] = $1 } END { print x[int(share * (NR - 1)) + 1] }'; }
# Median of the last third of the numbers less that of the first.
later() {
    local numbers third
    numbers=$(cat)
    third=$(($(wc -l <<<"$numbers") / 3))
    awk -v a="$(head -n "$third" <<<"$numbers" | rank 0.5)" -v b="$(tail -n "$third" <<<"$numbers" | rank 0.5)" 'BEGIN { print b - a }'
}

# ---- setup: three breaths at two capsules, with doctor --blow --------------------------------------------------------
doctor_blow() {
    local code=0 doctor pair breaths_found level
    printf '[audio]\nmicrophone = "pair"\nmicrophone_channel = 1\nsecond_microphone_channel = 2\n[exhibits]\nfolder = "%s"\n' \
        "$root/exhibits" >"$workdir/pair.toml"
    pair=$(pactl load-module module-remap-source source_name=pair master=air.monitor channels=2 \
        channel_map=front-left,front-right master_channel_map=aux0,aux0 remix=no)
    start doctor timeout 60 "$soffio" doctor --blow --config "$workdir/pair.toml"
    doctor=$last
    within 30 grep -q 'Blow at the microphone' "$workdir/doctor.err"
    for _ in 1 2 3; do
        before_microphone "$workdir/normal.wav"
        sleep 1.5
    done
    wait "$doctor" || code=$?
    pactl unload-module "$pair"
    breaths_found=$(sed -nE 's/^(ok|warn) +a breath: //p' "$workdir/doctor.out")
    level=$(sed -nE 's/^(ok|warn|bad) +microphone level: //p' "$workdir/doctor.out")
    bar "doctor: three breaths" "$code == 0 && \"$breaths_found\" ~ /^heard 3, /" "exit code $code, $breaths_found"
    bar "doctor: level and floor" "\"$level\" ~ /^-[0-9.]+ dBFS, peak .*floor .* -[0-9.]+ dBFS/" "$level"
    bar "doctor: two capsules" "$(grep -c 'second microphone: it works' "$workdir/doctor.out") == 1" \
        "$(grep 'second microphone' "$workdir/doctor.out" || echo nothing is said of a second microphone)"
}

# ---- the kiosk's echo never triggers it, even next to its loudspeaker, and it detects a breath over its own sound ---------------------------
echo_only() {
    local loud before t_on t_off begun ended
    configured "$workdir/loud.toml" '[exhibits]\nshow = ["steel-fish"]\n[audio]\nvolume_db = 0.0\n'
    # Full volume with a gain of 12 dB: a sensitive capsule right in front of the loudspeaker.
    close_the_loop 12
    start microphone parec -d mic_in.monitor --rate=48000 --channels=2 --format=float32le --latency-msec=20 --raw
    start_kiosk own --no-attract --config "$workdir/loud.toml"
    within 30 grep -q 'supervisor: microphone: ' "$workdir/own.err"
    sleep 2
    for place in "340 300" "925 280"; do
        # shellcheck disable=SC2086
        xdotool mousemove $place
        hold own 2
        sleep 3
    done
    # Ten times the power of the ambient noise at −60 dBFS, in the mean over all pauses.
    loud=$(level "$workdir/microphone.out" 0 99)
    begun=$(breaths own hold begins | wc -l)
    bar "echo: it sounds" "$begun == 2 && $loud > -50" "$begun held breaths, $loud dBFS at the microphone"
    bar "echo: no false trigger" "$(breaths own microphone begins | wc -l) == 0" \
        "breaths detected at: $(breaths own microphone begins | xargs)"
    before=$(breaths own microphone begins | wc -l)
    t_on=$(now)
    before_microphone "$workdir/normal.wav"
    t_off=$(now)
    sleep 4
    begun=$(log_times own 'begins (microphone)' | tail -n +$((before + 1)) | head -1)
    ended=$(log_times own 'ends (microphone)' | tail -1)
    bar "breath over own sound" "${begun:-0} > $t_on && ${begun:-0} < $t_off" \
        "detected $(awk "BEGIN { print ${begun:-0} - $t_on }") s after the start of the recording"
    bar "breath ends" "${ended:-0} > $t_on && ${ended:-9e9} < $t_off + 1" \
        "$(awk "BEGIN { print ${ended:-0} - $t_off }") s after the recording"
    leave_kiosk own
    open_the_loop
}

# ---- labels are read aloud through the kiosk's own output, which the detector knows ------------------------------------
# A key starts the voice, and the same key or a touch stops it. The voice returns to the microphone at full level, and must not trigger.
reads_aloud() {
    local before during hushed again touched t_rec at press
    close_the_loop 0
    start_kiosk aloud --no-attract
    within 30 grep -q 'supervisor: microphone: ' "$workdir/aloud.err"
    start voice parec -d speakers.monitor --rate=48000 --channels=2 --format=float32le --latency-msec=20 --raw
    local recorder=$last
    within 30 test -s "$workdir/voice.out"
    t_rec=$(now)
    sleep 3
    local times=("$(now)")
    for press in key-speaks key-hushed key-speaks click-hushed; do
        if [ "${press%-*}" = key ]; then xdotool key r; else xdotool mousemove 640 200 mousedown 1 sleep 0.1 mouseup 1; fi
        within 10 "${press#*-}" || true
        sleep 2.5
        times+=("$(now)")
    done
    kill "$recorder"
    wait "$recorder" 2>/dev/null || true
    leave_kiosk aloud
    open_the_loop
    # Times in the recording at the end of each section; the last two seconds of each are measured.
    at=()
    for t in "${times[@]}"; do at+=("$(awk "BEGIN { print $t - $t_rec - 2.2 }")"); done
    before=$(level "$workdir/voice.out" "${at[0]}" 2)
    during=$(level "$workdir/voice.out" "${at[1]}" 2)
    hushed=$(level "$workdir/voice.out" "${at[2]}" 2)
    again=$(level "$workdir/voice.out" "${at[3]}" 2)
    touched=$(level "$workdir/voice.out" "${at[4]}" 2)
    # Speech has −20 LUFS at −6 dB of volume. A silent exhibit is 40 dB below, and the touch may have moved it.
    bar "a key reads aloud" "$during > -40 && $again > -40 && $during > $before + 15" "$before, then $during and $again dBFS"
    bar "a second press hushes" "$hushed < $during - 15" "$hushed dBFS"
    bar "a touch hushes" "$touched < $again - 10" "$touched dBFS"
    bar "the voice is no breath" "$(breaths aloud microphone begins | wc -l) == 0" \
        "$(breaths aloud microphone begins | wc -l) breaths with the voice at the microphone"
}

# True where the voice's recording ends in speech.
speaks() {
    tail -c 192000 "$workdir/voice.out" >"$workdir/voice.end"
    holds "$(level "$workdir/voice.end" 0 1) > -45"
}
hushed() { ! speaks; }

# ---- no sample of the microphone is ever written, sent, or mapped in shared memory ---------------------------------
# A known noise is played at the microphone. All writes and sends of the kiosk are traced, its shared memory is read while it runs, and
# its files are read afterwards. All of the kiosk's memory is read as soon as the noise ends, when a ring of two seconds would still hold
# half of it. Nothing may resemble the noise, except planted copies, which must be found. No core dump may be possible.
privacy() {
    local address pid kiosk_soffio=$soffio found=0 planted file cores
    if ! command -v strace >/dev/null; then
        cannot "privacy" "strace is missing: apt-get install strace"
        return
    fi
    if ! strace -f --seccomp-bpf -o /dev/null true 2>/dev/null; then
        cannot "privacy" "no process may be traced here: allow ptrace (in a container --cap-add=SYS_PTRACE)"
        return
    fi
    sox -R -n -r 48000 -c 1 -e float -b 32 "$workdir/known.wav" synth 4 whitenoise norm -12
    sox "$workdir/known.wav" -t raw "$workdir/known.f32"
    sox "$workdir/known.wav" -r 16000 -t raw -e signed -b 16 "$workdir/planted.i16"
    od -An -v -w4 -tf4 "$workdir/known.f32" | awk '{ printf "%.5f,%s\n", NR / 48000, $1 }' >"$workdir/planted.csv"
    # As the ring holds it: pairs, of which one capsule has sound.
    sox "$workdir/known.wav" -t raw "$workdir/planted.memory" remix 1 0
    od -An -v -w16 -tx1 "$workdir/known.f32" | sed 's/ /\\x/g; s/.*/write(7, "&", 16) = 16/' >"$workdir/planted.strace"
    # Pictures are written to the display, so a small display keeps the trace small.
    start small Xvfb -displayfd 1 -screen 0 160x90x24 -nolisten tcp
    within 30 test -s "$workdir/small.out"
    address=:$(cat "$workdir/small.out")
    DISPLAY=$address start manager openbox
    DISPLAY=$address within 30 xdotool get_desktop
    cat >"$workdir/traced" <<TRACED
#!/bin/sh
ulimit -c unlimited
exec strace -f --seccomp-bpf -qq -s 1048576 -xx -o $workdir/kiosk.strace \
    -e trace=write,pwrite64,writev,pwritev,pwritev2,sendto,sendmsg,sendmmsg $kiosk_soffio "\$@"
TRACED
    chmod +x "$workdir/traced"
    touch "$workdir/before"
    # The kiosk runs in a folder of its own, since other environments may write into out/.
    mkdir "$workdir/privacy.folder"
    cd "$workdir/privacy.folder"
    DISPLAY=$address soffio=$workdir/traced start_kiosk privacy --config "$root/kiosk-config/kiosk.toml" --no-attract --record "$workdir/privacy.jsonl" --for 20
    cd "$OLDPWD"
    within 30 grep -q 'supervisor: microphone: ' "$workdir/privacy.err"
    sleep 2
    before_microphone "$workdir/known.wav"
    pid=$(descendants "$kiosk" | while read -r id; do [ "$(readlink "/proc/$id/exe")" != "$kiosk_soffio" ] || echo "$id"; done | tail -1)
    # The kiosk stands still while it is read. A read-only page holds no sample.
    kill -STOP "$pid"
    grep 'rw-p' "/proc/$pid/maps" | while IFS=' -' read -r from to _; do
        dd if="/proc/$pid/mem" bs=1M iflag=skip_bytes,count_bytes,fullblock skip=$((0x$from)) count=$((0x$to - 0x$from)) 2>/dev/null || true
    done >"$workdir/kiosk.memory"
    grep 'rw-s' "/proc/$pid/maps" | while IFS=' -' read -r from to _; do
        dd if="/proc/$pid/mem" bs=4096 iflag=skip_bytes,count_bytes skip=$((0x$from)) count=$((0x$to - 0x$from)) 2>/dev/null || true
    done >"$workdir/kiosk.mapped"
    kill -CONT "$pid"
    cores=$(awk '/^Max core file size/ { print $5 "," $6 }' "/proc/$pid/limits")
    end_kiosk privacy
    # Copy the files first, since shared memory of other environments comes and goes.
    mkdir "$workdir/left"
    find "$HOME" "$XDG_RUNTIME_DIR" "$workdir/privacy.folder" /dev/shm -type f -newer "$workdir/before" 2>/dev/null | while read -r file; do
        cp "$file" "$workdir/left/${file//\//+}" 2>/dev/null || true
    done
    mapfile -t left < <(find "$workdir/left" -type f)
    local writes
    writes=$(grep -c . "$workdir/kiosk.strace")
    planted=$("$correlate" "$workdir/known.f32" "$workdir"/planted.* | grep -c FOUND || true)
    "$correlate" "$workdir/known.f32" "$workdir/kiosk.strace" "$workdir/kiosk.mapped" "$workdir/kiosk.memory" "$workdir/privacy.err" "$workdir/privacy.jsonl" "${left[@]}" \
        >"$workdir/privacy.correlate" || found=1
    bar "privacy" "$found == 0 && $planted == 4 && $writes > 1000 && $(stat -c %s "$workdir/kiosk.memory") > 10000000" \
        "$planted of 4 planted copies found; $writes writes and sends, $(($(stat -c %s "$workdir/kiosk.memory") >> 20)) MiB of memory, ${#left[@]} files: at most $(awk '$2 > m { m = $2 } END { print m }' "$workdir/privacy.correlate")"
    bar "no core dump" "\"${cores:-}\" == \"0,0\"" "limits of a core file: ${cores:-unknown} bytes"
}

# ---- the microphone is unplugged and plugged in again ten times -----------------------------------------------------
replugged() {
    local i before
    limit=180 start_kiosk replugged --no-attract --trace "$workdir/replugged.csv"
    within 30 grep -q 'supervisor: microphone: ' "$workdir/replugged.err"
    for i in {1..10}; do
        before=$(grep -c 'supervisor: microphone: ' "$workdir/replugged.err")
        pull_microphone
        within 8 lost_times replugged "$i"
        plug_microphone
        # Retries come after 1, 2, 4 … s; the microphone has worked since, so the first one comes after 1 s.
        within 8 listens_times replugged $((before + 1)) || break
    done
    bar "ten times replugged" "$(grep -c 'microphone lost' "$workdir/replugged.err") == 10 && $(grep -c 'supervisor: microphone: ' "$workdir/replugged.err") == 11" \
        "lost $(grep -c 'microphone lost' "$workdir/replugged.err") times, $(grep -c 'supervisor: microphone: ' "$workdir/replugged.err") times opened"
    # One breath while it is unplugged, and one afterwards.
    pull_microphone
    within 8 lost_times replugged 11
    before_microphone "$workdir/strong.wav"
    bar "unplugged: no wind" "$(breaths replugged microphone begins | wc -l) == 0" "$(breaths replugged microphone begins | wc -l) breaths detected"
    plug_microphone
    within 12 listens_times replugged 12
    sleep 2
    before_microphone "$workdir/strong.wav"
    sleep 1
    bar "plugged in: one breath" "$(breaths replugged microphone begins | wc -l) == 1" "$(breaths replugged microphone begins | wc -l) breaths detected"
    leave_kiosk replugged
}
lost_times() { [ "$(grep -c 'microphone lost' "$workdir/$1.err")" -ge "$2" ]; }
listens_times() { [ "$(grep -c 'supervisor: microphone: ' "$workdir/$1.err")" -ge "$2" ]; }

# ---- the loudspeaker is unplugged and plugged in again: it sounds again, and the motion never stops -----------------
speaker_replugged() {
    local i rows gaps
    configured "$workdir/mute.toml" '[exhibits]\nshow = ["steel-fish"]\n[audio]\noutput = "speakers"\n'
    start_kiosk mute --no-attract --config "$workdir/mute.toml" --trace "$workdir/mute.csv" --for 36
    within 30 grep -q 'supervisor: loudspeaker: ' "$workdir/mute.err"
    for i in 1 2 3; do
        pull_loudspeaker
        within 8 spoken mute 'loudspeaker lost' "$i" || break
        plug_loudspeaker
        within 8 spoken mute 'supervisor: loudspeaker: ' $((i + 1)) || break
    done
    sleep 1
    start back parec -d speakers.monitor --rate=48000 --channels=2 --format=float32le --latency-msec=20 --raw
    local recorder=$last
    hold mute 3
    kill "$recorder"
    wait "$recorder" 2>/dev/null || true
    end_kiosk mute || true
    bar "loudspeaker replugged" "$(grep -c 'loudspeaker lost' "$workdir/mute.err") == 3 && $(grep -c 'supervisor: loudspeaker: ' "$workdir/mute.err") == 4" \
        "lost $(grep -c 'loudspeaker lost' "$workdir/mute.err") times, $(grep -c 'supervisor: loudspeaker: ' "$workdir/mute.err") times opened"
    # A stream that was not opened again is digital silence. The level of a second of wind (-49 to -51 dBFS) depends on the motion of
    # the exhibit. The last seconds are measured, since the key waits for the picture that is being drawn.
    local loud
    loud=$(level "$workdir/back.out" "$(awk -v bytes="$(stat -c %s "$workdir/back.out")" 'BEGIN { t = bytes / 384000 - 2.5; print (t > 0 ? t : 0) }')" 2)
    bar "back: it sounds" "$loud > -60" "$loud dBFS"
    # The trace has 60 rows a second, independent of the loudspeaker.
    read -r rows gaps < <(awk -F, 'FNR > 2 && $1 - t > 0.018 { gaps++ } FNR > 1 { t = $1; times[$1] } END { print length(times), gaps + 0 }' "$workdir/mute.csv")
    bar "motion continues" "$rows >= 2150 && $gaps == 0" "$rows moments in 36 s, $gaps gaps"
}
spoken() { [ "$(grep -c "$2" "$workdir/$1.err")" -ge "$3" ]; }

# ---- a curator's own timbre is heard through the loudspeaker, and again as soon as it is saved -----------------------
# The vent of the exhibit always turns its pinwheel, and the timbre's tone follows the spin only in level.
own_timbre() {
    local exhibit=$workdir/own-timbre before after
    cp -r "$root/exhibits/windy-corner" "$exhibit"
    mkdir -p "$exhibit/timbres"
    own_tone 1000 >"$exhibit/timbres/tone.toml"
    sed -i 's/^timbre = "ratchet"/timbre = "tone"/; s/^timbre = "wind-room"/timbre = "tone"/; s/^on = "wind"/on = "motion"/' "$exhibit/exhibit.toml"
    configured "$workdir/own-timbre.toml" '[exhibits]\nshow = ["windy-corner"]\n[audio]\noutput = "speakers"\n'
    start_kiosk own-timbre --no-attract --config "$workdir/own-timbre.toml" --for 40
    within 30 grep -q 'supervisor: loudspeaker: ' "$workdir/own-timbre.err"
    before=$(tones)
    own_tone 2000 >"$exhibit/timbres/tone.toml"
    within 15 grep -q 'shows windy-corner\|reloaded' "$workdir/own-timbre.err" || sleep 3
    after=$(tones)
    own_tone 2000 | sed 's/"fm"/"fmm"/' >"$exhibit/timbres/tone.toml"
    within 15 grep -q 'did you mean "fm"' "$workdir/own-timbre.err" || true
    bar "own timbre: broken" "$(grep -c 'did you mean "fm"' "$workdir/own-timbre.err") >= 1" \
        "$(grep -o 'timbres/tone.toml:[0-9]*' "$workdir/own-timbre.err" | head -1) is reported"
    leave_kiosk own-timbre
    # A band of 50 Hz holds the whole tone, and a fiftieth of what else sounds there.
    bar "own timbre: heard" "${before% *} > ${before#* } + 20" "${before% *} dBFS at 1000 Hz, ${before#* } at 2000"
    bar "own timbre: saved" "${after#* } > ${after% *} + 20" "${after% *} dBFS at 1000 Hz, ${after#* } at 2000"
}
own_tone() { # own_tone HERTZ
    printf 'timbre = 1\nname = "tone"\ndescription = "A tone for the live tests"\n[node.tone]\ntype = "fm"\ncarrier = %s\nratio = 0.01\nindex = 0.2\n' "$1"
    printf '[node.out]\ntype = "function"\nin = ["tone"]\nof = "0.1 * tone * clamp(body_spin, 0, 1)"\n'
}
tones() { # levels at 1000 and 2000 Hz, dBFS
    local recorder hertz
    start tones parec -d speakers.monitor --rate=48000 --channels=2 --format=float32le --latency-msec=20 --raw
    recorder=$last
    sleep 4
    kill "$recorder"
    wait "$recorder" 2>/dev/null || true
    for hertz in 1000 2000; do
        sox -t raw -r 48000 -c 2 -e float -b 32 "$workdir/tones.out" -t raw -e float -b 32 "$workdir/band.out" sinc "$((hertz - 25))-$((hertz + 25))"
        level "$workdir/band.out" 1.5 2
    done | tr '\n' ' ' | sed 's/ $//'
}

# ---- sound under load -----------------------------------------------------------------------------------------------
# One busy process more than there are processors. The callback must need far less time than its block lasts, so that a kiosk with
# real-time priority has no gap. This test has no such priority, so a block may still be late.
loaded() {
    local i busy=() blown=0 worst xruns code=0
    for i in $(seq 0 "$(nproc)"); do
        nice -n 5 sh -c 'while :; do :; done' &
        busy+=($!)
        started+=($!)
    done
    SOFFIO_MEASURE_CALLBACK=1 limit=$(($1 + 120)) start_kiosk loaded --config "$root/kiosk-config/kiosk.toml" --no-attract --for "$1"
    local end=$((SECONDS + $1 - 15))
    sleep 5
    while [ "$SECONDS" -lt "$end" ] && kill -0 "$kiosk" 2>/dev/null; do
        before_microphone "$workdir/strong.wav"
        blown=$((blown + 1))
        sleep 2
    done
    end_kiosk loaded || code=$?
    kill "${busy[@]}"
    worst=$(sed -nE 's/.*the worst took ([0-9.]+) % of its time.*/\1/p' "$workdir/loaded.err")
    xruns=$(sed -nE 's/.*blocks, xruns: ([0-9]+),.*/\1/p' "$workdir/loaded.err")
    bar "under load: keeps running" "$code == 0" "exit code $code after $1 s, $blown breaths"
    bar "under load: no gap" "${xruns:-1} == 0" "${xruns:-?} gaps"
    bar "under load: callback" "${worst:-100} < 25" "the worst block took ${worst:-?} % of its time"
}

# ---- a live run equals an offline run --------------------------------------------------------------------------
one_run() {
    start_kiosk windowed --no-attract --windowed --breath "$recordings/normal.wav" --trace "$workdir/live.csv" --for 6
    end_kiosk windowed
    "$soffio" play "$exhibit" --breath "$recordings/normal.wav" --trace "$workdir/play.csv" --seconds 6 >/dev/null
    local same=0
    cmp "$workdir/live.csv" "$workdir/play.csv" && same=1
    bar "live is offline" "$same == 1" "$(wc -l <"$workdir/live.csv") rows, $(sha256sum <"$workdir/live.csv" | cut -c1-16)"
}

# ---- without microphone and loudspeaker: press and hold; a visitor cannot end the kiosk -------------------------
no_devices() {
    PULSE_SERVER=unix:$workdir/nobody start_kiosk no_audio --no-attract --trace "$workdir/no_audio.csv" --for 18
    sleep 2
    xdotool key Escape
    xdotool key alt+F4
    # Longer than devices may take to open.
    within 12 grep -q 'no microphone' "$workdir/no_audio.err" || true
    xdotool mousemove 880 300 mousedown 1
    within 10 held_times no_audio begins 1 || true
    sleep 2
    import -window root "$workdir/hold.png"
    xdotool mouseup 1
    local code=0
    end_kiosk no_audio || code=$?
    bar "no devices: keeps running" "$code == 0" "exit code $code after its time, past Esc and Alt+F4"
    local reports
    reports="$(grep -c 'no microphone' "$workdir/no_audio.err"), $(grep -c 'no loudspeaker' "$workdir/no_audio.err")"
    bar "no devices: reported" "\"$reports\" == \"1, 1\"" "$reports times"
    # The library's own messages about missing devices must not fill the log.
    bar "no devices: no noise" "$(grep -c '^ALSA lib' "$workdir/no_audio.err") == 0" "$(grep -c '^ALSA lib' "$workdir/no_audio.err") lines of the library's own"
    # The pointer is on the discs, which are light.
    read -r turn _ < <(motion "$workdir/no_audio.csv" 0 99)
    bar "hold to blow" "$turn > 5" "$turn degrees"
}

# ---- without display: the same exhibit, headless ---------------------------------------------------------------
no_display() {
    mkdir "$workdir/headless"
    local code=0
    (cd "$workdir/headless" && env -u DISPLAY timeout 20 "$soffio" kiosk --exhibit "$exhibit") \
        >"$workdir/headless.out" 2>"$workdir/headless.err" || code=$?
    bar "no display: says so" "$code == 3 && $(find "$workdir/headless" -type f | wc -l) == 0" "exit code $code, no demonstration unasked"
    code=0
    (cd "$workdir/headless" && env -u DISPLAY timeout 120 "$soffio" kiosk --demo --exhibit "$exhibit") \
        >"$workdir/headless.out" 2>"$workdir/headless.err" || code=$?
    local files
    files=$(cd "$workdir/headless/out" && find . -size +1k -name 'steel-fish.*' -printf '%f\n' | sort | xargs)
    bar "no display: the demo" "$code == 0 && \"$files\" ~ /csv/ && \"$files\" ~ /wav/" "exit code $code, left $files"
}

parts=${SOFFIO_LIVE_PARTS-${live_parts[*]}}
small=640x360
for part in ${parts:-other}; do
    [[ " ${small_parts[*]} " == *" $part "* ]] || small=
done
start_environment "$small"
breath normal
breath strong
# Two speakers, close and loud: peaks at −1 dB of full scale.
espeak-ng -v en-us -s 150 -w "$workdir/a.wav" "Look, Peter, the big black fish is floating in front of a white wall."
espeak-ng -v it+f3 -s 170 -w "$workdir/b.wav" "Che bello! Posso soffiare anche io, per favore, per piacere?"
sox "$workdir/a.wav" -r 48000 "$workdir/speech-a.wav" norm -1
sox "$workdir/b.wav" -r 48000 "$workdir/speech-b.wav" norm -1

ambient_noise

# Runs one part and prints its time.
timed() {
    local began=$SECONDS
    "$@"
    printf 'live: time  %-24s %s s\n' "$1" $((SECONDS - began))
}

for part in $parts; do
    timed "$part"
done
if [ -n "${SOFFIO_LIVE_SUITE:-}" ]; then
    timed devices "$SOFFIO_LIVE_SUITE"
fi
if [ -n "${SOFFIO_LIVE_FAULTS:-}" ]; then
    timed faults "$SOFFIO_LIVE_FAULTS"
fi
if [ -n "${SOFFIO_LIVE_STREAM:-}" ]; then
    timed streaming "$SOFFIO_LIVE_STREAM"
fi
if [ -n "${SOFFIO_LIVE_LOAD:-}" ]; then
    timed loaded "$SOFFIO_LIVE_LOAD"
fi
if [ -n "${SOFFIO_LIVE_SECONDS:-}" ]; then
    timed soak "$SOFFIO_LIVE_SECONDS"
fi
exit "$failed"
