#!/usr/bin/env bash
# Runs the parts of ./check and prints the time of each. ./check itself installs the packages. The output of each part is in out/check.
# All parts build the whole workspace with the profile `ci`, so that every dependency has the same features in each of them.
# tests/compile.sh runs clippy and rustdoc on every crate that is compiled, so `build` and `suite` include lints and documents.
set -euo pipefail
self=$(readlink -f "$0")
cd "$(dirname "$self")/.."
# Folder of the built program.
programs="${CARGO_TARGET_DIR:-target}/ci"
# Folder for the output and the exit code of each part.
results=out/check
everything=(format language headless build exhibits suite live)

compiled() { local verb=$1; shift; RUSTC_WORKSPACE_WRAPPER=$PWD/tests/compile.sh cargo "$verb" --profile ci --workspace --locked "$@"; }
# Rust as rustfmt writes it; scripts without what shellcheck warns of, such as a variable that nothing sets.
format()   { cargo fmt --all -- --check && git grep -lE '^#!/.*sh$' | xargs shellcheck --external-sources --severity=warning; }
# Names and sentences: no old word, no sentence that is too long.
language() { tests/language.py; }
# Without the kiosk: the two packages in which it is a feature.
headless() { cargo clippy --profile ci -p soffio -p soffio-offline --locked --quiet --all-targets --no-default-features -- -D warnings; }
# The program and the example `correlate`: everything that the parts need except tests.
build()    { compiled build "$@" --bins --example correlate; }
# The same for a part that runs alone.
program()  { [ -n "${SOFFIO_BUILT:-}" ] || build --quiet; }
suite()    { compiled test --quiet; }
exhibits() { program && "$programs/soffio" check exhibits kiosk-config/kiosk.toml; }
live()     { program && tests/live/lanes.sh "$programs/soffio"; }
deb()      { tests/package.sh; }

# Lints and documents alone, without compiling.
lints()    { cargo clippy --profile ci --workspace --locked --quiet --all-targets -- -D warnings; }
docs()     { RUSTDOCFLAGS="-D warnings" cargo doc --profile ci --workspace --locked --quiet --no-deps --document-private-items; }

# One test of the suite that is too long for every day; it must exist.
ignored() {
    compiled test --quiet --test suite -- --ignored --exact --nocapture "$1" |
        tee /dev/stderr | grep '^test result: ok. 1 passed' >/dev/null
}

# The same of all exhibits.
ignored_of_exhibits() {
    compiled test --quiet --test exhibits -- --ignored --nocapture "$1" |
        tee /dev/stderr | grep '^test result: ok. [1-9]' >/dev/null
}

# Path of the suite's program.
suite_binary() {
    compiled test --no-run --test suite --message-format=json 2>/dev/null |
        sed -n 's/.*"package_id":"[^"]*soffio@.*"executable":"\([^"]*suite-[^"]*\)".*/\1/p' | tail -1
}

# One bar of the rehearsed day: prints it from the report, and fails where it is not met.
rehearsed() {
    local bar
    bar=$(grep -o "{\"bar\":\"$1\"[^}]*}" out/long/rehearse.json) || bar="no report has the bar \"$1\""
    echo "$bar" >&2
    [[ $bar == *'"met":true'* ]]
}

