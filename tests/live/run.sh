#!/usr/bin/env bash
# The live proof: the kiosk as a visitor meets it, before a virtual microphone, loudspeaker and display (room.sh).
#
#   tests/live/run.sh target/ci/soffio
#
# SOFFIO_LIVE_SECONDS=7200 adds a soak of that length with the visitors of SOFFIO_LIVE_SEED (soak.sh),
# SOFFIO_LIVE_STREAM=600 a stream of breaths whose delays are measured,
# SOFFIO_LIVE_LOAD=600 sound under a load of one process more than there are processors;
# SOFFIO_LIVE_SUITE=target/ci/deps/suite-… the suite's own tests of the devices, which need this room;
# SOFFIO_LIVE_PARTS names the parts to run; SOFFIO_LIVE_KEEP=FOLDER keeps pictures, logs, traces and sounds.
# One line per bar, and one for the time of each part; every threshold says why it is what it is. Nothing here depends on how
# fast the machine draws. Each run has a room of its own, so that several can run side by side (lanes.sh).
# What this machine cannot do is left out, and said; with SOFFIO_REQUIRE_ALL or CI=true it is a bar that is missed.
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
. "$here/room.sh"
. "$here/robust.sh"
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

# What this machine cannot show, and what to do about it: left out, or missed where everything has to be there.
cannot() { # cannot NAME "why, and what to install"
    if [ -n "${SOFFIO_REQUIRE_ALL:-}" ]; then
        printf 'live: BAD   %-24s %s\n' "$1" "$2"
        failed=1
    else
        printf 'live: SKIP  %-24s %s\n' "$1" "$2"
    fi
}

# Largest turn and shift of all bodies, or of one, in a span of a trace: "DEGREES MM".
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

# A breath as the capsule hears it, at the sound server's own rate.
breath() { sox "$recordings/$1.wav" -r 48000 -e float -b 32 "$room/$1.wav"; }

# Does the record of a run come to the state in which the kiosk ended?
replays() { # replays RUN
    (cd "$root" && "$soffio" replay "$room/$1.jsonl") >"$room/replay.out" 2>&1 || true
    [ -n "$(hash_in "$room/$1.out")" ] && [ "$(hash_in "$room/replay.out")" = "$(hash_in "$room/$1.out")" ] && echo 1 || echo 0
}
hash_in() { sed -n 's/.*"state_hash":"\([0-9a-f]*\)".*/\1/p' "$1"; }

