#!/bin/sh
# RenderMan scenes of a few exhibits, read and drawn by Aqsis:
#     tests/exports/aqsis.sh target/release/soffio AQSIS/bin/aqsis
# Fails where it says anything at all, or leaves no picture.
set -eu
soffio=$(realpath "$1")
aqsis=$(realpath "$2")
root=$(realpath "$(dirname "$0")/../..")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
for exhibit in steel-fish wind-chimes terry-clock marionette wind-chimes-glass; do
    "$soffio" export "$root/exhibits/$exhibit" --rib "$scratch/$exhibit" --seconds 1 --fps 4 --size 320x180 \
        --breath "$root/exhibits/steel-fish/breaths/strong.wav" 2>/dev/null
    cd "$scratch/$exhibit"
    for frame in frame.*.rib; do
        said=$("$aqsis" "$frame" 2>&1)
        [ -z "$said" ] || { echo "$exhibit/$frame: $said" >&2; exit 1; }
        [ -s "${frame%.rib}.tif" ] || { echo "$exhibit/$frame: no picture" >&2; exit 1; }
    done
    echo "$exhibit: $(ls frame.*.tif | wc -l) scenes, drawn"
done
