"""Magnetic levitation in segments: how many intervals hold, and how far the errors are above the limit.

    bench/segments.py TWINMAP                   # 100 records of 2 s: coverage, errors and sds over the limit
    bench/segments.py TWINMAP --length 0.05     # shorter segments
    bench/segments.py --record FILE             # only writes the record of experiments/mechanisms/magnetic_levitation.csv

Each record is of a ball with its own parameters, held by a sampled controller (position, filtered speed, integral) that the
experiment file does not have. The limit is the Fisher information with free initial states of all segments, by differences
of the motion computed here.
"""
import argparse
import json
import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np

EXPERIMENT = Path(__file__).parent.parent / "experiments/mechanisms/magnetic_levitation.yaml"
NAMES, LOWER, UPPER = ("c", "g0", "d"), np.array([1.2e-5, 1.1e-3, 0.05]), np.array([1.8e-5, 1.9e-3, 0.35])
MASS, GRAVITY, STEP, NOISE, SUBSTEPS, SAMPLES = 0.05, 9.81, 1e-3, 5e-6, 4, 2000


def move(gap, speed, current, parameters):
    """A sample on, by Runge and Kutta's method, the current held."""
    c, g0, d = parameters
    h = STEP / SUBSTEPS

    def rate(x, v):
        return v, GRAVITY - (c * (current / (x + g0)) ** 2 + d * v) / MASS

    for _ in range(SUBSTEPS):
        k1 = rate(gap, speed)
        k2 = rate(gap + h / 2 * k1[0], speed + h / 2 * k1[1])
        k3 = rate(gap + h / 2 * k2[0], speed + h / 2 * k2[1])
        k4 = rate(gap + h * k3[0], speed + h * k3[1])
        gap, speed = (y + h / 6 * (a + 2 * b + 2 * e + f) for y, a, b, e, f in zip((gap, speed), k1, k2, k3, k4))
    return gap, speed


def hold(parameters, random):
    """Times, measured gaps, currents, true gaps and speeds (samples x records) of balls that are held."""
    c, g0, _ = parameters
    times = np.arange(SAMPLES) * STEP
    waves = ((0.5, 1.3, 0), (0.3, 4.1, 1), (0.2, 9.7, 2))
    wanted = 4e-3 + 0.5e-3 * sum(a * np.sin(2 * np.pi * f * times + p) for a, f, p in waves)
    gap, speed = np.full(c.size, 4e-3), np.zeros(c.size)
    rest, last, filtered, integral = np.sqrt(MASS * GRAVITY / c) * (4e-3 + g0), None, 0.0, 0.0
    rows = []
    for target in wanted:
        measured = gap + NOISE * random.standard_normal(c.size)
        filtered = 0.5 * filtered + (0.5 * (measured - last) / STEP if last is not None else 0.0)
        integral = integral + STEP * (measured - target)
        current = rest + 400 * (measured - target) + 8 * filtered + 1500 * integral
        rows.append((measured, current, gap, speed))
        last = measured
        gap, speed = move(gap, speed, current, parameters)
    return times, *(np.array(column) for column in zip(*rows))


def limit(parameters, current, gap, speed, length):
    """Standard deviations that the measured gaps allow where each segment's start is free."""
    samples = round(length / STEP)
    starts = np.arange(SAMPLES // samples) * samples

    def run(change):
        point = np.concatenate([parameters, [0, 0]]) + change
        x, v, rows = gap[starts] + point[3], speed[starts] + point[4], []
        for k in range(samples):
            rows.append(x)
            x, v = move(x, v, current[starts + k], point[:3])
        return np.array(rows) / NOISE

    steps = np.array([1e-10, 1e-8, 1e-6, 1e-8, 1e-6])
    slopes = np.array([(run(h * e) - run(-h * e)) / (2 * h) for h, e in zip(steps, np.eye(5))])
    information = np.zeros((3, 3))
    for segment in range(starts.size):
        jacobian = slopes[:, :, segment].T
        basis, _ = np.linalg.qr(jacobian[:, 3:])
        rest = jacobian[:, :3] - basis @ (basis.T @ jacobian[:, :3])
        information += rest.T @ rest
    return np.sqrt(np.diag(np.linalg.inv(information)))


def write(path, times, measured, current):
    rows = (f"{t:.6f},{x:.9e},{i:.9e}\n" for t, x, i in zip(times, measured, current))
    Path(path).write_text("t,gap,i\n" + "".join(rows))


def infer(twinmap, path, length):
    command = [twinmap, "infer", EXPERIMENT, path, "--segments", str(length), "--json"]
    result = subprocess.run(
        command, capture_output=True, text=True, check=True, env={**os.environ, "OMP_NUM_THREADS": "1"}
    )
    return json.loads(result.stdout)


def report(twinmap, records, length, seed):
    random = np.random.default_rng(seed)
    truths = LOWER + (UPPER - LOWER) * random.random((records, 3))
    times, measured, current, gap, speed = hold(tuple(truths.T), random)
    errors, stddevs, held, statuses = [], [], [], {}
    with tempfile.TemporaryDirectory() as folder:
        for r in range(records):
            path = Path(folder) / "record.csv"
            write(path, times, measured[:, r], current[:, r])
            found = infer(twinmap, path, length)
            statuses[found["status"]] = statuses.get(found["status"], 0) + 1
            best = limit(truths[r], current[:, r], gap[:, r], speed[:, r], length)
            values = [found["parameters"][name] for name in NAMES]
            errors.append([(value["mean"] - true) / sd for value, true, sd in zip(values, truths[r], best)])
            stddevs.append([value["sd"] / sd for value, sd in zip(values, best)])
            held.append([value["lower"] <= true <= value["upper"] for value, true in zip(values, truths[r])])
    print(f"{records} records, segments of {length} s: {statuses}")
    for k, name in enumerate(NAMES):
        ratio = np.sqrt(np.mean(np.square(errors), axis=0))[k]
        print(f"  {name}: errors / limit {ratio:.3f}, sd / limit {np.mean(stddevs, axis=0)[k]:.3f}", end="")
        print(f", 95 % intervals held {np.mean(held, axis=0)[k]:.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("twinmap", nargs="?", type=Path)
    parser.add_argument("--records", type=int, default=100)
    parser.add_argument("--length", type=float, default=0.1)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--record", type=Path)
    arguments = parser.parse_args()
    if arguments.record:
        truth = tuple(np.array([value]) for value in (1.457e-5, 1.45e-3, 0.15))
        times, measured, current, _, _ = hold(truth, np.random.default_rng(83))
        write(arguments.record, times, measured[:, 0], current[:, 0])
    if arguments.twinmap:
        report(arguments.twinmap, arguments.records, arguments.length, arguments.seed)


if __name__ == "__main__":
    main()
