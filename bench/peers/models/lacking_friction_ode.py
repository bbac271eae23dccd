import numpy as np
from signals import chirp

BREAKS = []


def start(p, trial):
    return [0, 0]


def derive(t, s, p, trial):
    torque = chirp(t, 1, 0.2, 2, 8) - p["ml"] * 9.81 * np.sin(s[0]) - p["c"] * s[1]
    return [s[1], torque / p["J"]]


def observe(t, s, p):
    return [s[0]]
