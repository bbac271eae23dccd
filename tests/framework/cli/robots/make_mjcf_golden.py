"""Writes mjcf_golden.json: what MuJoCo compiles of finger.xml, and its accelerations at random states.

Usage: python3 make_mjcf_golden.py       (pip install mujoco==4.0.0 numpy)

Conditions that MuJoCo softens (friction, limits, contacts) are off. Of the free body: its attitude as body-fixed x-y-z
angles, and the specific force at its origin in its axes.
"""
import json
import subprocess
import sys
from pathlib import Path

import mujoco
import numpy as np

HERE = Path(__file__).resolve().parent
COMPILER = HERE.parents[3] / "framework/robots/mjcf/compile_mjcf.py"
FILE = str(HERE / "finger.xml")
JOINTS = ("rail", "swivel", "bend")


def turn(axis, angle):
    quaternion, matrix = np.zeros(4), np.zeros(9)
    mujoco.mju_axisAngle2Quat(quaternion, np.eye(3)[axis], angle)
    mujoco.mju_quat2Mat(matrix, quaternion)
    return quaternion, matrix.reshape(3, 3)


def set_flight(model, data, rng):
    """Draws the free body's coordinates and their rates."""
    q, v = model.joint("flight").qposadr[0], model.joint("flight").dofadr[0]
    angles = rng.uniform(-1, 1, 3)
    first, by_x = turn(0, angles[0])
    second, by_y = turn(1, angles[1])
    third, by_z = turn(2, angles[2])
    both, all_three = np.zeros(4), np.zeros(4)
    mujoco.mju_mulQuat(both, first, second)
    mujoco.mju_mulQuat(all_three, both, third)
    data.qpos[q : q + 3], data.qpos[q + 3 : q + 7] = rng.uniform(-1, 1, 3), all_three
    spin = by_x @ by_y @ by_z @ data.qvel[v + 3 : v + 6]
    rates = np.linalg.solve(np.column_stack([np.eye(3)[0], by_x[:, 1], (by_x @ by_y)[:, 2]]), spin)
    return [*angles, *data.qpos[q : q + 3]], [*rates, *data.qvel[v : v + 3]]


def draw_state(model, rng):
    data = mujoco.MjData(model)
    data.qvel[:] = rng.uniform(-1, 1, model.nv)
    for name in JOINTS:
        data.qpos[model.joint(name).qposadr[0]] = rng.uniform(-1, 1)
    data.ctrl[:] = rng.uniform(-2, 2, model.nu)
    base, base_rates = set_flight(model, data, rng)
    mujoco.mj_forward(model, data)
    get = lambda values, key: {name: float(values[getattr(model.joint(name), key)[0]]) for name in JOINTS}
    v = model.joint("flight").dofadr[0]
    axes = data.xmat[model.body("ball").id].reshape(3, 3)
    return {
        "coordinates": get(data.qpos, "qposadr"),
        "speeds": get(data.qvel, "dofadr"),
        "accelerations": get(data.qacc, "dofadr"),
        "controls": {"push": float(data.ctrl[0]), "servo": float(data.ctrl[1])},
        "base": list(map(float, base)),
        "base_rates": list(map(float, base_rates)),
        "specific_force": (axes.T @ (data.qacc[v : v + 3] - model.opt.gravity)).tolist(),
    }


def main():
    answer = subprocess.run(
        [sys.executable, str(COMPILER)],
        input=json.dumps({"file": FILE}) + "\n",
        capture_output=True,
        text=True,
        check=True,
    )
    model = mujoco.MjModel.from_xml_path(FILE)
    for off in ("CONTACT", "LIMIT", "FRICTIONLOSS", "EQUALITY"):
        model.opt.disableflags |= int(getattr(mujoco.mjtDisableBit, f"mjDSBL_{off}"))
    rng = np.random.default_rng(1)
    golden = {"compiled": json.loads(answer.stdout), "states": [draw_state(model, rng) for _ in range(5)]}
    (HERE / "mjcf_golden.json").write_text(json.dumps(golden, indent=1) + "\n")


main()
