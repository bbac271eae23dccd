import numpy as np

BREAKS = []


def start(p, trial):
    return [0, 0, 0]


def derive(t, s, p, trial):
    q, v, z = s
    level = p["Fc"] + (p["Fs"] - p["Fc"]) * np.exp(-((v / 0.03) ** 2))
    slip = v - 2e4 * abs(v) * z / level
    return [v, (p["k"] * (0.08 * t - q) - 2e4 * z - 60 * slip - p["d"] * v) / 1.5, slip]


def observe(t, s, p):
    return [s[0], p["k"] * (0.08 * t - s[0])]
