#!/usr/bin/env bash
# The live tests in parallel: each part in an environment of its own, whose output is printed when the part ends.
#
#   tests/live/lanes.sh target/ci/soffio [PART …]
#
# SOFFIO_LIVE_LANES=3 sets the number of parallel parts; the default is the number of processors. Parts with short time limits (see
# parts.sh) have priority on the processor. A part that misses a bar in parallel with others is tried once more alone; the missed
# bar is reported all the same.
set -euo pipefail
here=$(dirname "$(readlink -f "$0")")
soffio=$(readlink -f "${1:?usage: tests/live/lanes.sh PATH-OF-SOFFIO [PART …]}")
shift
# shellcheck source-path=SCRIPTDIR
. "$here/parts.sh"
lanes=${SOFFIO_LIVE_LANES:-$(nproc)}

is_patient() { [[ " ${patient_parts[*]} " == *" $1 "* ]]; }

# Runs one part. A part that hangs is ended after ten minutes.
part() {
    local code=0 nice=0
    ! is_patient "$1" || nice=5
    SOFFIO_LIVE_PARTS=$1 nice -n "$nice" timeout --foreground --kill-after=30 600 "$here/run.sh" "$soffio" >"$logs/$1" 2>&1 || code=$?
    # A part that ends early has missed a bar without reporting it.
    if [ "$code" -ne 0 ] && ! grep -q '^live: BAD' "$logs/$1"; then
        printf 'live: BAD   %-24s ended with exit code %s\n' "$1" "$code" >>"$logs/$1"
    fi
    # A part that is tried again has missed nothing yet.
    if [ -n "${SOFFIO_LIVE_AGAIN:-}" ] && grep -q '^live: BAD' "$logs/$1"; then
        touch "$logs/$1.again"
        sed -i 's/^live: BAD  /live: AGAIN/; /^live: good/d' "$logs/$1"
    fi
    flock "$logs" cat "$logs/$1"
}

if [ "${1:-}" = --alone ]; then
    logs=$SOFFIO_LIVE_LOGS
    part "$2"
    exit
fi
logs=$(mktemp -d)
export SOFFIO_LIVE_LOGS=$logs
trap 'rm -rf "$logs"' EXIT
trap 'exit 130' INT TERM

[ $# -gt 0 ] || set -- "${live_parts[@]}"
if [ "$lanes" -gt 1 ] && [ $# -gt 1 ]; then export SOFFIO_LIVE_AGAIN=1; fi
printf '%s\n' "$@" | xargs -P "$lanes" -I{} "$0" "$soffio" --alone {}
unset SOFFIO_LIVE_AGAIN
for part in "$@"; do
    [ ! -e "$logs/$part.again" ] || part "$part"
done
! grep -q '^live: BAD' "$logs"/*
