"""Writes robots_golden.json: accelerations of the robots beside it by Pinocchio, at random states.

Usage: python3 make_robots_golden.py       (pip install pin==4.1.0)

Of a free base: the attitude as body-fixed x-y-z angles, and the specific force at the base's origin in its axes.
"""
import json
from pathlib import Path

import numpy as np
import pinocchio as pin

HERE = Path(__file__).resolve().parent
COUNT = 5
ARMATURE = {"shoulder": 0.4, "wrist": 0.002, "rail": 1.5, "left": 0.3}


def rotate(axis, angle):
    return pin.AngleAxis(angle, np.eye(3)[axis]).matrix()


def draw_base(rng, q, v):
    """A free base's coordinates and their rates; sets them in q and v."""
    angles, place, spin, speed = rng.uniform(-1, 1, (4, 3))
    first = rotate(0, angles[0])
    second = first @ rotate(1, angles[1])
    turn = second @ rotate(2, angles[2])
    rates = np.linalg.solve(np.column_stack([np.eye(3)[0], first[:, 1], second[:, 2]]), spin)
    q[:3], q[3:7] = place, pin.Quaternion(turn).coeffs()
    v[:3], v[3:6] = turn.T @ speed, turn.T @ spin
    return [*angles, *place], [*rates, *speed], turn


def draw_state(model, data, free, rng):
    q, v, force = pin.neutral(model), np.zeros(model.nv), np.zeros(model.nv)
    state = {"coordinates": {}, "speeds": {}, "forces": {}, "accelerations": {}}
    if free:
        state["base"], state["base_rates"], turn = draw_base(rng, q, v)
    for joint, name in zip(model.joints, model.names):
        if joint.nv != 1 or joint.idx_v < 0:
            continue
        if "Mimic" in joint.shortname():
            continue
        at, speed, torque = rng.uniform(-1, 1, 3)
        if joint.nq == 2:
            q[joint.idx_q : joint.idx_q + 2] = np.cos(at), np.sin(at)
        else:
            q[joint.idx_q] = at
        v[joint.idx_v], force[joint.idx_v] = speed, torque
        state["coordinates"][name], state["speeds"][name], state["forces"][name] = at, speed, torque
    mass = np.triu(pin.crba(model, data, q))
    mass = mass + np.triu(mass, 1).T
    bias = pin.nle(model, data, q, v)
    for name in state["coordinates"]:
        joint = model.joints[model.getJointId(name)]
        if name in ARMATURE and not free:
            mass[joint.idx_v, joint.idx_v] += ARMATURE[name]
    a = np.linalg.solve(mass, force - bias)
    for name in state["coordinates"]:
        state["accelerations"][name] = a[model.joints[model.getJointId(name)].idx_v]
    if free:
        state["specific_force"] = list(a[:3] + np.cross(v[3:6], v[:3]) - turn.T @ model.gravity.linear)
    return state


def main():
    golden = {"armature": ARMATURE}
    for name, free in (("arm", False), ("walker", True)):
        file = str(HERE / f"{name}.urdf")
        if free:
            model = pin.buildModelFromUrdf(file, pin.JointModelFreeFlyer())
        else:
            model = pin.buildModelFromUrdf(file, True)
        model.gravity.linear = np.array([0, 0, -9.81])
        data = model.createData()
        rng = np.random.default_rng(1)
        golden[name] = [draw_state(model, data, free, rng) for _ in range(COUNT)]
    (HERE / "robots_golden.json").write_text(json.dumps(golden, indent=1) + "\n")


main()
