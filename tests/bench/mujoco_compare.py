#!/usr/bin/env python3
"""Soffio beside MuJoCo on the same articulated scenes, in one run, and the table of goals.

    python3 -m venv VENV && VENV/bin/pip install mujoco
    VENV/bin/python tests/bench/mujoco_compare.py target/release/soffio SCENES/*.json

A scene becomes MuJoCo's kinematic tree: ball, hinge and slide joints, gears as joint equalities (stiff: solref 2 dt,
solimp 0.9999). Rounds take turns: MuJoCo's RK4, its Euler, then Soffio, three times over, best of three, each in
processor time of its thread and without measuring inside (one call of mj_step with a number of steps). Motion is
measured apart, from poses and velocities and the scene file's masses.
"""

import argparse
import json
import math
import subprocess
import sys
import time

import mujoco
import numpy as np

ROUNDS = 3
ROUND_TIME = 2.0  # processor time of a round, s
DIVERGED = 10.0  # energy error beyond which a run has diverged
INTEGRATORS = {"rk4": mujoco.mjtIntegrator.mjINT_RK4, "euler": mujoco.mjtIntegrator.mjINT_EULER}
KINDS = {
    "spherical": mujoco.mjtJoint.mjJNT_BALL,
    "hinge": mujoco.mjtJoint.mjJNT_HINGE,
    "slider": mujoco.mjtJoint.mjJNT_SLIDE,
}


def matrices(quats):
    """Rotation matrices of quaternions (x, y, z, w), one a row."""
    x, y, z, w = np.asarray(quats, float).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def turn(matrices, vectors):
    return np.einsum("nij,nj->ni", matrices, vectors)


def quaternion(matrix):
    """(w, x, y, z) of a rotation matrix."""
    out = np.zeros(4)
    mujoco.mju_mat2Quat(out, np.ascontiguousarray(matrix).ravel())
    return out


class Scene:
    def __init__(self, path):
        self.data = json.load(open(path, encoding="utf-8"))
        get = lambda key: np.array([body[key] for body in self.data["bodies"]], float)
        self.name, self.path = self.data["name"], path
        self.n = len(self.data["bodies"])
        self.mass, self.inertia = get("mass"), get("inertia")
        self.pos, self.rot = get("pos"), matrices(get("quat"))
        self.linvel, self.angvel = get("linvel"), get("angvel")
        self.gravity = np.array(self.data["gravity"], float)
        joints = self.data["joints"]
        self.parent = np.array([joint["a"] for joint in joints])
        self.anchor_a = np.array([joint["anchor_a"] for joint in joints], float)
        self.anchor_b = np.array([joint["anchor_b"] for joint in joints], float)
        slides = [joint["type"] == "slider" for joint in joints]
        self.slides = np.flatnonzero(slides)
        self.slide_axis = np.array([joints[i]["axis_a"] for i in self.slides], float).reshape(-1, 3)
        self.start = self.energy(self.pos, self.rot, self.linvel, self.angvel)

    def energy(self, pos, rot, linvel, angvel):
        spin = np.einsum("nji,nj->ni", rot, angvel)
        moving = 0.5 * (self.mass * (linvel**2).sum(1)).sum() + 0.5 * (self.inertia * spin**2).sum()
        return moving - (self.mass * (pos @ self.gravity)).sum()

    def joint_error(self, pos, rot):
        # The world is the last row, so that a parent of -1 finds it.
        pos, rot = np.vstack([pos, np.zeros(3)]), np.concatenate([rot, np.eye(3)[None]])
        a = pos[self.parent] + turn(rot[self.parent], self.anchor_a)
        apart = pos[:-1] + turn(rot[:-1], self.anchor_b) - a
        if len(self.slides):
            axis = turn(rot[self.parent[self.slides]], self.slide_axis)
            apart[self.slides] -= axis * (apart[self.slides] * axis).sum(1)[:, None]
        return np.linalg.norm(apart, axis=1).max()


