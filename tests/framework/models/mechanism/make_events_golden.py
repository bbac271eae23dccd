#!/usr/bin/python3
"""Writes events_golden.hpp: machines with impacts and dry friction, by scipy's solve_ivp (DOP853, rtol 1e-12,
atol 1e-14) from event to event, each located by its own root search.

    /usr/bin/python3 tests/framework/models/mechanism/make_events_golden.py

The equations stand here as they do in the literature; the tests write the same machines as experiments do."""

import pathlib

import numpy
from scipy.integrate import solve_ivp

TIMES = numpy.linspace(0.25, 2.0, 8)
STEPS = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14, "max_step": 0.01, "dense_output": True}


def solve(modes, mode, start, outputs):
    """modes: by name its rate(t, x) and its events: (function that falls through 0, jump(t, x) -> mode, x)."""
    t, x = 0.0, numpy.array(start, dtype=float)
    kept = []
    while t < TIMES[-1]:
        rate, listed = modes[mode]
        events = []
        for function, _ in listed:
            event = lambda s, y, function=function: function(s, y)
            event.terminal, event.direction = True, -1
            events.append(event)
        solution = solve_ivp(rate, (t, TIMES[-1]), x, events=events, **STEPS)
        assert solution.status >= 0
        end = solution.t[-1]
        kept += [outputs(s, solution.sol(s)) for s in TIMES if t <= s < end or s == end == TIMES[-1]]
        t, x = end, solution.y[:, -1]
        if solution.status == 1:
            which = next(i for i, times in enumerate(solution.t_events) if len(times) > 0)
            mode, x = listed[which][1](t, numpy.array(x))
    return numpy.array(kept).T


def cart():
    """A cart with a pendulum, on a spring, that a wall throws back at x = 0.1."""
    # the wall's impulse acts on the cart alone: the pendulum's own momentum m l (l w + cos(angle) v) stays
    big, m, length, g, k, e, wall = 2.0, 0.7, 0.4, 9.81, 60.0, 0.6, 0.1

    def rate(t, state):
        x, angle, v, w = state
        force = 14.0 * numpy.sin(5.0 * t) - k * x
        matrix = [[big + m, m * length * numpy.cos(angle)], [m * length * numpy.cos(angle), m * length**2]]
        right = [force + m * length * w**2 * numpy.sin(angle), -m * g * length * numpy.sin(angle)]
        return [v, w, *numpy.linalg.solve(matrix, right)]

    def bounce(t, state):
        x, angle, v, w = state
        return "free", numpy.array([x, angle, -e * v, w + numpy.cos(angle) * (1.0 + e) * v / length])

    modes = {"free": (rate, [(lambda t, s: max(wall - s[0], -s[2]), bounce)])}
    return solve(modes, "free", [0.0, 0.3, 0.0, 0.0], lambda t, s: [s[0], s[1], s[2], s[3]])


def belt():
    """A block on a belt of 0.2 m/s, held by a spring, with the Stribeck effect."""
    m, k, viscous, coulomb, level, speed, belt_speed = 1.5, 80.0, 0.4, 2.0, 3.5, 0.05, 0.2

    def sliding(side):
        def rate(t, x):
            v = x[1] - belt_speed
            friction = side * (coulomb + (level - coulomb) * numpy.exp(-((abs(v) / speed) ** 2))) + viscous * v
            return [x[1], (-k * x[0] - friction) / m]

        def stop(t, x):
            x[1] = belt_speed
            return ("stuck", x) if abs(k * x[0]) <= level else ("slides back", x)

        return rate, [(lambda t, x: side * (x[1] - belt_speed), stop)]

    def slip(t, x):
        return "slides back", x

    stuck = (lambda t, x: [belt_speed, 0.0], [(lambda t, x: level - k * x[0], slip)])
    modes = {"slides on": sliding(1.0), "slides back": sliding(-1.0), "stuck": stuck}
    return solve(modes, "slides back", [0.0, 0.0], lambda t, x: [x[0], x[1]])


