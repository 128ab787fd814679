#!/usr/bin/env bash
# Runs the parts of ./check in order and stops at the first that fails. Packages are ./check's business.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."

format()   { cargo fmt --all -- --check; }
lints()    { cargo clippy --locked --quiet --all-targets -- -D warnings; }
headless() { cargo clippy --locked --quiet --all-targets --no-default-features -- -D warnings; }
# No test may be skipped here because something is missing: tests/suite/require.rs.
suite()    { SOFFIO_REQUIRE_ALL=1 cargo test --locked --quiet --workspace; }
# The program without devices, as fast as it gets; its path is in $released.
release() {
    cargo build --release --locked --quiet --no-default-features
    released="${CARGO_TARGET_DIR:-target}/release/soffio"
}
# The release build ends every exhibit's run in the state that its folder stores; devices have no part in it.
states() {
    local file id word found
    release
    for file in exhibits/*/expected.toml; do
        id=$(basename "$(dirname "$file")")
        word=$(sed -n 's/^state = "\(.*\)"$/\1/p' "$file")
        found=$("$released" play "$id" --script tests/cases/gusts.jsonl --seconds 41.6667)
        if [[ $found != *"\"state_hash\":\"$word\""* ]]; then
            echo "$id: $word is stored in $file, the release build ends in ${found##*state_hash}" >&2
            return 1
        fi
    done
}
exhibits() { release && "$released" check exhibits kiosk-config/kiosk.toml; }
docs()     { RUSTDOCFLAGS="-D warnings" cargo doc --locked --quiet --no-deps --document-private-items; }
live()     { cargo build --locked --quiet --bins --example correlate && tests/live/run.sh "${CARGO_TARGET_DIR:-target}/debug/soffio"; }

deb()      { tests/package.sh; }

# One test of the suite that is too long for every day; it must be there.
ignored() {
    cargo test --release --locked --quiet --no-default-features --test suite -- --ignored --exact --nocapture "$1" |
        tee /dev/stderr | grep '^test result: ok. 1 passed' >/dev/null
}

# The same of a crate's own tests, and of all exhibits.
ignored_in() {
    cargo test --release --locked --quiet -p "$1" --test suite -- --ignored --exact --nocapture "$2" |
        tee /dev/stderr | grep '^test result: ok. 1 passed' >/dev/null
}
ignored_of_exhibits() {
    cargo test --release --locked --quiet --no-default-features --test exhibits -- --ignored --nocapture "$1" |
        tee /dev/stderr | grep '^test result: ok. [1-9]' >/dev/null
}

# The suite's own program.
suite_binary() {
    cargo test --release --locked --no-run --test suite --message-format=json 2>/dev/null |
        sed -n 's/.*"executable":"\([^"]*suite-[^"]*\)".*/\1/p' | tail -1
}

# One bar of the rehearsed day, as its report has it: tells it, and fails where it is not met.
rehearsed() {
    local bar
    bar=$(grep -o "{\"bar\":\"$1\"[^}]*}" out/long/rehearse.json) || bar="no report has the bar \"$1\""
    echo "$bar" >&2
    [[ $bar == *'"met":true'* ]]
}

