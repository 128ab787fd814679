#!/usr/bin/env python3
"""Plays an exported model in Blender and compares the poses of its bodies with the trace of the same run.

    python3 -m venv VENV && VENV/bin/pip install bpy
    soffio export steel-fish --gltf fish.glb --breath blow.wav --seconds 6
    soffio play   steel-fish --trace fish.csv --breath blow.wav --seconds 6
    VENV/bin/python tests/exports/blender_poses.py fish.glb fish.csv

Ends with 1 where an origin is farther than 0.1 mm from the trace, or turned otherwise by more than a milliradian: 0.1 mm at 0.1 m.
"""

import csv
import math
import sys

import bpy
from mathutils import Matrix, Quaternion, Vector

PLACE = 1e-4  # m
TURN = 1e-3  # rad
# glTF's y is up, Blender's z.
UP = Matrix.Rotation(math.pi / 2, 4, "X")


def main(model, trace):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=model)
    scene = bpy.context.scene
    fps = scene.render.fps / scene.render.fps_base
    frames = {}
    with open(trace, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            frames.setdefault(float(row["t"]), []).append(row)
    place, turn, moved = 0.0, 0.0, 0.0
    start = {}
    for t, rows in frames.items():
        frame = t * fps
        scene.frame_set(int(frame), subframe=frame - int(frame))
        for row in rows:
            seen = UP.inverted() @ bpy.data.objects[row["body"]].matrix_world @ UP
            at = Vector(float(row[k]) for k in "xyz")
            rotation = Quaternion([float(row[k]) for k in ("qw", "qx", "qy", "qz")])
            place = max(place, (seen.translation - at).length)
            apart = seen.to_quaternion().inverted() @ rotation
            turn = max(turn, 2 * math.asin(min(1.0, Vector((apart.x, apart.y, apart.z)).length)))
            first = start.setdefault(row["body"], (at, rotation))
            moved = max(moved, (at - first[0]).length, (first[1].inverted() @ rotation).angle)
    print(f"{model}: {len(frames)} frames, {len(start)} bodies, moved up to {moved:.3f} (m or rad): ", end="")
    print(f"places within {place:.2e} m, turns within {turn:.2e} rad")
    return 0 if place <= PLACE and turn <= TURN else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
