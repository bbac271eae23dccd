import numpy as np

KP, KD, KI, KC, KN, MOST, L = 6e4, 2500, 8e4, 8, 40, 60, 4e-3
BREAKS = []


def start(p, trial):
    return [0] * 4


def calc_voltage(t, s):
    q, v, i, integral = s
    e = 0.06 * np.sin(np.pi * t) + 0.02 * np.sin(2 * np.pi * 1.7 * t + 1) - q
    return e, np.clip(KC * ((KP * e + KI * integral - KD * v) / KN - i), -MOST, MOST)


def derive(t, s, p, trial):
    q, v, i, integral = s
    e, u = calc_voltage(t, s)
    force = p["k_f"] * i - p["Fc"] * np.tanh(v / 2e-3) - p["Fv"] * v
    return [v, force / p["M"], (u - p["R"] * i - p["k_f"] * v) / L, e]


def observe(t, s, p):
    return [s[0], s[2], calc_voltage(t, s)[1]]