# Longer runs than a change needs: each leaves its mark in out/long and is not run again until the sources change.
long() {
    local stamp part missed=() built="${CARGO_TARGET_DIR:-target}/release"
    stamp=$(git rev-parse HEAD 2>/dev/null || echo none)
    mkdir -p out/long
    cargo build --release --locked --quiet
    for part in soak-blow soak-still soak-live stream-live loaded-live devices deb hands million-hits clock-hour half-day beats turning-gears visits blown cabinet wind contrast flashes minutes rehearse \
        answered first groups shuffled nobody staff attract fuzz; do
        if [ "$(cat "out/long/$part" 2>/dev/null)" = "$stamp" ]; then
            echo "== $part: done before"
            continue
        fi
        echo "== $part"
        case $part in
            soak-blow)  "$built/soffio" play steel-fish --script tests/long/hard-blows.jsonl --seconds 3600 ;;
            soak-still) "$built/soffio" play steel-fish --seconds 7200 ;;
            visits)     cargo test --locked --quiet --no-default-features --test suite two_hundred_visits -- --ignored --nocapture ;;
            # Every shipped work and language, on whatever Vulkan driver there is.
            contrast)   cargo test --release --locked --quiet --test suite kiosk::contrast -- --include-ignored --nocapture ;;
            flashes)    cargo test --release --locked --quiet --test suite kiosk::flashes -- --include-ignored --nocapture ;;
            # An hour in all; where the fuzzer is not installed it says so.
            fuzz)       tests/fuzz/run.sh ;;
            hands)      ignored_of_exhibits ::no_handling_breaks_anything_in_twenty_seconds ;;
            blown)      ignored mobiles::ten_minutes_of_hard_breath_tangle_nothing ;;
            cabinet)    ignored cabinet::ten_minutes_of_hard_breath_break_nothing_in_the_cabinet ;;
            # 10,000 patches among 5,000 triangles in 4 ms of one core, and 20 times faster than every triangle.
            wind)       "$built/soffio" bench --wind --json | tee /dev/stderr |
                            awk -F'"(ms_per_step|ratio)":' '{ split($2, ms, /[,}]/); split($3, ratio, /[,}]/); exit !(ms[1] <= 4 && ratio[1] >= 20) }' ;;
            soak-live)  SOFFIO_LIVE_SECONDS=7200 tests/live/run.sh "$built/soffio" ;;
            stream-live) SOFFIO_LIVE_PARTS='' SOFFIO_LIVE_STREAM=600 tests/live/run.sh "$built/soffio" ;;
            loaded-live) SOFFIO_LIVE_PARTS='' SOFFIO_LIVE_LOAD=600 tests/live/run.sh "$built/soffio" ;;
            devices)    SOFFIO_LIVE_PARTS='' SOFFIO_LIVE_SUITE=$(suite_binary) tests/live/run.sh "$built/soffio" ;;
            deb)        deb ;;
            million-hits)  ignored_in soffio-multibody hits::a_million_hits_keep_joints_energy_cone_and_momentum ;;
            beats)      ignored clock::two_minutes_of_beats_fall_where_a_finer_step_has_them ;;
            turning-gears) ignored_in soffio-multibody motion::gears::gears_keep_their_phase_over_a_hundred_thousand_turns ;;
            half-day)      ignored clock::in_half_a_day_it_strikes_seventy_eight_blows ;;
            # Rehearsed minutes: the same the second time, and a crowd that is to be answered nothing.
            minutes)    cargo test --release --locked --quiet --test suite rehearsal:: -- --ignored --nocapture ;;
            # An eight-hour gallery day; its exit code says whether all its bars are met. Each of them is a part of its own, so
            # that one that is missed hides none.
            rehearse)   "$built/soffio" rehearse --hours 8 --json >out/long/rehearse.json || [ -s out/long/rehearse.json ] ;;
            answered | first | groups | shuffled | nobody | staff | attract)
                        rehearsed "$part" || { missed+=("$part"); continue; } ;;
            clock-hour)    ignored_in soffio-multibody escapement::an_anchor_keeps_a_pendulum_going_for_an_hour ;;
        esac
        echo "$stamp" >"out/long/$part"
    done
    if [ ${#missed[@]} -gt 0 ]; then
        echo "== the rehearsed day misses: ${missed[*]}" >&2
        return 1
    fi
}

parts=("$@")
[ ${#parts[@]} -gt 0 ] || parts=(format lints headless docs suite states exhibits live)
[ "${parts[0]}" = --long ] && parts=(long)
for part in "${parts[@]}"; do
    echo "== $part"
    began=$SECONDS
    "$part"
    echo "== $part: good, $((SECONDS - began)) s"
done
