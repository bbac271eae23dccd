import numpy as np

L2, M, M1, G = 0.25, 2, 0.5, 9.81
BREAKS = [0.1, 0.3]


def start(p, trial):
    return [0] * 6


def derive(t, s, p, trial):
    x, a1, a2, vx, w1, w2 = s
    m2, l1 = p["m2"], p["L1"]
    q1, q2, r1, r2 = a1, a1 + a2, w1, w1 + w2
    first, second = (M1 / 2 + m2) * l1, m2 * L2 / 2
    coupled = m2 * l1 * L2 / 2
    mass = np.array(
        [
            [M + M1 + m2, first * np.cos(q1), second * np.cos(q2)],
            [first * np.cos(q1), (M1 / 3 + m2) * l1**2, coupled * np.cos(q1 - q2)],
            [second * np.cos(q2), coupled * np.cos(q1 - q2), m2 * L2**2 / 3],
        ]
    )
    push = 10 if 0.1 <= t < 0.3 else 0
    lower = -0.004 * w2
    force = [
        push - p["k"] * x - p["d"] * vx + first * np.sin(q1) * r1**2 + second * np.sin(q2) * r2**2,
        -first * G * np.sin(q1) - coupled * np.sin(q1 - q2) * r2**2 - p["c1"] * w1 - lower,
        -second * G * np.sin(q2) + coupled * np.sin(q1 - q2) * r1**2 + lower,
    ]
    ax, b1, b2 = np.linalg.solve(mass, force)
    return [vx, w1, w2, ax, b1, b2 - b1]


def observe(t, s, p):
    return [s[0], s[1], s[0] + p["L1"] * np.sin(s[1]) + L2 * np.sin(s[1] + s[2])]
