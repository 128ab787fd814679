# A soak test: hours of visitors and attract mode, with the kiosk's echo. Sourced by run.sh after environment.sh.
#
# Visitors come at random, the same ones for the same SOFFIO_LIVE_SEED. Each begins with a recorded breath, then presses, swipes, holds,
# aims, changes the exhibit, opens the catalog, changes volume and language, and leaves; then attract mode plays. The loudspeaker's
# output returns to the microphone.

# Uniform random integer from 0 to $1 − 1, from bash's seeded generator.
below() { echo $((RANDOM % $1)); }
# A place in the middle of the picture, pixels.
somewhere() { echo "$((320 + $(below 640))) $((140 + $(below 400)))"; }

# One action of a visitor after the breath.
act() {
    # shellcheck disable=SC2046
    case $1 in
        0 | 1) # Press and hold: a breath of the pointer.
            xdotool mousemove $(somewhere) mousedown 1
            sleep "0.$(below 10)"
            sleep 0.5
            xdotool mouseup 1
            ;;
        2 | 3) # A swipe, which may grab a part of the exhibit.
            xdotool mousemove $(somewhere) mousedown 1
            for _ in 1 2 3 4; do
                xdotool mousemove $(somewhere)
                sleep 0.1
            done
            xdotool mouseup 1
            ;;
        4)
            xdotool keydown space
            sleep "1.$(below 10)"
            xdotool keyup space
            ;;
        5) xdotool key Left Left Up Up Right Down ;;
        6) xdotool key plus plus minus ;;
        7) xdotool key Next ;;
        8) xdotool key l ;;
        9) # Through the catalog, to the selected exhibit.
            xdotool key Tab Tab Right Down
            sleep 0.5
            xdotool key Return
            sleep 0.5
            xdotool key Escape
            ;;
    esac
}

# Resident memory of the kiosk, kB.
resident() { awk '/VmRSS/ { print $2 }' "/proc/$1/status"; }

# 99th percentile of the frame time between two files of metrics, ms.
slowest() { # slowest BEFORE AFTER
    awk -F'["} ]+' '/^kiosk_frame_seconds_bucket/ { if (FNR == NR) before[$2] = $NF; else { le[++n] = $2; count[n] = $NF - before[$2] } }
        FNR == 1 { file++ }
        END {
            want = 0.99 * count[n]
            for (i = 1; i < n && count[i] < want; i++);
            low = i > 1 ? le[i - 1] : 0
            below = i > 1 ? count[i - 1] : 0
            if (le[i] == "+Inf") print 1000 * low
            else printf "%.0f", 1000 * (low + (le[i] - low) * (want - below) / (count[i] - below))
        }' "$1" "$2"
}

soak() {
    local blown=0 actions=0 detected code=0 pid t_on i third first last slow quick panics bytes swing
    RANDOM=${SOFFIO_LIVE_SEED:-1}
    printf '[exhibits]\nfolder = "%s"\nshow = ["steel-fish", "wind-chimes"]\n[audio]\nvolume_db = 0.0\n[attract]\nidle_s = 15.0\n[staff]\nmetrics = "%s"\n' \
        "$root/exhibits" "$workdir/soak.prom" >"$workdir/soak.toml"
    close_the_loop 0
    start soak "$root/kiosk-config/launch" "$soffio" kiosk --config "$workdir/soak.toml" --for "$1"
    kiosk=$last
    within 30 grep -q 'pixels on' "$workdir/soak.err"
    pid=$(child)
    local began=$SECONDS end=$((SECONDS + $1 - 25))
    sleep 5
    : >"$workdir/soak.memory"
    : >"$workdir/soak.blown"
    while [ "$SECONDS" -lt "$end" ] && kill -0 "$kiosk" 2>/dev/null; do
        now >>"$workdir/soak.blown"
        before_microphone "$workdir/normal.wav"
        blown=$((blown + 1))
        for ((i = $(below 8); i >= 0; i--)); do
            act "$(below 10)"
            actions=$((actions + 1))
            sleep "0.$(below 10)"
        done
        # A visitor who leaves releases everything.
        xdotool mouseup 1 keyup space
        sleep $((16 + $(below 25)))
        echo "$((SECONDS - began)) $(resident "$pid")" >>"$workdir/soak.memory"
        cp "$workdir/soak.prom" "$workdir/soak.prom.$((3 * (SECONDS - began) / $1))" 2>/dev/null || true
    done
    # Compare the second and the last third; the first one includes the warm-up.
    local samples=$workdir/soak.memory
    read -r first last swing < <(awk -v t="$1" '
        $1 > t / 3 && $1 <= 2 * t / 3 { a += $2; n++ } $1 > 2 * t / 3 { b += $2; m++ }
        $1 > t / 3 { if (!low || $2 < low) low = $2; if ($2 > high) high = $2 }
        END { if (n && m) print int(a / n), int(b / m), high - low; else print 0, 0, 0 }' "$samples")
    quick=$(slowest "$workdir/soak.prom.0" "$workdir/soak.prom.1")
    slow=$(slowest "$workdir/soak.prom.1" "$workdir/soak.prom.2")
    end_kiosk soak || code=$?
    open_the_loop
    detected=$(breaths soak microphone begins | wc -l)
    # Time from sending a recording to the sound server until the kiosk logs a breath.
    log_times soak 'begins (microphone)' | cat - "$workdir/soak.blown" | awk -v n="$detected" '
        NR <= n { begun[NR] = $1 } NR > n { for (i = 1; i <= n; i++) if (begun[i] > $1 && begun[i] < $1 + 3) { printf "wind 0 %.0f\n", 1000 * (begun[i] - $1); break } }' >"$workdir/stream.delays"
    third=$(delays wind | later)
    panics=$(grep -c 'panicked' "$workdir/soak.err" || true)
    bytes=$(wc -c <"$workdir/soak.err")
    bar "soak: ends by itself" "$code == 0 && $panics == 0" "exit code $code after $1 s, $blown visitors, $actions actions, $panics panics"
    # A breath in the very second in which the exhibit changes may be missed.
    bar "soak: breaths" "$detected <= $blown && $detected >= 0.95 * $blown" "$detected of $blown detected, no false trigger from $(breaths soak hold begins | wc -l) held and $(breaths soak script begins | wc -l) scripted ones"
    # The start of the player varies by some tens of milliseconds on a busy computer.
    bar "soak: delay is constant" "$third <= 60 && $third >= -60" \
        "$(delays wind | rank 0.5) ms from player to wind, in the last third $third ms later than in the first"
    # Two exhibits of different size take turns, so the mean is compared.
    bar "soak: memory" "$first > 0 && $last - $first <= 5120 && $first - $last <= 5120" \
        "$first kB in the second third, $last kB in the last; between its least and most $swing kB"
    # The frame time of a software renderer varies with the load of the computer.
    bar "soak: pictures" "$slow <= 1.5 * $quick" "99 of 100 within $quick ms in the second third, $slow ms in the last"
    bar "soak: log" "$bytes < 2000 * ($blown + 20)" "$bytes bytes, $((bytes * 3600 / $1 / 1024)) KiB an hour"
}
