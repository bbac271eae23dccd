#!/usr/bin/python3
"""Writes loop_golden.hpp: machines with closed loops in minimal coordinates, by scipy's solve_ivp (DOP853, rtol
1e-11, atol 1e-14).

    /usr/bin/python3 tests/framework/models/mechanism/make_loop_golden.py

One angle moves all: what depends on it is in closed form, with its first and second derivative, so that virtual
power gives the equation of motion. The tests write the same machines as trees of bodies with constraints."""

import pathlib

import numpy
from scipy.integrate import solve_ivp

TIMES = numpy.linspace(0.25, 2.0, 8)
GRAVITY = numpy.array([0.0, -9.81])


def rotate(angle, point):
    c, s = numpy.cos(angle), numpy.sin(angle)
    return numpy.array([c * point[0] - s * point[1], s * point[0] + c * point[1]])


def cross(point):
    """z cross point"""
    return numpy.array([-point[1], point[0]])


class Body:
    """A point path p(a) and an angle t(a), each with two derivatives, of a body's centre of mass."""

    def __init__(self, mass, inertia, place, angle):
        self.mass, self.inertia, self.place, self.angle = mass, inertia, place, angle


def carry(origin, angle, point):
    """The path of a body's point from those of its origin and angle (value, first, second)."""
    arm = rotate(angle[0], point)
    turn = cross(arm)
    return (
        origin[0] + arm,
        origin[1] + angle[1] * turn,
        origin[2] + angle[2] * turn - angle[1] ** 2 * arm,
    )


def calc_acceleration(bodies, rate, force):
    """a'' by virtual power; `force`: generalized, of what is not weight."""
    inertia = sum(b.mass * b.place[1] @ b.place[1] + b.inertia * b.angle[1] ** 2 for b in bodies)
    bias = sum(b.mass * b.place[1] @ b.place[2] + b.inertia * b.angle[1] * b.angle[2] for b in bodies)
    weight = sum(b.mass * GRAVITY @ b.place[1] for b in bodies)
    return (weight + force - bias * rate**2) / inertia


FIXED = (numpy.zeros(2), numpy.zeros(2), numpy.zeros(2))


def close_four_bar(a, r=0.1, l=0.3, s=0.2, d=0.25):
    """Angles of coupler and rocker, each against ground, with derivatives: crank r, coupler l, rocker s, base d."""
    end = rotate(a, (r, 0.0))
    base = numpy.array([d, 0.0])
    gap = base - end
    distance = numpy.hypot(*gap)
    inner = numpy.arccos((l * l + distance**2 - s * s) / (2.0 * l * distance))
    coupler = numpy.arctan2(gap[1], gap[0]) + inner
    joint = end + rotate(coupler, (l, 0.0))
    rocker = numpy.arctan2(*(joint - base)[::-1])
    u, v = rotate(coupler, (l, 0.0)), rotate(rocker, (s, 0.0))
    matrix = numpy.column_stack([cross(u), -cross(v)])
    first = numpy.linalg.solve(matrix, -cross(end))
    second = numpy.linalg.solve(matrix, end + first[0] ** 2 * u - first[1] ** 2 * v)
    return (coupler, first[0], second[0]), (rocker, first[1], second[1])


def list_four_bar(a):
    coupler, rocker = close_four_bar(a)
    crank = (a, 1.0, 0.0)
    end = carry(FIXED, crank, (0.1, 0.0))
    base = (numpy.array([0.25, 0.0]), numpy.zeros(2), numpy.zeros(2))
    return [
        Body(0.2, 1e-4, carry(FIXED, crank, (0.05, 0.0)), crank),
        Body(0.3, 2e-3, carry(end, coupler, (0.15, 0.0)), coupler),
        Body(0.25, 1e-3, carry(base, rocker, (0.1, 0.01)), rocker),
    ]


def four_bar():
    """A four-bar, released: angles of crank, coupler on the crank, and rocker."""
    damping = 2e-3

    def rate(t, x):
        return [x[1], calc_acceleration(list_four_bar(x[0]), x[1], -damping * x[1])]

    def outputs(t, x):
        coupler, rocker = close_four_bar(x[0])
        return [x[0], coupler[0] - x[0], rocker[0]]

    return solve(rate, [1.0, 3.0], outputs)