class Model:
    """A scene in MuJoCo."""

    def __init__(self, scene, dt, integrator):
        self.scene, self.dt = scene, dt
        spec = mujoco.MjSpec()
        spec.option.timestep = dt
        spec.option.gravity = scene.gravity
        spec.option.integrator = INTEGRATORS[integrator]
        spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_AUTORESET
        spec.compiler.balanceinertia = False
        bodies = []
        for i, (body, joint) in enumerate(zip(scene.data["bodies"], scene.data["joints"])):
            a = joint["a"]
            pos, rot = (scene.pos[a], scene.rot[a]) if a >= 0 else (np.zeros(3), np.eye(3))
            node = (bodies[a] if a >= 0 else spec.worldbody).add_body(
                name=f"body{i}",
                pos=rot.T @ (scene.pos[i] - pos),
                quat=quaternion(rot.T @ scene.rot[i]),
                mass=body["mass"],
                inertia=body["inertia"],
                ipos=[0, 0, 0],
                iquat=[1, 0, 0, 0],
                explicitinertial=True,
            )
            axis = joint.get("axis_b", [0, 0, 1])
            node.add_joint(name=f"joint{i}", type=KINDS[joint["type"]], pos=joint["anchor_b"], axis=axis)
            bodies.append(node)
        for coupling in scene.data.get("couplings", []):
            # c1 q1 + c2 q2 = 0, as q1 = -(c2 / c1) q2.
            (first, c1), (second, c2) = coupling["terms"]
            equality = spec.add_equality(
                type=mujoco.mjtEq.mjEQ_JOINT,
                objtype=mujoco.mjtObj.mjOBJ_JOINT,
                name1=f"joint{first}",
                name2=f"joint{second}",
                solref=[2 * dt, 1],
                solimp=[0.9999, 0.9999, 0.001, 0.5, 2],
            )
            equality.data[:5] = [0, -c2 / c1, 0, 0, 0]
        self.model = spec.compile()
        # MuJoCo numbers bodies depth first, scenes in any order that puts parents first.
        self.body = np.array([self.model.body(f"body{i}").id for i in range(scene.n)])
        self.joint = np.array([self.model.joint(f"joint{i}").id for i in range(scene.n)])

    def begin(self):
        scene, data = self.scene, mujoco.MjData(self.model)
        for i, joint in enumerate(scene.data["joints"]):
            a, at = joint["a"], self.model.jnt_dofadr[self.joint[i]]
            spin_a = scene.angvel[a] if a >= 0 else np.zeros(3)
            spin = scene.rot[i].T @ (scene.angvel[i] - spin_a)
            if joint["type"] == "spherical":
                data.qvel[at : at + 3] = spin
            elif joint["type"] == "hinge":
                data.qvel[at] = np.dot(joint["axis_b"], spin)
            else:
                point = scene.pos[i] + scene.rot[i] @ joint["anchor_b"]
                speed = scene.linvel[i] + np.cross(scene.angvel[i], point - scene.pos[i])
                if a >= 0:
                    speed = speed - scene.linvel[a] - np.cross(spin_a, point - scene.pos[a])
                data.qvel[at] = np.dot(scene.rot[i] @ joint["axis_b"], speed)
        return data

    def time(self, steps):
        """Processor time and steps of one round; `steps` None finds how many fit in a round."""
        data = self.begin()
        if steps is not None:
            start = time.thread_time()
            mujoco.mj_step(self.model, data, nstep=steps)
            return time.thread_time() - start, steps
        most = max(1, round(self.scene.data["duration"] / self.dt))
        spent, done, chunk = 0.0, 0, 1
        while spent < ROUND_TIME and done < most:
            chunk = min(chunk, most - done)
            start = time.thread_time()
            mujoco.mj_step(self.model, data, nstep=chunk)
            last = time.thread_time() - start
            spent, done = spent + last, done + chunk
            if last < 0.25 * ROUND_TIME:
                chunk *= 2
        return spent, done

    def states(self, data):
        mujoco.mj_kinematics(self.model, data)
        mujoco.mj_comPos(self.model, data)
        mujoco.mj_comVel(self.model, data)
        pos, rot = data.xpos[self.body], data.xmat[self.body].reshape(-1, 3, 3)
        # Velocities are told at the centre of mass of the whole tree.
        angvel, linvel = data.cvel[self.body, :3], data.cvel[self.body, 3:]
        center = data.subtree_com[self.model.body_rootid[self.body]]
        return pos, rot, linvel + np.cross(angvel, pos - center), angvel

    def watch(self, budget):
        scene, data = self.scene, self.begin()
        row = {"E": 0.0, "J": 0.0, "diverged": None, "sim_s": 0.0}
        pendulum = Pendulum(scene) if "period" in scene.data["meta"] else None
        couplings = scene.data.get("couplings", [])
        address = self.model.jnt_qposadr[self.joint]
        phase = 0.0
        start = time.thread_time()
        for step in range(1, round(scene.data["duration"] / self.dt) + 1):
            mujoco.mj_step(self.model, data)
            pos, rot, linvel, angvel = self.states(data)
            t = step * self.dt
            drift = (scene.energy(pos, rot, linvel, angvel) - scene.start) / scene.data["energy_scale"]
            row["sim_s"] = t
            if not abs(drift) <= DIVERGED:
                row["diverged"] = t
                break
            row["E"] = max(row["E"], abs(drift))
            row["J"] = max(row["J"], scene.joint_error(pos, rot))
            for coupling in couplings:
                phase = max(phase, abs(sum(c * data.qpos[address[j]] for j, c in coupling["terms"])))
            if pendulum:
                pendulum.see(t, pos[0], angvel[0])
            if time.thread_time() - start > budget:
                break
        meta = scene.data["meta"]
        if "accel" in meta and row["diverged"] is None:
            a, body, t = meta["accel"], meta["weight_body"], row["sim_s"]
            row["speed"] = abs(-linvel[body][1] / (a * t) - 1)
            row["drop"] = abs((meta["weight_y0"] - pos[body][1]) / (0.5 * a * t * t) - 1)
            row["phase"] = phase
        if pendulum and pendulum.crossings > 1:
            row["ppm"] = 1e6 * (pendulum.period() / meta["period"] - 1)
        return row


