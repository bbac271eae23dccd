import numpy as np
from pendulum_mujoco import XML, set_pendulum  # noqa: F401


def modify(spec, p):
    set_pendulum(spec, p["J"], p["ml"], p["Fv"])


def start(p):
    return [p["q0"]], [p["w0"]]


def guess(t, q, w):
    return [q[0], w[0]]


def control(recording, t):
    return np.interp(t, recording.take("time"), recording.take("torque"))[:, None]


def observe(s, p, _):
    return [s.q[:, 0], s.v[:, 0]]
