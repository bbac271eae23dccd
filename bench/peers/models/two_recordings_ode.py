import numpy as np
from signals import chirp

BREAKS = []


def start(p, trial):
    return [1 if trial == "free" else 0, 0]


def derive(t, s, p, trial):
    torque = chirp(t, 1, 0.2, 2, 5) if trial == "driven" else 0
    return [s[1], (torque - p["ml"] * 9.81 * np.sin(s[0]) - p["c"] * s[1] - p["drag"] * s[1] * abs(s[1])) / p["J"]]


def observe(t, s, p):
    return [s[0]]