class Pendulum:
    """Mean period by the cubic through angle and rate on both sides of each zero."""

    def __init__(self, scene):
        joint = scene.data["joints"][0]
        self.axis, self.hinge = np.array(joint["axis_a"], float), np.array(joint["anchor_a"], float)
        self.down = scene.gravity / np.linalg.norm(scene.gravity)
        self.crossings, self.first, self.last = 0, 0.0, 0.0
        self.before = self.sample(0.0, scene.pos[0], scene.angvel[0])

    def sample(self, t, pos, angvel):
        r = pos - self.hinge
        return t, math.atan2(self.axis @ np.cross(self.down, r), self.down @ r), self.axis @ angvel

    def see(self, t, pos, angvel):
        (ta, a, va), (tb, b, vb) = self.before, self.sample(t, pos, angvel)
        self.before = (tb, b, vb)
        if (a < 0) == (b < 0):
            return
        h, low, high = tb - ta, 0.0, 1.0
        for _ in range(60):
            s = 0.5 * (low + high)
            r = 1 - s
            value = r * r * (1 + 2 * s) * a + s * s * (3 - 2 * s) * b + s * r * h * (r * va - s * vb)
            low, high = (s, high) if (value < 0) == (a < 0) else (low, s)
        self.last = ta + h * 0.5 * (low + high)
        if self.crossings == 0:
            self.first = self.last
        self.crossings += 1

    def period(self):
        return 2 * (self.last - self.first) / (self.crossings - 1)


def soffio(binary, args):
    out = subprocess.run([binary, "bench", "--json", *args], check=True, capture_output=True, text=True).stdout
    return [json.loads(line) for line in out.splitlines()]


