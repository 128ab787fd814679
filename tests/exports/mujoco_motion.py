#!/usr/bin/env python3
"""Moves exported models in MuJoCo beside the program's own motion, and tells how far the two come apart.

    python3 -m venv VENV && VENV/bin/pip install mujoco
    VENV/bin/python tests/exports/mujoco_motion.py target/release/soffio

All shipped exhibits must load and take 500 steps. The pendulum swings as it is shipped; of a mobile the friction of its
hooks, which MuJoCo's models have no word for, is taken out of a copy, and one leaf is pushed. Both run without wind. The
measure is the largest angle between a body here and there, over the largest angle that any body has turned.
"""

import csv
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import mujoco
import numpy as np

EXHIBITS = pathlib.Path(__file__).resolve().parents[2] / "exhibits"
SECONDS = 4.0
MOST = 0.01
# Exhibit, the body that is pushed, and its spin about its hook (world, rad/s): too gently to touch another.
CASES = [
    ("pendulum", None, None),
    ("steel-fish", "OrangeDisc", [0.0, 0.0, 1.0]),
    ("plates", "LargeDisc", [0.0, 0.0, 0.5]),
    ("twelve-moons", "Moon12", [0.0, 0.0, 0.5]),
]


def run(*args):
    return subprocess.run([str(a) for a in args], check=True, capture_output=True, text=True)


def export(soffio, exhibit, folder):
    out = folder / "model.xml"
    told = run(soffio, "export", exhibit, "--mjcf", out).stderr.splitlines()
    return mujoco.MjModel.from_xml_path(str(out)), [line for line in told if line.startswith("left out")]


def trace(soffio, exhibit, folder):
    out = folder / "trace.csv"
    run(soffio, "play", exhibit, "--no-wind", "--solver", "dynamics", "--seconds", SECONDS, "--trace", out)
    frames = {}
    with open(out, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            q = np.array([float(row[k]) for k in ("qw", "qx", "qy", "qz")])
            frames.setdefault(float(row["t"]), {})[row["body"]] = q
    return frames


def angle(p, q):
    difference = np.zeros(3)
    mujoco.mju_subQuat(difference, p, q)
    return float(np.linalg.norm(difference))


def pushed(soffio, name, body, spin, folder):
    """A copy of the exhibit without friction, in which `body` turns about its joint."""
    copy = folder / name
    shutil.copytree(EXHIBITS / name, copy)
    sidecar = copy / "exhibit.toml"
    text = re.sub(r"(?m)^friction = .*$", "", sidecar.read_text(encoding="utf-8"))
    sidecar.write_text(text, encoding="utf-8")
    model, _ = export(soffio, copy, folder)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    index = model.body(body).id
    arm = data.xipos[index] - data.xanchor[model.body_jntadr[index]]
    speed = ", ".join(f"{v:.17g}" for v in np.cross(spin, arm))
    turn = ", ".join(f"{v:.17g}" for v in spin)
    line = f'node = "{body}"\ninitial = {{ velocity = [{speed}], angular_velocity = [{turn}] }}'
    text, count = re.subn(rf'(?m)(?<=^\[\[body\]\]\n)node = "{re.escape(body)}"$', line, text)
    if count != 1:
        raise SystemExit(f"{name}: {body} stands {count} times in the sidecar")
    sidecar.write_text(text, encoding="utf-8")
    return copy


def compare(soffio, name, body, spin):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        exhibit = pushed(soffio, name, body, spin, folder) if body else EXHIBITS / name
        model, _ = export(soffio, exhibit, folder)
        frames = trace(soffio, exhibit, folder)
        data = mujoco.MjData(model)
        if model.nkey:
            mujoco.mj_resetDataKeyframe(model, data, 0)
        mujoco.mj_forward(model, data)
        start, apart, moved = None, 0.0, 0.0
        for t, poses in frames.items():
            while data.time < t - 0.5 * model.opt.timestep:
                # The last step ends on the frame.
                model.opt.timestep = min(1e-3, t - data.time)
                mujoco.mj_step(model, data)
            model.opt.timestep = 1e-3
            mujoco.mj_kinematics(model, data)
            start = start or poses
            for body_name, q in poses.items():
                apart = max(apart, angle(data.xquat[model.body(body_name).id].copy(), q))
                moved = max(moved, angle(start[body_name], q))
        share = apart / moved if moved else math.nan
        verdict = "good" if share <= MOST else "APART"
        print(f"{name} ({body or 'as shipped'}): {SECONDS} s, turned {moved:.3f} rad, apart {apart:.2e} rad, ", end="")
        print(f"{100 * share:.3f} %: {verdict}")
        return share <= MOST


def loads(soffio, name):
    with tempfile.TemporaryDirectory() as folder:
        model, told = export(soffio, EXHIBITS / name, pathlib.Path(folder))
        data = mujoco.MjData(model)
        mujoco.mj_step(model, data, nstep=500)
        bad = sum(int(warning.number) for warning in data.warning)
        print(f"{name}: {model.nbody - 1} bodies, {model.nv} degrees of freedom, {len(told)} left out, {bad} warnings")
        return bad == 0


def main(soffio):
    names = sorted(folder.name for folder in EXHIBITS.iterdir() if (folder / "exhibit.toml").exists())
    good = [loads(soffio, name) for name in names] + [compare(soffio, *case) for case in CASES]
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
