#!/usr/bin/python3
"""Writes memory_golden.hpp: mechanisms that remember, by scipy's solve_ivp (DOP853, rtol 1e-11, atol 1e-14).

    /usr/bin/python3 tests/framework/models/mechanism/make_memory_golden.py

The equations stand here as they do in the literature; the tests write the same machines as experiments do."""

import pathlib

import numpy
from scipy.integrate import solve_ivp

TIMES = numpy.linspace(0.25, 2.0, 8)


def solve(rate, start, outputs):
    steps = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-14, "max_step": 0.01}
    solution = solve_ivp(rate, (0.0, TIMES[-1]), start, t_eval=TIMES, **steps)
    assert solution.success
    return numpy.array([outputs(t, x) for t, x in zip(TIMES, solution.y.T)]).T


def lugre_rate(v, z, s0, coulomb, level, speed, exponent):
    g = coulomb + (level - coulomb) * numpy.exp(-((abs(v) / speed) ** exponent))
    return v - s0 * abs(v) * z / g


def slide():
    """A slide with LuGre friction and the Stribeck effect."""
    m, s0, s1, viscous = 2.0, 1e4, 50.0, 0.5

    def friction(v, z):
        return s0 * z + s1 * lugre_rate(v, z, s0, 2.0, 3.0, 0.05, 2.0) + viscous * v

    def rate(t, x):
        q, v, z = x
        force = 4.0 * numpy.sin(2.0 * numpy.pi * t)
        return [v, (force - friction(v, z)) / m, lugre_rate(v, z, s0, 2.0, 3.0, 0.05, 2.0)]

    return solve(rate, [0.0, 0.0, 0.0], lambda t, x: [x[0], x[1], x[2]])


def belt():
    """A block on a driven carriage, with LuGre friction between the two (absolute coordinates)."""
    m1, m2, s0, s1 = 3.0, 1.0, 2e3, 10.0

    def rate(t, x):
        q1, v1, q2, v2, z = x
        dz = lugre_rate(v2 - v1, z, s0, 1.5, 1.5, 1.0, 2.0)
        friction = s0 * z + s1 * dz
        drive = 12.0 * numpy.sin(6.0 * t) - 40.0 * q1
        return [v1, (drive + friction) / m1, v2, (-friction - 30.0 * q2) / m2, dz]

    return solve(rate, [0.0, 0.0, 0.0, 0.0, 0.0], lambda t, x: [x[0], x[2], x[4]])


def yielding():
    """A mass on a spring that yields, by Bouc and Wen."""
    m, k, share, xy, a, beta, gamma, n = 1.0, 100.0, 0.1, 0.02, 1.0, 0.6, 0.4, 1.5

    def rate(t, x):
        q, v, z = x
        dz = v / xy * (a - abs(z) ** n * (beta * numpy.sign(v * z) + gamma))
        force = 3.0 * numpy.sin(2.0 * numpy.pi * 0.8 * t)
        return [v, (force - share * k * q - (1.0 - share) * k * xy * z) / m, dz]

    return solve(rate, [0.0, 0.0, 0.0], lambda t, x: [x[0], x[1], x[2]])


def motor():
    """A DC motor with its winding, and its current behind a filter of first order."""
    j, c, k_t, r, inductance, lag = 2e-3, 1e-3, 0.05, 1.2, 3e-3, 0.02

    def rate(t, x):
        angle, speed, i, filtered = x
        u = 6.0 * numpy.sin(9.0 * t)
        return [speed, (k_t * i - c * speed) / j, (u - r * i - k_t * speed) / inductance, (i - filtered) / lag]

    return solve(rate, [0.0, 0.0, 0.0, 0.0], lambda t, x: [x[0], k_t * x[2], x[3]])


def write(name, values):
    rows = ",\n    ".join("{" + ", ".join(f"{value:.15g}" for value in row) + "}" for row in values)
    return f"constexpr double k{name}[{len(values)}][{len(TIMES)}] = {{\n    {rows}}};\n"


def main():
    text = "// Written by make_memory_golden.py: scipy's solve_ivp at the times kTimes.\n#pragma once\n\n"
    text += "namespace twinmap::testing::golden {\n\n"
    text += f"constexpr double kTimes[{len(TIMES)}] = {{{', '.join(f'{t:.15g}' for t in TIMES)}}};\n\n"
    for function in (slide, belt, yielding, motor):
        text += f"/// {function.__doc__}\n" + write(function.__name__.capitalize(), function()) + "\n"
    text += "}  // namespace twinmap::testing::golden\n"
    (pathlib.Path(__file__).parent / "memory_golden.hpp").write_text(text)


if __name__ == "__main__":
    main()
