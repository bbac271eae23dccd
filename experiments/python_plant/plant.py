"""The two connected beams of experiments/two_beam as a Python program: many samples at once, by NumPy.

Reads lines of JSON on its standard input and answers each with a line of JSON (docs/how-to/use-a-program.md).
"""
import json
import sys

import numpy as np

M1, M2, Y_COM, Z_COM, I, G = 3.3, 0.13, 0.034, 0.022, 1.3e-4, 9.81
K_THETA_CENTER = 0.036  # all samples start from the equilibrium of the centre of the box
LARGEST_STEP = 2.5e-3  # s; a fortieth radian of the hinge, so that Runge and Kutta's error is below 1e-6


def find_equilibrium():
    """The angle at which the hinge's spring carries beam 2, by Newton's method."""
    theta = 0.0
    for _ in range(50):
        c, s = np.cos(theta), np.sin(theta)
        residual = K_THETA_CENTER * theta + M2 * G * (Y_COM * c - Z_COM * s)
        theta -= residual / (K_THETA_CENTER - M2 * G * (Y_COM * s + Z_COM * c))
    return theta


def derive(state, p, force, moment):
    """Time derivative of (y, theta, y', theta') for all samples: (4, n)."""
    _, theta, speed, rate = state
    c, s = np.cos(theta), np.sin(theta)
    a, b = Y_COM * s + Z_COM * c, Y_COM * c - Z_COM * s
    m11, m12, m22 = M1 + M2, -M2 * a, I + M2 * (Y_COM**2 + Z_COM**2)
    f1 = force + M2 * b * rate**2 - p["d_y"] * speed - p["k_y"] * state[0]
    f2 = moment - p["d_theta"] * rate - p["k_theta"] * theta - M2 * G * b
    determinant = m11 * m22 - m12 * m12
    return np.stack([speed, rate, (m22 * f1 - m12 * f2) / determinant, (m11 * f2 - m12 * f1) / determinant])


def step(state, p, force, moment, h):
    """One step of the classical method of Runge and Kutta."""
    k1 = derive(state, p, force, moment)
    k2 = derive(state + 0.5 * h * k1, p, force, moment)
    k3 = derive(state + 0.5 * h * k2, p, force, moment)
    k4 = derive(state + h * k3, p, force, moment)
    return state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def advance(state, p, force, moment, begin, end):
    steps = max(1, int(np.ceil((end - begin) / LARGEST_STEP * (1 - 1e-9))))
    for _ in range(steps):
        state = step(state, p, force, moment, (end - begin) / steps)
    return state


def simulate(p, times, excitation):
    """Outputs {name: (times, n)}; the excitation is constant within its pieces, at whose ends steps end."""
    count = len(p["k_y"])
    state = np.zeros((4, count))
    state[1] = find_equilibrium()
    outputs = {"y": np.empty((len(times), count)), "theta": np.empty((len(times), count))}
    now, i = 0.0, 0
    for force, moment in zip(excitation["F"]["pieces"], excitation["M"]["pieces"]):
        end = force[1]
        while i < len(times) and times[i] <= end:
            state = advance(state, p, force[2], moment[2], now, times[i])
            now = times[i]
            outputs["y"][i], outputs["theta"][i] = state[0], state[1]
            i += 1
        if now < end:
            state = advance(state, p, force[2], moment[2], now, end)
            now = end
    return outputs


def main():
    hello = json.loads(sys.stdin.readline())
    print(json.dumps({"twinmap": 1}), flush=True)
    for line in sys.stdin:
        request = json.loads(line)
        samples = request.get("samples", [request])  # several where batch: is given
        p = {name: np.array([s["parameters"][name] for s in samples]) for name in hello["parameters"]}
        outputs = simulate(p, hello["times"], hello["excitation"]["signals"])
        answers = [
            {"outputs": {name: values[:, j].tolist() for name, values in outputs.items()}} for j in range(len(samples))
        ]
        print(json.dumps({"samples": answers} if "samples" in request else answers[0]), flush=True)


main()