# Runs that are too long for every change. Each leaves a stamp in out/long and is not repeated until the sources change.
long() {
    local stamp part missed=() released="${CARGO_TARGET_DIR:-target}/release/soffio"
    stamp=$(git rev-parse HEAD 2>/dev/null || echo none)
    mkdir -p out/long
    cargo build --release --locked --quiet
    for part in soak-blow soak-still soak-live stream-live loaded-live faults-live devices deb hands places million-hits clock-hour half-day beats schemas turning-gears visits plates blown cabinet wind steps contrast flashes minutes rehearse \
        answered first groups shuffled false_triggers staff attract fuzz; do
        if [ "$(cat "out/long/$part" 2>/dev/null)" = "$stamp" ]; then
            echo "== $part: done before"
            continue
        fi
        echo "== $part"
        case $part in
            soak-blow)  "$released" play steel-fish --script tests/long/hard-blows.jsonl --seconds 3600 ;;
            soak-still) "$released" play steel-fish --seconds 7200 ;;
            visits)     ignored wind::visits::motion_is_the_effect_of_the_visitor_in_two_hundred_visits ;;
            # Every shipped exhibit and language, on any Vulkan driver.
            contrast)   compiled test --quiet --test suite kiosk::contrast -- --include-ignored --nocapture ;;
            flashes)    compiled test --quiet --test suite kiosk::flashes -- --include-ignored --nocapture ;;
            # An hour in all; it reports a missing fuzzer.
            fuzz)       tests/fuzz/run.sh ;;
            hands)      ignored_of_exhibits ::grabs_cause_no_fault_in_twenty_seconds ;;
            places)     ignored_of_exhibits ::position_based_motion_of_twenty_seconds_does_not_fault ;;
            plates)     ignored curator::new::many_plates_hang_level_and_ring_in_a_breath ;;
            blown)      ignored mobiles::ten_minutes_of_hard_breath_tangle_nothing ;;
            cabinet)    ignored cabinet::ten_minutes_of_hard_breath_break_nothing_in_the_cabinet ;;
            # 10,000 patches among 5,000 triangles in 4 ms of one core, and 20 times faster than every triangle.
            wind)       "$released" bench --wind --json | tee /dev/stderr |
                            awk -F'"(ms_per_step|ratio)":' '{ split($2, ms, /[,}]/); split($3, ratio, /[,}]/); exit !(ms[1] <= 4 && ratio[1] >= 20) }' ;;
            # All exhibits under a hard breath, a fast hand and a hundred assemblies: no step is late.
            steps)      "$released" bench --seeds 100 --within 4.17 ;;
            soak-live)  SOFFIO_LIVE_PARTS='' SOFFIO_LIVE_SECONDS=7200 tests/live/run.sh "$released" ;;
            stream-live) SOFFIO_LIVE_PARTS='' SOFFIO_LIVE_STREAM=600 tests/live/run.sh "$released" ;;
            faults-live) SOFFIO_LIVE_PARTS='' SOFFIO_LIVE_FAULTS=100 tests/live/run.sh "$released" ;;
            loaded-live) SOFFIO_LIVE_PARTS='' SOFFIO_LIVE_LOAD=600 tests/live/run.sh "$released" ;;
            devices)    SOFFIO_LIVE_PARTS='' SOFFIO_LIVE_SUITE=$(suite_binary) tests/live/run.sh "$released" ;;
            deb)        deb ;;
            million-hits)  ignored hits::a_million_hits_keep_joints_energy_cone_and_momentum ;;
            beats)      ignored clock::two_minutes_of_beats_fall_where_a_finer_step_has_them
                        ignored clock::it_beats_6720_times_an_hour
                        ignored clock::it_beats_and_strikes_as_if_its_strike_never_slept ;;
            schemas)    cargo test --manifest-path tests/schemas/Cargo.toml --target-dir "${CARGO_TARGET_DIR:-target}/schemas" --release --locked --quiet ;;
            turning-gears) ignored motion::gears::gears_keep_their_phase_over_a_hundred_thousand_turns ;;
            half-day)      ignored clock::in_half_a_day_it_strikes_seventy_eight_blows ;;
            # Rehearsed minutes: equal reports of two runs, and a crowd that must cause no response.
            minutes)    compiled test --quiet --test suite rehearsal:: -- --ignored --nocapture ;;
            # A gallery day of eight hours. Each of its bars is a part of its own, so that a missed one hides no other.
            rehearse)   "$released" rehearse --hours 8 --json >out/long/rehearse.json || [ -s out/long/rehearse.json ] ;;
            answered | first | groups | shuffled | false_triggers | staff | attract)
                        rehearsed "$part" || { missed+=("$part"); continue; } ;;
            clock-hour)    ignored escapement::an_anchor_keeps_a_pendulum_going_for_an_hour ;;
        esac
        echo "$stamp" >"out/long/$part"
    done
    if [ ${#missed[@]} -gt 0 ]; then
        echo "== the rehearsed day misses: ${missed[*]}" >&2
        return 1
    fi
}

# ---- one part after another ----------------------------------------------------------------------------------------------------

# Runs a part as a process of its own, so that its first failing command ends it, and writes down its exit code and its time.
run_part() {
    local began=$SECONDS code=0
    "$self" --alone "$1" || code=$?
    echo "$code $((SECONDS - began))" >"$results/$1"
}

# Numbers of passed and failed tests of a part: "PASSED FAILED". A part without such counts is one test.
counted() { # counted PART EXIT-CODE
    awk -v code="$2" '
        /^test result: / { for (i = 2; i <= NF; i++) { if ($i ~ /^passed/) good += $(i - 1); if ($i ~ /^failed/) bad += $(i - 1) } }
        /^live: good / { good++ }
        /^live: BAD / { bad++ }
        END {
            if (code != 0 && !bad) bad = 1
            if (code == 0 && !good) good = 1
            print good + 0, bad + 0
        }' "$results/$1.log"
}

print_result() { # print_result PART
    local code time
    read -r code time <"$results/$1"
    [ "$code" = 0 ] && echo "== $1: good, $time s" || echo "== $1: FAILED, $time s"
}

# Times of all parts, and the sums of their tests.
table() {
    local part code time passed failed good=0 bad=0
    echo
    for part in "$@"; do
        [ -f "$results/$part" ] || { printf '%-10s      -    not run\n' "$part"; bad=$((bad + 1)); continue; }
        read -r code time <"$results/$part"
        read -r passed failed < <(counted "$part" "$code")
        good=$((good + passed)) bad=$((bad + failed))
        printf '%-10s %6d s  %5d passed, %d failed\n' "$part" "$time" "$passed" "$failed"
    done
    printf '%-10s %6d s\n' "all" "$SECONDS"
    echo "$good passed, $bad failed"
    [ "$bad" -eq 0 ]
}

run() {
    local part
    rm -rf "$results"
    mkdir -p "$results"
    for part in "$@"; do
        echo "== $part"
        run_part "$part" 2>&1 | tee "$results/$part.log"
        print_result "$part"
        if [ "$part" = build ]; then
            # Without the program no other part can run.
            [ "$(cut -d' ' -f1 "$results/build")" = 0 ] || break
            export SOFFIO_BUILT=1
        fi
    done
    table "$@"
}

case ${1:-} in
    --alone) "$2" ;;
    --long)  run long ;;
    "")      run "${everything[@]}" ;;
    *)
        for part in "$@"; do
            [[ " ${everything[*]} lints docs deb long " == *" $part "* ]] || { echo "check: there is no part \"$part\"; the parts are ${everything[*]} lints docs deb, or --long" >&2; exit 2; }
        done
        run "$@"
        ;;
esac
