#!/usr/bin/env python3
"""Whether intervals hold after `twinmap diagnose` has found dry friction that a model lacks, however sharply it sets in.

Usage: bench/friction_onset.py TWINMAP FOLDER [--machines 20] [--case NAME ...] [--out FILE]

Machines are drawn from the bounds and simulated with dry friction besides: exact, which sticks, or by a tanh whose speed is a
hundredth or a tenth of the largest. Each is measured once, diagnosed, and inferred by the corrected file. FOLDER keeps the
answers, a line of JSON each: another call goes on.
"""
import argparse
import json
import subprocess
import zlib
from pathlib import Path

import numpy as np
import yaml

ROOT = Path(__file__).resolve().parent.parent
#: Of each: the experiment, what it is, the coordinate, the friction's level, and about the largest speed.
CASES = {
    "pendulum": ("bench/peers/cases/lacking_friction.yaml", "a driven pendulum", "q", 0.02, 5.0),
    "slide": ("experiments/duffing/cart.yaml", "a cart on a hardening spring", "x", 0.05, 0.5),
    "two_masses": (
        "bench/framework/diagnosis/flexible_joint.yaml",
        "a hub that drives a flexible link",
        "hub",
        0.01,
        6.0,
    ),
    "released": ("experiments/mechanisms/released_pendulum.yaml", "a pendulum let go on a slide", "angle", 0.004, 5.0),
    "servo": ("bench/machines/servo_slide.yaml", "an axis in its position loop", "q", 20.0, 0.3),
}
#: Of the largest speed.
ONSETS = {"exact": 0.0, "0.001": 1e-3, "0.01": 1e-2, "0.1": 1e-1}


def run(twinmap, *arguments):
    done = subprocess.run([twinmap, *map(str, arguments)], capture_output=True, text=True)
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    return json.loads(lines[-1]) if lines else {"failed": done.stderr.strip().splitlines()[-1:]}


def make_friction(coordinate, level, onset):
    law = f"model: regularised, onset_speed: {onset!r}" if onset else "model: coulomb"
    return f"system.friction=[{{coordinate: {coordinate}, {law}, coulomb: {level!r}}}]"


class Case:
    def __init__(self, twinmap, folder, name, onset):
        file, _, coordinate, level, speed = CASES[name]
        self.twinmap, self.file, self.folder = twinmap, ROOT / file, folder
        spec = yaml.safe_load(self.file.read_text())
        self.parameters, self.nuisance = spec["parameters"], spec.get("nuisance", {})
        self.friction = make_friction(coordinate, level, ONSETS[onset] * speed)
        self.seed = zlib.crc32(f"{name} {onset}".encode()) % 10**6

    def answer(self, machine):
        rng = np.random.default_rng([self.seed, machine])
        draw = lambda kind: {name: rng.uniform(*map(float, one["bounds"])) for name, one in kind.items()}
        values, nuisance = draw(self.parameters), draw(self.nuisance)
        recording, corrected = self.folder / "recording.csv", self.folder / "corrected.yaml"
        truth = [f"parameters.{name}={value!r}" for name, value in values.items()]
        truth += [f"nuisance.{name}={value!r}" for name, value in nuisance.items()]
        noise = ["--noise", f"seed={self.seed + machine}"]
        run(self.twinmap, "simulate", self.file, *noise, "--csv", recording, self.friction, *truth)
        found = run(self.twinmap, "diagnose", self.file, recording, "--threads", 1, "--json", "--out", corrected)
        if "failed" in found:
            return {"machine": machine, **found}
        inferred = run(
            self.twinmap, "infer", corrected if found["found"] else self.file, recording, "--threads", 1, "--json"
        )
        return {
            "machine": machine,
            "found": found["found"],
            "statuses": inferred.get("statuses", []),
            "diagnosed": self.judge(found.get("parameters", {}), values),
            "inferred": self.judge(inferred.get("parameters", {}), values),
        }

    @staticmethod
    def judge(answers, values):
        """Of each parameter whether its interval holds the true value, and by how many sds its mean is off."""
        judged = {}
        for name, value in values.items():
            if name in answers and "lower" in answers[name]:
                one = answers[name]
                intervals = one.get("intervals95", [[one["lower"], one["upper"]]])
                judged[name] = [any(a <= value <= b for a, b in intervals), (one["mean"] - value) / one["sd"]]
        return judged


def answer_all(twinmap, folder, name, onset, machines):
    folder = folder / f"{name}-{onset}"
    folder.mkdir(parents=True, exist_ok=True)
    kept = folder / "answers.jsonl"
    answers = [json.loads(line) for line in kept.read_text().splitlines()] if kept.exists() else []
    case = Case(twinmap, folder, name, onset)
    for machine in range(len(answers) + 1, machines + 1):
        answers.append(case.answer(machine))
        with kept.open("a") as stream:
            stream.write(json.dumps(answers[-1]) + "\n")
    return answers[:machines]


def make_row(name, onset, answers):
    def share(key):
        held = [holds for answer in answers for holds, _ in answer.get(key, {}).values()]
        return f"{np.mean(held):.2f} of {len(held)}" if held else "-"

    named = sum(any(term.startswith("coulomb.") for term in answer.get("found", [])) for answer in answers)
    at_bounds = sum("at_bounds" in answer.get("statuses", []) for answer in answers)
    failed = sum("failed" in answer for answer in answers)
    cells = [
        CASES[name][1],
        onset,
        f"{named} of {len(answers)}",
        share("diagnosed"),
        share("inferred"),
        at_bounds,
        failed,
    ]
    return "| " + " | ".join(map(str, cells)) + " |"


HEAD = """# Dry friction that a model lacks

Written by `bench/friction_onset.py TWINMAP FOLDER`: machines with dry friction of which the model knows nothing, exact or by tanh(v / s) with s
a share of the largest speed. Named: `diagnose` finds `coulomb`. Then the share of true parameters within their 95 % intervals, as `diagnose`
gives them and as `infer` does with the corrected file; how many of these are `at_bounds`; and how many failed.

| machine | s | named | diagnosed | inferred | at bounds | failed |
|---|--:|--:|--:|--:|--:|--:|
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("twinmap")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--machines", type=int, default=20)
    parser.add_argument("--case", nargs="+", choices=CASES, default=list(CASES))
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    rows = []
    for name in options.case:
        for onset in ONSETS:
            answers = answer_all(options.twinmap, options.folder, name, onset, options.machines)
            rows.append(make_row(name, onset, answers))
            print(rows[-1], flush=True)
    if options.out:
        options.out.write_text(HEAD + "\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
