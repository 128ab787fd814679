#!/usr/bin/env bash
# Fuzzes the readers of files, one after the other: tests/fuzz/run.sh [SECONDS [TARGET…]], an hour for all by default.
# Ends with 1 at the first finding, whose input lies in out/fuzz/found. Corpora grow in out/fuzz and are taken up again.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."

seconds=${1:-280}
targets=("${@:2}")
[ ${#targets[@]} -gt 0 ] || targets=(sidecar model recording timbre config script scene drawing labels record order osc serial)
if ! cargo +nightly fuzz --version >/dev/null 2>&1; then
    echo "needs a nightly toolchain and cargo-fuzz: rustup toolchain install nightly && cargo install cargo-fuzz" >&2
    exit 1
fi

# Good files of every kind are in the tree already.
seeds() {
    case $1 in
        sidecar) printf '%s\n' tests/cases/exhibit-bad/*.toml tests/cases/exhibit-full/exhibit.toml ;;
        timbre) printf '%s\n' audio/timbres/*.toml ;;
        config) printf '%s\n' kiosk-config/kiosk.toml ;;
        script) printf '%s\n' tests/cases/gusts.jsonl tests/long/hard-blows.jsonl ;;
        scene) printf '%s\n' tests/cases/scenes/*.json ;;
    esac
}

# Memory files, where there are any: two of the readers take a file's path.
[ -w /dev/shm ] && export TMPDIR=/dev/shm
# No unsafe code of ours needs the address sanitizer; what an input may take is counted by the allocator (src/lib.rs).
options=(--fuzz-dir tests/fuzz --target-dir "${CARGO_TARGET_DIR:-target}/fuzz" --sanitizer none)
for target in "${targets[@]}"; do
    corpus=out/fuzz/$target
    mkdir -p "$corpus" out/fuzz/found
    for file in $(seeds "$target") tests/fuzz/seeds/"$target"/*; do
        [ ! -f "$file" ] || cp "$file" "$corpus/seed-$(basename "$(dirname "$file")")-$(basename "$file")"
    done
    # The words of good files, so that the fuzzer need not find them letter by letter.
    cat "$corpus"/seed-* | grep -aoE '[A-Za-z_-]{3,}' | sort -u | sed 's/.*/"&"/' >"out/fuzz/$target.dict"
    echo "== $target, $seconds s"
    nice -n 10 cargo +nightly fuzz run "${options[@]}" "$target" "$corpus" -- \
        -artifact_prefix=out/fuzz/found/"$target"- -max_total_time="$seconds" -timeout=60 -rss_limit_mb=2048 \
        -max_len=65536 -dict=out/fuzz/"$target".dict -use_value_profile=1 -print_final_stats=1 -verbosity=0
done
