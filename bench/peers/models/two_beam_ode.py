import numpy as np
from scipy.optimize import brentq

M1, M2, Y, Z, I, G = 3.3, 0.13, 0.034, 0.022, 1.3e-4, 9.81
BREAKS = [0.2, 0.25]
# at rest in the equilibrium of the middle of the bounds
THETA = brentq(lambda q: 0.036 * q + M2 * G * (Y * np.cos(q) - Z * np.sin(q)), -2, 2)


def start(p, trial):
    return [0, THETA, 0, 0]


def derive(t, s, p, trial):
    y, q, vy, vq = s
    pulse = 0.2 <= t < 0.25
    a, b = Y * np.sin(q) + Z * np.cos(q), Y * np.cos(q) - Z * np.sin(q)
    mass = [[M1 + M2, -M2 * a], [-M2 * a, I + M2 * (Y**2 + Z**2)]]
    force = [
        5 * pulse + M2 * b * vq**2 - p["d_y"] * vy - p["k_y"] * y,
        0.075 * pulse - p["d_theta"] * vq - p["k_theta"] * q - M2 * G * b,
    ]
    return [vy, vq, *np.linalg.solve(mass, force)]


def observe(t, s, p):
    return [s[0], s[1]]
