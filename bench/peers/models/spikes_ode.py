from signals import chirp

BREAKS = [4]


def start(p, trial):
    return [0, 0]


def derive(t, s, p, trial):
    return [s[1], (chirp(t, 2, 0.5, 5, 4) - p["k"] * s[0] - p["k3"] * s[0] ** 3 - p["d"] * s[1]) / 1.2]


def observe(t, s, p):
    return [s[0]]
