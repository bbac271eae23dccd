import numpy as np
from pendulum_mujoco import XML, set_pendulum  # noqa: F401


def modify(spec, p):
    set_pendulum(spec, 1, max(-p["c1"] / 9.81, 1e-9), -p["c3"])  # a body of no mass is refused
    spec.actuator("T").gear[0] = p["c2"]


def start(p):
    return [p["angle_0"]], [p["rate_0"]]


def guess(t, angle):
    return [angle[0], (angle[1] - angle[0]) / (t[1] - t[0])]


def control(recording, t):
    """The motor's command, held."""
    u = recording.take("u_pct")[np.searchsorted(recording.take("tempo_ms [ms]"), t, side="right") - 1]
    return (u * np.abs(u))[:, None]


def observe(s, p, _):
    return [s.q[:, 0]]