def calc_four_bar_rest():
    """Equilibrium angle and frequency (Hz) of the four-bar with a spring of 3 N m/rad on the crank, at rest at 1."""

    def moment(a):
        bodies = list_four_bar(a)
        return sum(b.mass * GRAVITY @ b.place[1] for b in bodies) - 3.0 * (a - 1.0)

    low, high = 0.5, 1.2
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if moment(low) * moment(middle) > 0.0 else (low, middle)
    bodies = list_four_bar(low)
    inertia = sum(b.mass * b.place[1] @ b.place[1] + b.inertia * b.angle[1] ** 2 for b in bodies)
    stiffness = 3.0 - sum(b.mass * GRAVITY @ b.place[2] for b in bodies)
    return low, numpy.sqrt(stiffness / inertia) / (2.0 * numpy.pi)


def slider_crank():
    """A slider-crank, driven: angle of the crank, angle of the rod on it, travel of the piston."""
    r, l = 0.08, 0.22

    def list_bodies(a):
        crank = (a, 1.0, 0.0)
        end = carry(FIXED, crank, (r, 0.0))
        q = numpy.arcsin(-r * numpy.sin(a) / l)
        first = -r * numpy.cos(a) / (l * numpy.cos(q))
        second = (r * numpy.sin(a) / l + numpy.sin(q) * first**2) / numpy.cos(q)
        rod = (q, first, second)
        pin = carry(end, rod, (l, 0.0))
        bodies = [
            Body(0.5, 4e-4, carry(FIXED, crank, (0.02, 0.0)), crank),
            Body(0.4, 2e-3, carry(end, rod, (0.1, 0.0)), rod),
            Body(0.6, 0.0, pin, (0.0, 0.0, 0.0)),
        ]
        return bodies, rod, pin

    def rate(t, x):
        bodies, _, pin = list_bodies(x[0])
        drive = 0.6 * numpy.sin(7.0 * t) - 0.01 * x[1]
        spring = -150.0 * (pin[0][0] - 0.2) * pin[1][0]
        return [x[1], calc_acceleration(bodies, x[1], drive + spring)]

    def outputs(t, x):
        _, rod, pin = list_bodies(x[0])
        return [x[0], rod[0] - x[0], pin[0][0]]

    return solve(rate, [0.4, 8.0], outputs)


def solve(rate, start, outputs):
    steps = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-14, "max_step": 0.005}
    solution = solve_ivp(rate, (0.0, TIMES[-1]), start, t_eval=TIMES, **steps)
    assert solution.success
    return numpy.array([outputs(t, x) for t, x in zip(TIMES, solution.y.T)]).T


def write(name, values):
    rows = ",\n    ".join("{" + ", ".join(f"{value:.15g}" for value in row) + "}" for row in values)
    return f"constexpr double k{name}[{len(values)}][{len(TIMES)}] = {{\n    {rows}}};\n"


def main():
    text = "// Written by make_loop_golden.py: scipy's solve_ivp at the times kLoopTimes.\n#pragma once\n\n"
    text += "namespace twinmap::testing::golden {\n\n"
    text += f"constexpr double kLoopTimes[{len(TIMES)}] = {{{', '.join(f'{t:.15g}' for t in TIMES)}}};\n\n"
    for name, function in (("FourBar", four_bar), ("SliderCrank", slider_crank)):
        text += f"/// {function.__doc__}\n" + write(name, function()) + "\n"
    angle, frequency = calc_four_bar_rest()
    text += f"/// {calc_four_bar_rest.__doc__}\n"
    text += f"constexpr double kFourBarRest = {angle:.15g}, kFourBarFrequency = {frequency:.15g};\n\n"
    text += "}  // namespace twinmap::testing::golden\n"
    (pathlib.Path(__file__).parent / "loop_golden.hpp").write_text(text)


if __name__ == "__main__":
    main()
