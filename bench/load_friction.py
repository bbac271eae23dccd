"""Servo pendulums whose friction grows with load: errors over the information limit, coverage, what `diagnose` names, and time.

Usage: load_friction.py TWINMAP FOLDER [--machines 48] [--missing 24] [--sound 12] [--rounds 5]

The truth is this file's own: Runge and Kutta's method of fourth order, each halt and each start found within its step. A
pendulum is driven by a torque or by a position controller; friction is viscous and Coulomb, with a level that grows with the
weight's torque. Masses, levels, amplitudes and phases are drawn for each machine; the experiment states gravity as a force
law or of its body. The limit is the Fisher information of the own simulation. Answers that FOLDER has are not asked for again.
"""
import argparse
import json
import random
import statistics
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from math import copysign, cos, pi, sin, sqrt
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent / "simulation"))
from loops import time_run  # noqa: E402

STEP, INTERVAL, COUNT = 1e-3, 0.02, 601  # s, s
NOISE = 1e-3  # rad
NAMES = ["J", "W", "b", "F", "mu"]  # kg m2, N m, N m s/rad, N m, 1
BOUNDS = {"J": (0.002, 0.06), "W": (0.3, 2), "b": (0, 0.3), "F": (0, 0.5), "mu": (0, 0.6)}
UNITS = {"J": "kg m2", "W": "N m", "b": "N m s/rad", "F": "N m", "mu": "1"}
# In parts of the weight's torque, 0.6 to 1.2 times: with more a pendulum turns over, and any noise decides when. In rad.
SINES = {"torque": ((0.6, 0.21), (0.25, 0.47), (0.15, 0.83)), "controller": ((0.6, 0.21), (0.3, 0.47), (0.15, 0.83))}
KP, KD = 6.0, 0.15  # N m/rad, N m s/rad
MASS = 2.0  # kg, where gravity is the body's
LAWS = {"torque": "u", "controller": f"{KP}*(u - q) - {KD}*q_dot"}
FILE = """name: servo
parameters:
{parameters}system:
{gravity}  bodies: {{arm: {{mass: {mass}, inertia: {inertia}, {center}joint: {{type: pin, coordinates: [q]}}}}}}
  force_laws: [{{coordinate: q, force: '{law}'}}]
  friction: [{{coordinate: q, model: coulomb, coulomb: '{level}', viscous: b}}]
excitation: {{u: {{unit: {unit}, sines: [{sines}]}}}}
outputs: {{q: {{coordinate: q}}}}
simulation: {{duration: 12}}
features: [{{samples: {{outputs: [q], start: 0, interval: 0.02, count: 601}}}}]
noise: {{stddev: {{q: 1e-3}}}}
measurement: {{time: t, columns: {{q: q}}}}
inverse_map: none
"""