# ---- a breath moves the sculpture and sounds; speech does neither ----------------------------------------------
a_visitor() {
    local before during speech t_on t_off at differ
    start_kiosk visitor --config "$root/kiosk-config/kiosk.toml" --no-attract --trace "$room/visitor.csv" --record "$room/visitor.jsonl" --for 30
    within 30 grep -q 'supervisor: microphone: ' "$room/visitor.err"
    start speakers parec -d speakers.monitor --rate=48000 --channels=2 --format=float32le --latency-msec=20 \
        --raw
    local recorder=$last t_rec
    within 30 test -s "$room/speakers.out"
    t_rec=$(now)
    # The detector has learnt the room after 0.25 s.
    sleep 3
    for speech in "$room"/speech-*.wav; do before_microphone "$speech"; done
    # Speech with peaks at full scale is as loud as a shout into the microphone: what it leaves in the ear fades.
    sleep 4
    import -window root "$room/before.png"
    t_on=$(now)
    before_microphone "$room/strong.wav" &
    sleep 2
    import -window root "$room/during.png"
    wait $!
    t_off=$(now)
    end_kiosk visitor
    kill "$recorder"
    wait "$recorder" 2>/dev/null || true
    bar "replayed to the bit" "$(replays visitor) == 1" "the record of this run, run again: $(hash_in "$room/replay.out")"

    at=$(breaths visitor microphone begins | head -1)
    bar "breath heard" "${at:-0} > 8 && $(breaths visitor microphone begins | wc -l) == 1" \
        "begins at ${at:-never} s, once"
    at=${at:-25}
    # A gentle push turns the boom by 5° within seconds; the strong one does much more.
    read -r turn _ < <(motion "$room/visitor.csv" "$at" 99 Boom)
    bar "breath turns the boom" "$turn > 5" "$turn degrees"
    # The works fill the middle of the picture, the ring with the meter about 1 % of it.
    share=$(changed "$room/before.png" "$room/during.png" 1024x504+128+72)
    bar "breath is seen" "$share > 0.02" "$share of the pixels changed"
    before=$(level "$room/speakers.out" "$(awk "BEGIN { print $t_on - $t_rec - 2 }")" 1.5)
    during=$(level "$room/speakers.out" "$(awk "BEGIN { print $t_on - $t_rec + 0.7 }")" 1.2)
    after=$(level "$room/speakers.out" "$(awk "BEGIN { print $t_off - $t_rec + 3 }")" 1.5)
    bar "wind is heard" "$during > $before + 15 && $during > $after + 10" "$before, $during, $after dBFS before, during, after"
    # The room's own air moves the work a little, the same in every run: what speech must not change is any digit of it.
    "$soffio" play "$exhibit" --trace "$room/empty.csv" --seconds 30 >/dev/null
    local rows
    read -r rows differ < <(awk -F, -v to="$(awk "BEGIN { print $at - 0.05 }")" '
        NR == FNR { empty[FNR] = $0; next }
        FNR > 1 && $1 < to { rows++; differ += empty[FNR] != $0 }
        END { print rows + 0, differ + 0 }' "$room/empty.csv" "$room/visitor.csv")
    bar "speech moves nothing" "$rows > 1000 && $differ == 0" "$differ of $rows rows differ from an empty room's"
}

# Both loudspeakers as one, whichever of them the wind is nearer to.
both=2v0.71,3v0.71

# ---- from the lips to wind, sound and picture -----------------------------------------------------------------------
# Sound: on one clock, from the breath at the microphone (5 ms louder than −45 dBFS) to the loudspeaker (−60 dBFS).
# Wind and picture: the kiosk's own stamps. What a debug build on software graphics takes for a picture says nothing of
# a kiosk; that it is the next picture does.
latency() {
    local breaths=(strong normal strong normal strong normal strong normal strong) name took seen
    start_kiosk latency --config "$root/kiosk-config/kiosk.toml" --no-attract
    within 30 grep -q 'supervisor: microphone: ' "$room/latency.err"
    start air parec -d air.monitor --rate=48000 --channels=3 --channel-map=aux0,aux1,aux2 --format=float32le \
        --latency-msec=20 --raw
    local recorder=$last
    within 30 test -s "$room/air.out"
    sleep 3
    for name in "${breaths[@]}"; do
        before_microphone "$room/$name.wav"
        # What it set ringing dies away.
        sleep 4
    done
    kill "$recorder"
    wait "$recorder" 2>/dev/null || true
    leave_kiosk latency
    # Onsets after at least a second of quiet, at the microphone and at the loudspeakers, in blocks of 240 frames: of each
    # breath the first sound after it.
    took=$(awk 'NR == FNR { sound[++n] = $1; next } { for (i = 1; i <= n && sound[i] < $1; i++); if (i <= n) print int(1000 * (sound[i] - $1)) }' \
        <(onsets "$room/air.out" "$both" -60) <(onsets "$room/air.out" 1 -45) | sort -n | xargs)
    local median most
    median=$(echo "$took" | tr ' ' '\n' | rank 0.5)
    most=${took##* }
    # A detector may take 140 ms; a block of microphone and one of loudspeaker, a step and the attack of the sound.
    bar "breath to sound" "$(echo "$took" | wc -w) == 9 && $median <= 220 && $most <= 350" \
        "$took ms, blocks of $(block latency microphone) and $(block latency loudspeaker) ms"
    seen=$(sed -nE 's/.* seen ([0-9.]+) ms after it, in the next picture.*/\1/p' "$room/latency.err" | xargs)
    bar "breath to picture" "$(echo "$seen" | wc -w) == 9" "$seen ms after its first wind, each time in the next picture"
}

# ---- the way from microphone to wind does not grow -------------------------------------------------------------------
# A breath every few seconds. Sound: on one clock, as above. Wind: the kiosk's log against that clock, which begins with
# the recording, so that only changes count. A detector looks every 8 ms and blocks lie anyhow: medians of the first
# and of the last third are compared, and may differ by a block.
streaming() {
    local blown=0 t_rec end block winds sounds median slow late_sound late_wind
    limit=$(($1 + 90)) start_kiosk stream --config "$root/kiosk-config/kiosk.toml" --no-attract --for "$1"
    within 30 grep -q 'supervisor: microphone: ' "$room/stream.err"
    end=$((SECONDS + $1 - 20))
    start stream_air parec -d air.monitor --rate=48000 --channels=3 --channel-map=aux0,aux1,aux2 --format=float32le \
        --latency-msec=20 --raw
    local recorder=$last
    within 30 test -s "$room/stream_air.out"
    t_rec=$(now)
    sleep 3
    while [ "$SECONDS" -lt "$end" ]; do
        before_microphone "$room/strong.wav"
        blown=$((blown + 1))
        sleep 2
    done
    kill "$recorder"
    wait "$recorder" 2>/dev/null || true
    end_kiosk stream
    onsets "$room/stream_air.out" 1 -45 | sed 's/^/breath /' >"$room/stream.times"
    onsets "$room/stream_air.out" "$both" -60 | sed 's/^/sound /' >>"$room/stream.times"
    log_times stream 'begins (microphone)' | awk -v t="$t_rec" '{ print "wind", $1 - t }' >>"$room/stream.times"
    # Of each breath the first wind and the first sound about it; while an earlier chime still rings, a sound has no onset.
    awk '$1 == "breath" { at[++n] = $2 } $1 != "breath" { for (i = n; i && at[i] > $2 + 0.5; i--); if (i && $2 < at[i] + 1.5 && !((i, $1) in d)) d[i, $1] = 1000 * ($2 - at[i]) }
        END { for (i = 1; i <= n; i++) for (k in d) { split(k, w, SUBSEP); if (w[1] == i) printf "%s %.2f %.1f\n", w[2], at[i], d[k] } }' \
        "$room/stream.times" >"$room/stream.delays"
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
        "after $1 s wind comes $late_wind ms and sound $late_sound ms later, blocks of $block ms; $(tail -1 "$room/stream.err" | grep -o 'dropped.*' || true)"
}
# The delays of one kind, in the order of the breaths.
delays() { awk -v kind="$1" '$1 == kind { print $3 }' "$room/stream.delays"; }
# The number below which that share of the numbers lies.
rank() { sort -n | awk -v share="$1" '{ x[NR] = $1 } END { print x[int(share * (NR - 1)) + 1] }'; }
# By how much the last third of the numbers lies above the first, in their medians.
later() {
    local numbers third
    numbers=$(cat)
    third=$(($(wc -l <<<"$numbers") / 3))
    awk -v a="$(head -n "$third" <<<"$numbers" | rank 0.5)" -v b="$(tail -n "$third" <<<"$numbers" | rank 0.5)" 'BEGIN { print b - a }'
}

# ---- whoever sets the kiosk up blows three times, at two capsules ----------------------------------------------------
doctor_blow() {
    local code=0 doctor pair heard level
    printf '[audio]\nmicrophone = "pair"\nmicrophone_channel = 1\nsecond_microphone_channel = 2\n[exhibits]\nfolder = "%s"\n' \
        "$root/exhibits" >"$room/pair.toml"
    pair=$(pactl load-module module-remap-source source_name=pair master=air.monitor channels=2 \
        channel_map=front-left,front-right master_channel_map=aux0,aux0 remix=no)
    start doctor timeout 60 "$soffio" doctor --blow --config "$room/pair.toml"
    doctor=$last
    within 30 grep -q 'Blow at the microphone' "$room/doctor.err"
    for _ in 1 2 3; do
        before_microphone "$room/normal.wav"
        sleep 1.5
    done
    wait "$doctor" || code=$?
    pactl unload-module "$pair"
    heard=$(sed -nE 's/^(ok|warn) +a breath: //p' "$room/doctor.out")
    level=$(sed -nE 's/^(ok|warn|bad) +microphone level: //p' "$room/doctor.out")
    bar "doctor hears three breaths" "$code == 0 && \"$heard\" ~ /^heard 3, /" "exit code $code, $heard"
    bar "doctor: level and floor" "\"$level\" ~ /^-[0-9.]+ dBFS, peak .*floor .* -[0-9.]+ dBFS/" "$level"
    bar "doctor: two capsules" "$(grep -c 'second capsule: it listens' "$room/doctor.out") == 1" \
        "$(grep 'second capsule' "$room/doctor.out" || echo nothing is said of a second capsule)"
}

# ---- the kiosk never answers itself, even beside its loudspeaker, and hears a breath over its own sound -------------------------------------
own_voice() {
    local loud before t_on t_off begun ended
    configured "$room/loud.toml" '[exhibits]\nshow = ["steel-fish"]\n[audio]\nvolume_db = 0.0\n'
    # At full volume, and 12 dB louder than it plays: a sensitive capsule in the loudspeaker's face.
    close_the_loop 12
    start ears parec -d mic_in.monitor --rate=48000 --channels=2 --format=float32le --latency-msec=20 --raw
    start_kiosk own --no-attract --config "$room/loud.toml"
    within 30 grep -q 'supervisor: microphone: ' "$room/own.err"
    sleep 2
    for place in "340 300" "925 280"; do
        # shellcheck disable=SC2086
        xdotool mousemove $place
        hold own 2
        sleep 3
    done
    # Ten times the power of the room's own −60 dBFS, on the mean over all pauses.
    loud=$(level "$room/ears.out" 0 99)
    begun=$(breaths own hold begins | wc -l)
    bar "own voice: it sounds" "$begun == 2 && $loud > -50" "$begun held breaths, $loud dBFS at the microphone"
    bar "own voice: no answer" "$(breaths own microphone begins | wc -l) == 0" \
        "breaths heard at: $(breaths own microphone begins | xargs)"
    before=$(breaths own microphone begins | wc -l)
    t_on=$(now)
    before_microphone "$room/normal.wav"
    t_off=$(now)
    sleep 4
    begun=$(log_times own 'begins (microphone)' | tail -n +$((before + 1)) | head -1)
    ended=$(log_times own 'ends (microphone)' | tail -1)
    bar "breath over own sound" "${begun:-0} > $t_on && ${begun:-0} < $t_off" \
        "heard $(awk "BEGIN { print ${begun:-0} - $t_on }") s after it was begun to be played"
    bar "breath ends" "${ended:-0} > $t_on && ${ended:-9e9} < $t_off + 1" \
        "$(awk "BEGIN { print ${ended:-0} - $t_off }") s after the recording"
    leave_kiosk own
    open_the_loop
}

# ---- labels are read aloud through the kiosk's own sound, which the ear knows ------------------------------------------
# One key begins, the same key or a touch ends; the voice comes back to the microphone as loud as it was played, and is no
# breath.
reads_aloud() {
    local before during hushed again touched t_rec at press
    close_the_loop 0
    start_kiosk aloud --no-attract
    within 30 grep -q 'supervisor: microphone: ' "$room/aloud.err"
    start voice parec -d speakers.monitor --rate=48000 --channels=2 --format=float32le --latency-msec=20 --raw
    local recorder=$last
    within 30 test -s "$room/voice.out"
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
    # Seconds of the recording at the end of each part; of each its last two are judged.
    at=()
    for t in "${times[@]}"; do at+=("$(awk "BEGIN { print $t - $t_rec - 2.2 }")"); done
    before=$(level "$room/voice.out" "${at[0]}" 2)
    during=$(level "$room/voice.out" "${at[1]}" 2)
    hushed=$(level "$room/voice.out" "${at[2]}" 2)
    again=$(level "$room/voice.out" "${at[3]}" 2)
    touched=$(level "$room/voice.out" "${at[4]}" 2)
    # Speech at −20 LUFS and −6 dB of volume; a silent work is 40 dB below, and the touch may have moved the work.
    bar "a key reads aloud" "$during > -40 && $again > -40 && $during > $before + 15" "$before, then $during and $again dBFS"
    bar "a second press hushes" "$hushed < $during - 15" "$hushed dBFS"
    bar "a touch hushes" "$touched < $again - 10" "$touched dBFS"
    bar "the voice is no breath" "$(breaths aloud microphone begins | wc -l) == 0" \
        "$(breaths aloud microphone begins | wc -l) breaths with the voice at the microphone"
}

# Does the voice's recording end in a voice, or in none?
speaks() {
    tail -c 192000 "$room/voice.out" >"$room/voice.end"
    holds "$(level "$room/voice.end" 0 1) > -45"
}
hushed() { ! speaks; }

# ---- no sample of the microphone is ever written, sent, or mapped where others read it -----------------------------
# A known noise is played at the microphone of a kiosk whose every write and send is traced; its shared memory is read
# while it runs, and every file that it leaves afterwards. Nothing of it may resemble the noise; planted copies must.
privacy() {
    local address pid kiosk_soffio=$soffio found=0 planted file
    if ! command -v strace >/dev/null; then
        cannot "privacy" "strace is missing: apt-get install strace"
        return
    fi
    if ! strace -f --seccomp-bpf -o /dev/null true 2>/dev/null; then
        cannot "privacy" "no process may be traced here: allow ptrace (in a container --cap-add=SYS_PTRACE)"
        return
    fi
    sox -R -n -r 48000 -c 1 -e float -b 32 "$room/known.wav" synth 4 whitenoise norm -12
    sox "$room/known.wav" -t raw "$room/known.f32"
    sox "$room/known.wav" -r 16000 -t raw -e signed -b 16 "$room/planted.i16"
    od -An -v -w4 -tf4 "$room/known.f32" | awk '{ printf "%.5f,%s\n", NR / 48000, $1 }' >"$room/planted.csv"
    od -An -v -w16 -tx1 "$room/known.f32" | sed 's/ /\\x/g; s/.*/write(7, "&", 16) = 16/' >"$room/planted.strace"
    # Pictures are written to the display: a small one keeps the trace small.
    start small Xvfb -displayfd 1 -screen 0 160x90x24 -nolisten tcp
    within 30 test -s "$room/small.out"
    address=:$(cat "$room/small.out")
    DISPLAY=$address start manager openbox
    DISPLAY=$address within 30 xdotool get_desktop
    cat >"$room/traced" <<TRACED
#!/bin/sh
exec strace -f --seccomp-bpf -qq -s 1048576 -xx -o $room/kiosk.strace \
    -e trace=write,pwrite64,writev,pwritev,pwritev2,sendto,sendmsg,sendmmsg $kiosk_soffio "\$@"
TRACED
    chmod +x "$room/traced"
    touch "$room/before"
    # In a folder of its own, where it would leave its files: beside this room others may write into out/.
    mkdir "$room/privacy.folder"
    cd "$room/privacy.folder"
    DISPLAY=$address soffio=$room/traced start_kiosk privacy --config "$root/kiosk-config/kiosk.toml" --no-attract --record "$room/privacy.jsonl" --for 16
    cd "$OLDPWD"
    within 30 grep -q 'supervisor: microphone: ' "$room/privacy.err"
    sleep 2
    before_microphone "$room/known.wav"
    pid=$(descendants "$kiosk" | while read -r id; do [ "$(readlink "/proc/$id/exe")" != "$kiosk_soffio" ] || echo "$id"; done | tail -1)
    grep 'rw-s' "/proc/$pid/maps" | while IFS=' -' read -r from to _; do
        dd if="/proc/$pid/mem" bs=4096 iflag=skip_bytes,count_bytes skip=$((0x$from)) count=$((0x$to - 0x$from)) 2>/dev/null || true
    done >"$room/kiosk.mapped"
    end_kiosk privacy
    # Copies: shared memory of other rooms comes and goes meanwhile.
    mkdir "$room/left"
    find "$HOME" "$XDG_RUNTIME_DIR" "$room/privacy.folder" /dev/shm -type f -newer "$room/before" 2>/dev/null | while read -r file; do
        cp "$file" "$room/left/${file//\//+}" 2>/dev/null || true
    done
    mapfile -t left < <(find "$room/left" -type f)
    local heard
    heard=$(grep -c . "$room/kiosk.strace")
    planted=$("$correlate" "$room/known.f32" "$room"/planted.* | grep -c FOUND || true)
    "$correlate" "$room/known.f32" "$room/kiosk.strace" "$room/kiosk.mapped" "$room/privacy.err" "$room/privacy.jsonl" "${left[@]}" \
        >"$room/privacy.correlate" || found=1
    bar "privacy" "$found == 0 && $planted == 3 && $heard > 1000" \
        "$planted of 3 planted copies found; $heard writes and sends, ${#left[@]} files: at most $(awk '$2 > m { m = $2 } END { print m }' "$room/privacy.correlate")"
}

# ---- ten times the microphone is pulled out and put in again --------------------------------------------------------
replugged() {
    local i before
    limit=180 start_kiosk replugged --no-attract --trace "$room/replugged.csv"
    within 30 grep -q 'supervisor: microphone: ' "$room/replugged.err"
    for i in {1..10}; do
        before=$(grep -c 'supervisor: microphone: ' "$room/replugged.err")
        pull_microphone
        within 8 lost_times replugged "$i"
        plug_microphone
        # It is tried again after 1, 2, 4 … s; it worked since, so after one.
        within 8 listens_times replugged $((before + 1)) || break
    done
    bar "ten times replugged" "$(grep -c 'microphone lost' "$room/replugged.err") == 10 && $(grep -c 'supervisor: microphone: ' "$room/replugged.err") == 11" \
        "lost $(grep -c 'microphone lost' "$room/replugged.err") times, $(grep -c 'supervisor: microphone: ' "$room/replugged.err") times opened"
    # A breath while it is out, and one after it is back.
    pull_microphone
    within 8 lost_times replugged 11
    before_microphone "$room/strong.wav"
    bar "pulled out: no wind" "$(breaths replugged microphone begins | wc -l) == 0" "$(breaths replugged microphone begins | wc -l) breaths heard"
    plug_microphone
    within 12 listens_times replugged 12
    sleep 2
    before_microphone "$room/strong.wav"
    sleep 1
    bar "back: it listens" "$(breaths replugged microphone begins | wc -l) == 1" "$(breaths replugged microphone begins | wc -l) breaths heard"
    leave_kiosk replugged
}
lost_times() { [ "$(grep -c 'microphone lost' "$room/$1.err")" -ge "$2" ]; }
listens_times() { [ "$(grep -c 'supervisor: microphone: ' "$room/$1.err")" -ge "$2" ]; }

# ---- the loudspeaker is pulled out and put in again: it sounds again, and the motion never stopped -------------------
speaker_replugged() {
    local i rows gaps
    configured "$room/mute.toml" '[exhibits]\nshow = ["steel-fish"]\n[audio]\noutput = "speakers"\n'
    start_kiosk mute --no-attract --config "$room/mute.toml" --trace "$room/mute.csv" --for 36
    within 30 grep -q 'supervisor: loudspeaker: ' "$room/mute.err"
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
    bar "loudspeaker replugged" "$(grep -c 'loudspeaker lost' "$room/mute.err") == 3 && $(grep -c 'supervisor: loudspeaker: ' "$room/mute.err") == 4" \
        "lost $(grep -c 'loudspeaker lost' "$room/mute.err") times, $(grep -c 'supervisor: loudspeaker: ' "$room/mute.err") times opened"
    # A stream that was not opened again is digital silence here; how loud the wind of a second is (-49 to -51 dBFS) hangs on how
    # the work swings just then.
    # Its last seconds: when the key is heard hangs on the picture that is drawn meanwhile.
    local loud
    loud=$(level "$room/back.out" "$(awk -v bytes="$(stat -c %s "$room/back.out")" 'BEGIN { t = bytes / 384000 - 2.5; print (t > 0 ? t : 0) }')" 2)
    bar "back: it sounds" "$loud > -60" "$loud dBFS"
    # A row 60 times a second, whatever the loudspeaker does.
    read -r rows gaps < <(awk -F, 'FNR > 2 && $1 - t > 0.018 { gaps++ } FNR > 1 { t = $1; times[$1] } END { print length(times), gaps + 0 }' "$room/mute.csv")
    bar "the motion goes on" "$rows >= 2150 && $gaps == 0" "$rows moments in 36 s, $gaps gaps"
}
spoken() { [ "$(grep -c "$2" "$room/$1.err")" -ge "$3" ]; }

# ---- sound under load -----------------------------------------------------------------------------------------------
# Every processor is kept busy, and one process more. What is ours is the callback: it must need far less than its block
# lasts, so that a kiosk of real-time priority has no gap. Here nobody grants that priority, and a block may still be late.
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
        before_microphone "$room/strong.wav"
        blown=$((blown + 1))
        sleep 2
    done
    end_kiosk loaded || code=$?
    kill "${busy[@]}"
    worst=$(sed -nE 's/.*the worst took ([0-9.]+) % of its time.*/\1/p' "$room/loaded.err")
    xruns=$(sed -nE 's/.*blocks, xruns: ([0-9]+),.*/\1/p' "$room/loaded.err")
    bar "under load: runs on" "$code == 0" "exit code $code after $1 s, $blown breaths"
    bar "under load: no gap" "${xruns:-1} == 0" "${xruns:-?} gaps"
    bar "under load: callback" "${worst:-100} < 25" "the worst block took ${worst:-?} % of its time"
}

# ---- live and offline are one run ------------------------------------------------------------------------------
one_run() {
    start_kiosk windowed --no-attract --windowed --breath "$recordings/normal.wav" --trace "$room/live.csv" --for 6
    end_kiosk windowed
    "$soffio" play "$exhibit" --breath "$recordings/normal.wav" --trace "$room/play.csv" --seconds 6 >/dev/null
    local same=0
    cmp "$room/live.csv" "$room/play.csv" && same=1
    bar "live is offline" "$same == 1" "$(wc -l <"$room/live.csv") rows, $(sha256sum <"$room/live.csv" | cut -c1-16)"
}

# ---- no microphone, no loudspeaker: press and hold; no way out for a visitor ------------------------------------
no_devices() {
    PULSE_SERVER=unix:$room/nobody start_kiosk deaf --no-attract --trace "$room/deaf.csv" --for 18
    sleep 2
    xdotool key Escape
    xdotool key alt+F4
    # Beyond the time that devices may take to open.
    within 12 grep -q 'no microphone' "$room/deaf.err" || true
    xdotool mousemove 880 300 mousedown 1
    within 10 held_times deaf begins 1 || true
    sleep 2
    import -window root "$room/hold.png"
    xdotool mouseup 1
    local code=0
    end_kiosk deaf || code=$?
    bar "no devices: runs on" "$code == 0" "exit code $code after its time, past Esc and Alt+F4"
    local told
    told="$(grep -c 'no microphone' "$room/deaf.err"), $(grep -c 'no loudspeaker' "$room/deaf.err")"
    bar "no devices: says so" "\"$told\" == \"1, 1\"" "$told times"
    # No devices at all, and yet the library's own complaints do not fill the log.
    bar "no devices: no noise" "$(grep -c '^ALSA lib' "$room/deaf.err") == 0" "$(grep -c '^ALSA lib' "$room/deaf.err") lines of the library's own"
    # The pointer lies on the discs, which are light.
    read -r turn _ < <(motion "$room/deaf.csv" 0 99)
    bar "hold to blow" "$turn > 5" "$turn degrees"
}

# ---- no display: the same exhibit, headless --------------------------------------------------------------------
no_display() {
    mkdir "$room/headless"
    local code=0
    (cd "$room/headless" && env -u DISPLAY timeout 120 "$soffio" kiosk --exhibit "$exhibit") \
        >"$room/headless.out" 2>"$room/headless.err" || code=$?
    local files
    files=$(cd "$room/headless/out" && find . -size +1k -name 'steel-fish.*' -printf '%f\n' | sort | xargs)
    bar "no display: runs on" "$code == 0 && \"$files\" ~ /csv/ && \"$files\" ~ /wav/" "exit code $code, left $files"
}

parts=${SOFFIO_LIVE_PARTS-${live_parts[*]}}
small=640x360
for part in ${parts:-other}; do
    [[ " ${small_parts[*]} " == *" $part "* ]] || small=
done
enter_room "$small"
breath normal
breath strong
# Two speakers, close and loud: peaks at −1 dB of full scale.
espeak-ng -v en-us -s 150 -w "$room/a.wav" "Look, Peter, the big black fish is floating in front of a white wall."
espeak-ng -v it+f3 -s 170 -w "$room/b.wav" "Che bello! Posso soffiare anche io, per favore, per piacere?"
sox "$room/a.wav" -r 48000 "$room/speech-a.wav" norm -1
sox "$room/b.wav" -r 48000 "$room/speech-b.wav" norm -1

room_tone

# One part, and how long it took.
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
