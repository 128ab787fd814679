#!/usr/bin/env bash
# A wrapper around rustc for the crates of this workspace (RUSTC_WORKSPACE_WRAPPER, set by tests/check.sh). It compiles a crate, then
# runs clippy and rustdoc on it. A warning of either is an error.
#
# `cargo clippy` and `cargo doc` find the same, but they read all dependencies again, which takes three times as long as our own
# crates do. Here the dependencies are already compiled.
#
#   tests/compile.sh RUSTC ARGUMENTS …
set -euo pipefail
rustc=$1
shift
"$rustc" "$@"
# A call without output compiles nothing: cargo queries the compiler.
[[ " $* " == *" --out-dir "* ]] || exit 0

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
# Split the arguments into those that describe the crate and those for code generation. Messages about artifacts are left out, since
# cargo would take them for rustc's own.
is=() made=() library=
while [ $# -gt 0 ]; do
    case $1 in
        --out-dir) shift ;;
        --emit=*) ;;
        --json=*) is+=("${1//artifacts,/}") ;;
        -C) made+=("$1" "$2") && shift ;;
        -C*) made+=("$1") ;;
        --crate-type) [ "$2" != lib ] || library=1; is+=("$1" "$2") && shift ;;
        *) is+=("$1") ;;
    esac
    shift
done
clippy-driver "$rustc" "${is[@]}" "${made[@]}" --emit=metadata --out-dir "$scratch" -D warnings
if [ -n "$library" ]; then
    rustdoc "${is[@]}" --document-private-items -D warnings -o "$scratch"
fi
