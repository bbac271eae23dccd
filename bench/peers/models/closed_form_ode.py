import numpy as np

BREAKS = []


def start(p, trial):
    return [0, 0]


def derive(t, s, p, trial):
    return [s[1], p["a"] + p["b"] * np.sin(np.pi * t)]


def observe(t, s, p):
    return [s[0]]