class Servo:
    """One machine. values: of NAMES, W the torque of the weight at a right angle."""

    def __init__(self, seed, grows=True):
        rng = random.Random(seed)
        draw = rng.uniform
        self.seed, self.rng = seed, rng
        self.drive = ("torque", "controller")[seed % 2]
        self.gravity = ("law", "body")[seed // 2 % 2]
        self.truth = {"J": draw(0.018, 0.03), "W": draw(0.8, 1.2), "b": draw(0.02, 0.06), "F": draw(0.04, 0.12)}
        self.truth["mu"] = draw(0.08, 0.3) * grows
        size = draw(0.6, 1.2) * (self.truth["W"] if self.drive == "torque" else 1)
        self.sines = [(size * a, f, draw(0, 2 * pi)) for a, f in SINES[self.drive]]

    def push(self, t, q, v):
        signal = sum(a * sin(2 * pi * f * t + p) for a, f, p in self.sines)
        return signal if self.drive == "torque" else KP * (signal - q) - KD * v

    def swing(self, values):
        """Angles at COUNT times."""
        J, W, b, F, mu = (values[name] for name in NAMES)
        hold = lambda q: F + mu * abs(W * sin(q))
        force = lambda t, q, v: self.push(t, q, v) - W * sin(q)

        def slide(t, q, v, side, h):
            accelerate = lambda t, q, v: (force(t, q, v) - b * v - side * hold(q)) / J
            a = accelerate(t, q, v)
            v2 = v + h / 2 * a
            c = accelerate(t + h / 2, q + h / 2 * v, v2)
            v3 = v + h / 2 * c
            d = accelerate(t + h / 2, q + h / 2 * v2, v3)
            v4 = v + h * d
            e = accelerate(t + h, q + h * v3, v4)
            return q + h / 6 * (v + 2 * v2 + 2 * v3 + v4), v + h / 6 * (a + 2 * c + 2 * d + e)

        def find(crosses, h):
            low, high = 0.0, h
            for _ in range(40):
                middle = (low + high) / 2
                low, high = (low, middle) if crosses(middle) else (middle, high)
            return high

        def advance(t, q, v, side, h):
            while h > 1e-12:
                if side == 0:
                    starts = lambda after: abs(force(t + after, q, 0.0)) > hold(q)
                    if not starts(h):
                        return q, v, side
                    after = 0.0 if starts(0.0) else find(starts, h)
                    side = int(copysign(1, force(t + after, q, 0.0)))
                    t, h = t + after, h - after
                    first = min(h, 1e-6)  # past the start, where the speed is 0 yet
                    q, v = slide(t, q, v, side, first)
                    t, h = t + first, h - first
                    continue
                ends = lambda after: slide(t, q, v, side, after)[1] * side <= 0
                if not ends(h):
                    q, v = slide(t, q, v, side, h)
                    return q, v, side
                after = find(ends, h)
                q, v, side = slide(t, q, v, side, after)[0], 0.0, 0
                t, h = t + after, h - after
            return q, v, side

        q, v, side, angles = 0.0, 0.0, 0, [0.0]
        each = round(INTERVAL / STEP)
        for i in range(each * (COUNT - 1)):
            q, v, side = advance(i * STEP, q, v, side, STEP)
            if (i + 1) % each == 0:
                angles.append(q)
        return np.array(angles)

    def calc_limit(self, names):
        """Standard deviations that no unbiased estimate goes below."""
        columns = []
        for name in names:
            step = 1e-4 * max(self.truth[name], 0.05)
            ends = [self.swing({**self.truth, name: self.truth[name] + sign * step}) for sign in (1, -1)]
            columns.append((ends[0] - ends[1]) / (2 * step * NOISE))
        derivative = np.array(columns).T
        return dict(zip(names, np.sqrt(np.diag(np.linalg.inv(derivative.T @ derivative)))))

    def write(self, folder, with_load):
        """Experiment and measurement."""
        names = [name for name in NAMES if with_load or name != "mu"]
        weight = self.gravity == "body"
        load = "q_gravity" if weight else "W*sin(q)"
        text = FILE.format(
            parameters="".join(f"  {n}: {{bounds: {list(BOUNDS[n])}, unit: {UNITS[n]}}}\n" for n in names),
            gravity="  gravity: [0, -9.81, 0]\n" if weight else "",
            mass=MASS,
            inertia="J",
            center=f"center_of_mass: [0, '-W/({MASS}*9.81)', 0], " if weight else "",
            law=LAWS[self.drive] + ("" if weight else " - W*sin(q)"),
            level=f"F + mu*abs({load})" if with_load else "F",
            unit="N m" if self.drive == "torque" else "rad",
            sines=", ".join(f"{{amplitude: {a}, frequency: {f}, phase: {p}}}" for a, f, p in self.sines),
        )
        (folder / "servo.yaml").write_text(text)
        angles = self.swing(self.truth)
        rng = np.random.default_rng(self.seed)
        rows = zip(np.arange(COUNT) * INTERVAL, angles + NOISE * rng.standard_normal(COUNT))
        (folder / "m.csv").write_text("t,q\n" + "".join(f"{t:.4f},{q:.9g}\n" for t, q in rows))
        return folder / "servo.yaml", folder / "m.csv"


def ask(twinmap, command, folder, servo, with_load, *options):
    """The answer of `twinmap command`, kept in the folder, with its processor seconds."""
    kept = folder / "answer.json"
    if not kept.exists():
        folder.mkdir(parents=True, exist_ok=True)
        files = servo.write(folder, with_load)
        script = ["/usr/bin/env", "OMP_NUM_THREADS=1", "bash", "-c", 'TIMEFORMAT="%U"; time "$@" 2>"$0"']
        arguments = [str(one) for one in (folder / "stderr", twinmap, command, *files, "--json", *options)]
        done = subprocess.run(script + arguments, capture_output=True, text=True)
        if not done.stdout:
            sys.exit(f"{folder}: {(folder / 'stderr').read_text()}")
        answer = json.loads(done.stdout.splitlines()[-1])
        kept.write_text(json.dumps({"answer": answer, "seconds": float(done.stderr.split()[-1])}))
    return json.loads(kept.read_text())


def infer(twinmap, folder, seed):
    servo = Servo(seed)
    answer = ask(twinmap, "infer", folder / f"right{seed}", servo, True)
    limits = folder / f"right{seed}" / "limit.json"
    if not limits.exists():
        limits.write_text(json.dumps(servo.calc_limit(NAMES)))
    limit, found = json.loads(limits.read_text()), answer["answer"].get("parameters")
    levels = {}
    if found is None:
        print(seed, servo.drive, servo.gravity, answer["answer"]["status"], f"{answer['seconds']:.1f} s", flush=True)
        return None
    for name in ("F", "mu"):
        one, truth = found[name], servo.truth[name]
        levels[name] = ((one["mean"] - truth) / limit[name], one["lower"] <= truth <= one["upper"])
    print(seed, servo.drive, servo.gravity, levels, f"{answer['seconds']:.1f} s", flush=True)
    return levels


def name_terms(answer):
    """Of each step that found some, what is first or tied with it."""
    steps = [step for step in answer["steps"] if step["found"]]
    return [[one["term"] for one in step["candidates"][: max(1, step.get("tied", 1))]] for step in steps]


def diagnose(twinmap, folder, seed, grows):
    servo = Servo(seed, grows)
    answer = ask(twinmap, "diagnose", folder / f"{'lacks' if grows else 'sound'}{seed}", servo, False)
    terms = name_terms(answer["answer"])
    kind = f"{servo.drive} {servo.gravity} mu {servo.truth['mu']:.2f}"
    print("lacks" if grows else "sound", seed, kind, terms, f"{answer['seconds']:.1f} s", flush=True)
    named = any(term.split(".")[0] in ("load_friction", "drive_friction") for step in terms[:1] for term in step)
    return {"named": named, "nothing": not terms, "seconds": answer["seconds"]}


def narrow(values, names):
    return [f"parameters.{name}.bounds=[{0.9 * values[name]}, {1.1 * values[name]}]" for name in names]


def time_lanes(twinmap, folder, rounds, samples=4000):
    """Of each drive and gravity, a sample's time over that of Coulomb friction of the mean level, both in each round."""
    ratios = {}
    for seed in range(4):
        servo = Servo(seed)
        files = {}
        for with_load in (True, False):
            place = folder / f"lanes{seed}{with_load}"
            place.mkdir(parents=True, exist_ok=True)
            files[with_load] = servo.write(place, with_load)[0]
        load = np.mean(np.abs(servo.truth["W"] * np.sin(servo.swing(servo.truth))))
        even = {**servo.truth, "F": servo.truth["F"] + servo.truth["mu"] * load}
        found = []
        for _ in range(rounds):
            times = {}
            for with_load, file in files.items():
                overrides = narrow(servo.truth, NAMES) if with_load else narrow(even, NAMES[:-1])
                few = time_run(twinmap, str(file), samples // 10, *overrides)
                times[with_load] = time_run(twinmap, str(file), samples, *overrides) - few
            found.append(times[True] / times[False])
        ratios[f"{servo.drive} {servo.gravity}"] = statistics.median(found)
    return ratios


def describe_levels(machines):
    answered = [machine for machine in machines if machine is not None]
    print(f"{len(answered)} of {len(machines)} machines have estimates")
    machines = answered
    for name in ("F", "mu"):
        errors = np.array([machine[name][0] for machine in machines])
        held = np.mean([machine[name][1] for machine in machines])
        print(f"{name}: {sqrt(np.mean(errors**2)):.2f} of the limit, {held:.3f} of the 95 % intervals hold")


def describe_diagnoses(what, key, machines):
    seconds = [machine["seconds"] for machine in machines]
    count = sum(machine[key] for machine in machines)
    times = f"seconds {statistics.median(seconds):.1f} (median), {max(seconds):.1f} at most"
    print(f"{what}: {count} of {len(machines)}; {times}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("twinmap")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--machines", type=int, default=48, help="that are inferred with the right model")
    parser.add_argument("--missing", type=int, default=24, help="that are diagnosed with a model that lacks the growth")
    parser.add_argument("--sound", type=int, default=12, help="whose friction does not grow")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--jobs", type=int, default=1)
    arguments = parser.parse_args()
    twinmap, folder = arguments.twinmap, arguments.folder
    with ThreadPoolExecutor(arguments.jobs) as pool:
        lacking = list(pool.map(lambda seed: diagnose(twinmap, folder, seed, True), range(arguments.missing)))
        sound = list(pool.map(lambda seed: diagnose(twinmap, folder, seed, False), range(100, 100 + arguments.sound)))
        machines = list(pool.map(lambda seed: infer(twinmap, folder, seed), range(200, 200 + arguments.machines)))
    if machines:
        describe_levels(machines)
    if lacking:
        describe_diagnoses("load or drive friction named", "named", lacking)
    if sound:
        describe_diagnoses("nothing found where nothing is missing", "nothing", sound)
    if arguments.rounds:
        for kind, ratio in time_lanes(twinmap, folder, arguments.rounds).items():
            print(f"time of lanes over that of Coulomb friction, {kind}: {ratio:.2f}")


if __name__ == "__main__":
    main()