def measure(binary, scene, dt, budget):
    """Ours and MuJoCo's two integrators: {name: row}, rounds taking turns."""
    models = {name: Model(scene, dt, name) for name in INTEGRATORS}
    best, steps, ours = {}, {name: None for name in models}, None
    for turn_ in range(ROUNDS):
        for name, model in models.items():
            spent, steps[name] = model.time(steps[name])
            best[name] = min(best.get(name, math.inf), 1e6 * spent / steps[name])
        # The first turn measures the motion as well; the others measure time alone.
        args = ["--scene", scene.path, "--dt", repr(dt), "--budget", repr(budget if turn_ == 0 else ROUND_TIME)]
        (row,) = soffio(binary, args if turn_ == 0 else [*args, "--seconds", repr(seconds)])
        if turn_ == 0:
            ours, seconds = row, row["timed_steps"] * dt
        ours["us_per_step"] = min(ours["us_per_step"], row["us_per_step"])
    rows = {name: dict(model.watch(budget), us=best[name]) for name, model in models.items()}
    energy = ours["max_energy_drift_rel"]
    rows["soffio"] = {
        "us": ours["us_per_step"],
        "substeps": ours["substeps"],
        "E": math.nan if energy is None else energy,
        "J": math.nan if ours["max_joint_err_m"] is None else ours["max_joint_err_m"],
        "diverged": ours["diverged_at_s"],
        "sim_s": ours["sim_s"],
        "speed": ours.get("s4_speed_rel_err"),
        "drop": ours.get("s4_drop_rel_err"),
        "phase": ours.get("s4_max_coupling_err_m"),
        "ppm": ours.get("s5_period_err_hermite_ppm"),
        "whole_s": round(scene.data["duration"] / dt) * dt * (1 - 1e-9),
        "repeats": ours["repeat_bitwise"],
    }
    return rows


def cell(row):
    energy = f"div {row['diverged']:.2f}s" if row["diverged"] is not None else f"{row['E']:.1e}"
    return f"{row['us']:>12.2f} {energy:>10} {row['J']:>8.1e} {row['sim_s']:>7.2f}"


def print_rows(table):
    head = f"{'us/step':>12} {'E':>10} {'J':>8} {'sim s':>7}"
    print(f"{'scene':<20} {'dt':>8} | soffio{head} | MuJoCo RK4 {head} | RK4/ours | Euler{head} | Euler/ours")
    for (name, dt), rows in table.items():
        own, rk4, euler = rows["soffio"], rows["rk4"], rows["euler"]
        print(
            f"{name:<20} {dt:>8.6f} |       {cell(own)} |            {cell(rk4)} | {rk4['us'] / own['us']:>8.2f} "
            f"|      {cell(euler)} | {euler['us'] / own['us']:.2f}"
        )
        for key, what in [("speed", "speed"), ("drop", "drop"), ("phase", "gears, m"), ("ppm", "period, ppm")]:
            if own.get(key) is not None:
                peers = ", ".join(f"{peer} {rows[peer].get(key, math.nan):.1e}" for peer in ("rk4", "euler"))
                print(f"    {what}: ours {own[key]:.1e}, {peers}")
        if not own["repeats"]:
            print("    our rounds do not agree bit for bit")


