#!/usr/bin/python3
"""Writes sampled_golden.hpp: a motor under sampled controllers and a filtered sine, by scipy.

    /usr/bin/python3 tests/framework/models/mechanism/make_sampled_golden.py

Between two instants the motor is linear under a constant voltage, so that its state follows by a matrix exponential,
exact to rounding. The filter is scipy.signal's analogue Butterworth, integrated by DOP853 (rtol 1e-12)."""

import pathlib

import numpy
from scipy import signal
from scipy.integrate import solve_ivp
from scipy.linalg import expm

TIMES = numpy.linspace(0.25, 2.0, 8)
R, L, K, J, B = 1.2, 3e-3, 0.05, 2e-3, 1e-3


class Motor:
    """x = [angle, speed, current], moved on under a constant voltage."""

    def __init__(self):
        self.rates = numpy.zeros((4, 4))
        self.rates[0, 1] = 1.0
        self.rates[1, 1:3] = [-B / J, K / J]
        self.rates[2, 1:] = [-K / L, -R / L, 1.0 / L]
        self.t, self.x, self.u = 0.0, numpy.zeros(3), 0.0
        self.past = [(0.0, self.x, 0.0)]

    def at(self, t):
        """The state at a time that it has passed, or goes to."""
        if t <= 0.0:
            return numpy.zeros(3)
        begin, x, u = [entry for entry in self.past if entry[0] <= t + 1e-12][-1]
        return (expm(self.rates * max(t - begin, 0.0)) @ numpy.append(x, u))[:3]

    def advance(self, t, u):
        """To the time t, at which the voltage becomes u."""
        self.x = self.at(t)
        self.t, self.u = t, u
        self.past.append((t, self.x, u))


def run(period, delay, reading, control):
    """The motor at TIMES, with its voltage. `reading(motor, t)`: what the controller reads; `control(q, r)`: its
    output."""
    motor, due, rows, k = Motor(), [], [], 0
    events = sorted(
        [(k * period, 1, k) for k in range(int(2.0 / period) + 1)]
        + [(t, 2, i) for i, t in enumerate(TIMES)]
        + [(k * period + delay, 0, k) for k in range(int(2.0 / period) + 1) if k * period + delay <= 2.0]
    )
    computed = {}
    for t, kind, k in events:
        if kind == 0:
            motor.advance(t, computed[k])
        elif kind == 1:
            computed[k] = control(reading(motor, t), numpy.sin(numpy.pi * t))
        else:
            rows.append([*motor.at(t)[:1], motor.at(t)[2], motor.u])
    return numpy.array(rows).T


class Pid:
    def __init__(self, period, kp, ki, kd):
        self.period, self.kp, self.ki, self.kd = period, kp, ki, kd
        self.integral, self.before = 0.0, None

    def __call__(self, q, r):
        slope = 0.0 if self.before is None else (q - self.before) / self.period
        u = self.kp * (r - q) + self.ki * self.integral - self.kd * slope
        self.integral += self.period * (r - q)
        self.before = q
        return min(max(u, -24.0), 24.0)


def pid():
    """1 kHz, new output 1.5 ms after the reading, its second."""
    return run(1e-3, 1.5e-3, lambda motor, t: motor.at(t)[0], Pid(1e-3, 20.0, 30.0, 0.4))


def encoder():
    """The same at 500 Hz with an encoder of 1 mrad that lags by 0.7 ms."""

    def read(motor, t):
        return numpy.floor(motor.at(t - 0.7e-3)[0] / 1e-3 + 0.5) * 1e-3

    return run(2e-3, 0.4e-3, read, Pid(2e-3, 20.0, 30.0, 0.4))


def butterworth():
    """Of order 3 and cut off at 4 Hz, of sin(2 pi 1.5 t)."""
    a, b, c, d = signal.tf2ss(*signal.butter(3, 2.0 * numpy.pi * 4.0, analog=True))
    assert not d.any()
    solution = solve_ivp(
        lambda t, x: a @ x + b[:, 0] * numpy.sin(3.0 * numpy.pi * t),
        (0.0, TIMES[-1]),
        numpy.zeros(3),
        method="DOP853",
        rtol=1e-12,
        atol=1e-16,
        t_eval=TIMES,
    )
    return c @ solution.y


def write(file, name, rows):
    text = ",\n    ".join("{" + ", ".join(f"{value:.16g}" for value in row) + "}" for row in numpy.atleast_2d(rows))
    file.write(f"constexpr double {name}[{len(numpy.atleast_2d(rows))}][8] = {{\n    {text}}};\n")


def main():
    path = pathlib.Path(__file__).with_name("sampled_golden.hpp")
    with path.open("w") as file:
        file.write("#pragma once\n\n// Written by make_sampled_golden.py.\n\nnamespace twinmap::testing::golden {\n\n")
        file.write("// clang-format off\n")
        write(file, "kPid", pid())
        write(file, "kEncoder", encoder())
        write(file, "kButterworth", butterworth())
        file.write("// clang-format on\n\n}  // namespace twinmap::testing::golden\n")


if __name__ == "__main__":
    main()
