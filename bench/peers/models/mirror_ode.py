BREAKS = [0.05, 0.2]


def start(p, trial):
    return [0, 0]


def derive(t, s, p, trial):
    torque = (1 if 0.05 <= t < 0.2 else 0) - p["kt"] * s[0] - p["d"] * s[1]
    return [s[1], torque / (0.01 + 1.5 * p["e"] ** 2)]


def observe(t, s, p):
    return [s[0]]