def goals(table, linear):
    """Rows (goal, what, ours, wanted, met)."""
    find = lambda name, slow: next((r for (n, dt), r in table.items() if n == name and (dt < 2e-3) == slow), None)

    def need(goal, what, value, most, unit="", row=None):
        """`row` is the run that the value is the largest of: where it stopped early, it can only be met so far."""
        met = "NOT MET" if value is None or not value <= most else "met"
        if met == "met" and row and row["sim_s"] < row["whole_s"]:
            met = f"met in the first {row['sim_s']:.2f} s"
        shown = "none" if value is None else f"{value:.3g}"
        print(f"{goal:<4} {what:<52} {shown:>10}{unit} {most:>10.3g}{unit}  {met}")

    def faster(goal, what, value, least):
        print(f"{goal:<4} {what:<52} {value:>10.3g}x {least:>10.3g}x  {'met' if value >= least else 'NOT MET'}")

    def whole(row):
        return math.inf if row["diverged"] is not None else row["E"]

    print(f"\n{'goal':<4} {'':<52} {'found':>10} {'bar':>11}")
    for n in (15, 63, 255):
        if rows := find(f"S2_mobile_{n}", False):
            own, rk4 = rows["soffio"], rows["rk4"]
            faster("G1", f"mobile {n}: MuJoCo RK4's time over ours", rk4["us"] / own["us"], 6)
            need("G1", f"mobile {n}: energy, MuJoCo RK4's is the bar", whole(own), rk4["E"], row=own)
            need("G1", f"mobile {n}: joints", own["J"], 1e-12, " m", own)
            need("G2", f"mobile {n}: energy", whole(own), 1e-6, row=own)
    for n, least in ((100, 100), (1000, 15_000)):
        if rows := find(f"S1_chain_{n}", False):
            own = rows["soffio"]
            faster("G3", f"chain {n}: MuJoCo RK4's step over our substep", rows["rk4"]["us"] * own["substeps"] / own["us"], least)
            need("G5", f"chain {n}: energy over 10 s", whole(own), 1e-3, row=own)
    for shape in ("chain", "tree"):
        rows = {row["n"]: row for row in linear if row["shape"] == shape}
        for n in (1_000, 10_000):
            for key, what in (("us_per_body_step", "step"), ("us_per_body_factor_solve", "factor and solve")):
                if n in rows:
                    need("G4", f"{shape} {n}: {what} per body over that at 10", rows[n][key] / rows[10][key], 1.25)
        for n in (1_000, 10_000):
            if n in rows:
                need("G4", f"{shape} {n}: factor and solve per body", 1e3 * rows[n]["us_per_body_factor_solve"], 80, " ns")
                need("G4", f"{shape} {n}: step per body", 1e3 * rows[n]["us_per_body_step"], 300, " ns")
    if rows := find("S1_chain_10", False):
        own = rows["soffio"]
        need("G5", "chain 10: energy over 10 s", whole(own), 1e-6, row=own)
        need("G5", "chain 10: joints", own["J"], 1e-12, " m", own)
        if fine := find("S1_chain_10", True):
            ratio = (own["us"] * 240) / (fine["rk4"]["us"] * 1000)
            need("G5", "chain 10: time per simulated s over RK4's at 1/1000", ratio, 1, "x")
    if rows := find("S6_massratio_10000", False):
        own = rows["soffio"]
        need("G6", "mass ratio: energy", whole(own), 1e-8, row=own)
        need("G6", "mass ratio: joints", own["J"], 1e-12, " m", own)
        need("G6", "mass ratio: step", own["us"], 120, " us")
    if rows := find("S4_gears", False):
        own = rows["soffio"]
        need("G8", "gears: speed", own["speed"], 1e-12)
        need("G8", "gears: drop", own["drop"], 1e-12)
        need("G8", "gears: phase", own["phase"], 1e-13, " m")
    if rows := find("S5_pendulum", False):
        own = rows["soffio"]
        need("G9", "pendulum: period, 1e-6", abs(own["ppm"]), 1e-5)
        need("G9", "pendulum: energy", whole(own), 1e-9, row=own)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("soffio", help="the program, a release build")
    parser.add_argument("scenes", nargs="+", help="scenes of the format isaac-bench-scene/1")
    parser.add_argument("--all-steps", action="store_true", help="every step that a scene names, not the first alone")
    parser.add_argument("--budget", type=float, default=10.0, help="processor time of each measuring pass, s")
    parser.add_argument("--linear", action="store_true", help="also what a body costs as figures grow (G4)")
    args = parser.parse_args()
    # A run that diverges is told in the table, not in a log file wherever this was started.
    mujoco.set_mju_user_warning(lambda message: None)
    table = {}
    for path in args.scenes:
        scene = Scene(path)
        # The whip at 1/240 is held against RK4 at 1/1000.
        every = args.all_steps or scene.name == "S1_chain_10"
        for dt in scene.data["dts"][: None if every else 1]:
            table[scene.name, dt] = measure(args.soffio, scene, dt, args.budget)
            print(f"{scene.name} at {dt:.6f} s: done", file=sys.stderr)
    print(f"MuJoCo {mujoco.__version__}")
    print_rows(table)
    goals(table, soffio(args.soffio, ["--linear"]) if args.linear else [])


if __name__ == "__main__":
    main()
