#!/usr/bin/env bash
# Stands where cargo calls rustc for the crates of this workspace (RUSTC_WORKSPACE_WRAPPER, set by tests/check.sh): compiles a
# crate, then lets clippy look at it and rustdoc at what it says of itself. A warning of either is an error.
#
# `cargo clippy` and `cargo doc` find the same. But they read all packages of others once more, for which they take three times as
# long as for our own crates; here the crates that rustc has just been given are at hand.
#
#   tests/compile.sh RUSTC ARGUMENTS …
set -euo pipefail
rustc=$1
shift
"$rustc" "$@"
# What writes nothing compiles nothing: cargo asks what the compiler can do.
[[ " $* " == *" --out-dir "* ]] || exit 0

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
# Of the arguments, those that say what the crate is, and those that say how code is made of it. Cargo takes a finished file that
# is told to it for one of rustc's.
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