def carried():
    """A block that lies on a driven carriage, with dry friction between them: both in absolute coordinates."""
    m1, m2, k, level = 3.0, 1.0, 40.0, 4.0

    def drive(t, x):
        return 30.0 * numpy.sin(6.0 * t) - k * x[0]

    def sliding(side):  # the block goes faster than the carriage: side 1
        def rate(t, x):
            return [x[1], (drive(t, x) + side * level) / m1, x[3], -side * level / m2]

        def meet(t, x):
            x[3] = x[1]
            needed = m2 * drive(t, x) / (m1 + m2)
            return ("stuck", x) if abs(needed) <= level else ("behind" if needed > 0.0 else "ahead", x)

        return rate, [(lambda t, x: side * (x[3] - x[1]), meet)]

    def together(t, x):
        acceleration = drive(t, x) / (m1 + m2)
        return [x[1], acceleration, x[3], acceleration]

    def slip(t, x):
        return ("behind" if drive(t, x) > 0.0 else "ahead"), x

    stuck = (together, [(lambda t, x: level - abs(m2 * drive(t, x) / (m1 + m2)), slip)])
    modes = {"ahead": sliding(1.0), "behind": sliding(-1.0), "stuck": stuck}
    return solve(modes, "stuck", [0.0, 0.0, 0.0, 0.0], lambda t, x: [x[0], x[2], x[3]])


def table():
    """A block on a table that moves as 0.1 sin(2 pi t), relative to it: it slides where 6.5 N do not hold it."""
    m, level = 2.0, 6.5

    def pull(t):
        return m * 0.1 * (2.0 * numpy.pi) ** 2 * numpy.sin(2.0 * numpy.pi * t)

    def sliding(side):
        def meet(t, x):
            x[1] = 0.0
            return ("stuck", x) if abs(pull(t)) <= level else ("ahead" if pull(t) > 0.0 else "behind", x)

        return (lambda t, x: [x[1], (pull(t) - side * level) / m]), [(lambda t, x: side * x[1], meet)]

    def slip(t, x):
        return ("ahead" if pull(t) > 0.0 else "behind"), x

    def show(t, x):  # the force of friction on the block
        held = -pull(t) if abs(pull(t)) <= level else -numpy.sign(pull(t)) * level
        return [x[0], x[1], held if abs(x[1]) < 1e-9 else -numpy.sign(x[1]) * level]

    stuck = (lambda t, x: [0.0, 0.0], [(lambda t, x: level - abs(pull(t)), slip)])
    modes = {"ahead": sliding(1.0), "behind": sliding(-1.0), "stuck": stuck}
    return solve(modes, "stuck", [0.0, 0.0], show)


def write(name, values):
    rows = ",\n    ".join("{" + ", ".join(f"{value:.15g}" for value in row) + "}" for row in values)
    return f"constexpr double k{name}[{len(values)}][{len(TIMES)}] = {{\n    {rows}}};"


def main():
    times = ", ".join(f"{t:.15g}" for t in TIMES)
    parts = [
        "// Written by make_events_golden.py: scipy's solve_ivp at the times kEventTimes.",
        "#pragma once\n",
        "namespace twinmap::testing::golden {\n",
        f"constexpr double kEventTimes[{len(TIMES)}] = {{{times}}};\n",
    ]
    for name, machine in (("CartAtWall", cart), ("DryBelt", belt), ("Carried", carried), ("OnTable", table)):
        summary = machine.__doc__.splitlines()[0]
        parts.append(f"/// {summary}\n{write(name, machine())}\n")
    parts.append("}  // namespace twinmap::testing::golden")
    target = pathlib.Path(__file__).with_name("events_golden.hpp")
    target.write_text("\n".join(parts) + "\n")


if __name__ == "__main__":
    main()
