#!/usr/bin/env python3
"""Diagnoses recordings of real machines that others made and published, and writes a page.

Usage: bench/real_machines.py TWINMAP FOLDER --out FILE [--machines NAME ...] [--keep FOLDER]

FOLDER holds a folder for each machine with its recording, as where it was published; recordings are not part of the project.
The models are bench/real/*.yaml. Each is fitted to some windows of the recording as it is, diagnosed by them, and with what
was found predicts other windows.
"""
import argparse
import json
import os
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

MODELS = Path(__file__).resolve().parent / "real"


@dataclass
class Machine:
    model: str
    folder: str
    recording: str
    source: str
    fitted: list
    predicted: list
    published: dict
    accepted: list  # terms of the publishers' model, and delays that others saw
    says: str  # what the table does not


MACHINES = [
    Machine(
        "emps",
        "emps",
        "DATA_EMPS.mat",
        "EMPS, a servo axis (Janot, Gautier and Brunot 2019)",
        [0, 5],
        [10, 15],
        {"M": "95.11", "Fv": "203.5", "coulomb_q": "20.39", "constant_force_q": "3.16"},
        ["coulomb.q", "constant_force.q"],
        """Friction is found first, then a constant force, then a gain of the voltage, which nothing on the machine has. If the loop's own gain differs, forces are larger by as much: the first window alone is explained with M 86.3 kg, Fv 159 N s/m and a friction of 20.7 N, which times the gain of 1.098 are 94.8, 175 and 22.7, close to the published ones. Of both windows together the posterior is not reliable: no corrected parameters, and predictions are worse.""",
    ),
    Machine(
        "fork",
        "bicycle_fork_pendulum",
        "BrowserForkCompoundFirst1.mat",
        "A bicycle's fork swings (Moore, BicycleParameters)",
        [0, 10],
        [19.9],
        {"J": "0.2458"},
        ["coulomb.angle"],
        """Friction is found, its shape is not: five shapes fit, and the answer is averaged over them. The first 10 s alone are `ok` without friction. The record's period is 1.590 s, the published one 1.602 s: that is what remains between 0.231 and 0.246.""",
    ),
    Machine(
        "pendulum",
        "dfki_pendulum",
        "energy_shaping_data_measured.csv",
        "A pendulum on a motor (DFKI, torque_limited_simple_pendulum)",
        [0.4, 1.4, 2.4, 3.4, 16.2],
        [8, 12.7],
        {
            "J": "0.169; 0.0626",
            "ml": "0.338; 0.1022",
            "Fv": "0.0471",
            "coulomb_q": "0.289",
            "constant_force_q": "0.076",
        },
        ["coulomb.q", "constant_force.q", "delay.tau"],
        """Published are the values of the bench's controllers and, second, those of an identification from another recording. Friction is found, somewhat below the published; with a delay of the torque added by hand, mass and inertia agree with the controllers' values. The delay itself does not stand out beside friction. Predictions do not improve: the held windows pass near the upright position, where errors grow.""",
    ),
    Machine(
        "double_pendulum",
        "dfki_double_pendulum",
        "C1_143339.csv",
        "Two arms, two motors (DFKI, double_pendulum, design C.1)",
        [1, 3, 5],
        [2, 4, 6],
        {
            "S1": "0.2298",
            "S2": "0.1600",
            "J1": "0.0569",
            "b1": "0.001",
            "b2": "0.001",
            "coulomb_q1": "0.25",
            "coulomb_q2": "0.19",
        },
        ["coulomb.q1", "coulomb.q2", "delay.tau1", "delay.tau2"],
        """Friction is missing: the shoulder's is named, as one of low speed; damping takes up the elbow's, an offset and a spring stand in for the rest. Sums of masses and inertias come near the published ones, I2 + S2^2/m2 at 0.0502 (0.0509) among them. Delays of -20 and 12 ms, which others saw between channels, are not found; given friction and delays of both torques, the posterior is not reliable (chi-square 4164).""",
    ),
    Machine(
        "drone",
        "quarter_drone",
        "14_drone_seq_20260529_195254.csv",
        "An arm with a propeller (PUC-Rio, quarter drone)",
        [9, 21, 37],
        [24, 42, 53],
        {"c1": "-8.29", "c2": "0.00419", "c3": "-1.437"},
        ["delay.u"],
        """The propeller needs time to reach its thrust, which `lag.angle` and `delay.u` show; the cubic spring has no counterpart on the bench and stands for what remains. Held windows are predicted with half of the error, 0.05 rad.""",
    ),
]

HEAD = """# Real machines

Written by `bench/real_machines.py TWINMAP FOLDER` from recordings that others published with the parameters that they found. These
[models](../../bench/real) are plain: inertia, gravity and viscous friction. Each is fitted to windows of its recording as it is,
[diagnosed](../how-to/find-what-a-model-lacks.md), and the corrected model predicts other windows. Residuals are in standard deviations of the
stated noise: 1 is as good as the sensors. "Terms given" (`--accept`) are those of the publishers' own model, and delays that others saw.
Seconds are of a processor. Standard deviations beside a model that misfits are of the noise alone. The pendulum's windows, and noise or
bounds of EMPS, the fork and the pendulum, were set after results had been seen: this page shows what can be had, it is not a blind test.

"""


class Runner:
    def __init__(self, twinmap, folder):
        self.twinmap, self.folder = twinmap, folder

    def call(self, *arguments):
        """What it prints as JSON, or {}; its first error; seconds of a processor."""
        before = os.times()
        done = subprocess.run(
            [self.twinmap, *map(str, arguments)],
            cwd=self.folder,
            capture_output=True,
            text=True,
            env={**os.environ, "OMP_NUM_THREADS": "1"},
        )
        after = os.times()
        seconds = after.children_user - before.children_user
        lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
        name = f"{arguments[0]}_{Path(arguments[1]).stem}"
        (self.folder / f"{name}.txt").write_text(done.stdout + done.stderr + f"\n{seconds:.1f} s\n")
        return (json.loads(lines[-1]) if lines else {}), done.stderr.strip(), seconds


def repeat(option, values):
    return [part for value in values for part in (option, value)]


def accept(runner, machine, options, against):
    """With the terms that the publishers' model has."""
    model, corrected = f"{machine.model}.yaml", f"{machine.model}_accepted.yaml"
    terms = ",".join(machine.accepted)
    found, error, _ = runner.call("diagnose", model, machine.recording, *options, "--accept", terms, "--out", corrected)
    print(f"{machine.model}: accepted {machine.accepted} {error}", flush=True)
    if not found:
        return {"accepted": {}, "accepted_prediction": {}}
    prediction, _, _ = runner.call("validate", corrected, machine.recording, *options[:-1], *against)
    return {"accepted": found, "accepted_prediction": prediction}


def measure(runner, machine):
    model, recording = f"{machine.model}.yaml", machine.recording
    starts = repeat("--start", machine.fitted)
    against = ["--against", recording, *repeat("--against-start", machine.predicted), "--json"]
    found, error, time_of_diagnosis = runner.call(
        "diagnose", model, recording, *starts, "--json", "--out", "corrected.yaml"
    )
    print(f"{machine.model}: diagnosed in {time_of_diagnosis:.0f} s: {found.get('found')} {error}", flush=True)
    before, error, _ = runner.call("validate", model, recording, *starts, *against)
    corrected = f"{machine.model}_corrected.yaml"
    (runner.folder / "corrected.yaml").rename(runner.folder / corrected)
    after, error, _ = runner.call("validate", corrected, recording, *starts, *against)
    print(f"{machine.model}: predicted {error}", flush=True)
    named = accept(runner, machine, [*starts, "--json"], against)
    return {
        "machine": machine,
        "diagnosis": found,
        "before": before,
        "after": after,
        **named,
        "seconds": time_of_diagnosis,
    }


def show(value, stddev):
    if value is None or stddev is None or not stddev > 0:
        return "-"
    return f"{value:.4g} +- {stddev:.2g}"


def get(parameters, name):
    one = (parameters or {}).get(name) or {}
    return show(one.get("mean"), one.get("sd"))


def make_parameter_rows(result):
    diagnosis, machine = result["diagnosis"], result["machine"]
    before, after = diagnosis["before"].get("parameters", {}), diagnosis["after"].get("parameters", {})
    averaged, effective = diagnosis.get("parameters", {}), diagnosis.get("remainder", {}).get("parameters", {})
    named = result["accepted"].get("after", {}).get("parameters", {})
    names = list(dict.fromkeys([*before, *after, *named, *machine.published]))
    rows = ""
    for name in names:
        corrected = get(averaged, name) if name in averaged else get(after, name)
        published = machine.published.get(name, "")
        rows += f"| {name} | {get(before, name)} | {corrected} | {get(effective, name)} | {get(named, name)} | {published} |\n"
    return rows


def make_rms(predictions):
    rows = predictions.get("predictions", [])
    return ", ".join(f"{row['rms']:.3g}" for row in rows) or "not measured"


def describe_found(diagnosis):
    steps = [step for step in diagnosis["steps"] if step["found"]]
    texts = []
    for step in steps:
        tied = [c["term"] for c in step["candidates"][: step["tied"]]]
        partner = step.get("partner") or {}
        text = " or ".join(f"`{term}`" for term in tied) + (f" with `{partner['term']}`" if partner else "")
        texts.append(text)
    return "; then ".join(texts) or "nothing"


def make_section(result):
    machine, diagnosis = result["machine"], result["diagnosis"]
    before, after = diagnosis["before"], diagnosis["after"]
    text = f"## {machine.source}\n\n"
    status = "ok" if before["explained"] else "model_mismatch"
    text += f"- Plain model: `{status}`, chi-square {before['chi_square']:.4g} of {before['degrees']:.0f}.\n"
    text += f"- Found: {describe_found(diagnosis)}. In the end: {', '.join(f'`{t}`' for t in diagnosis['found']) or 'nothing'}.\n"
    text += f"- With it: `{diagnosis['status']}`, chi-square {after['chi_square']:.4g} of {after['degrees']:.0f}.\n"
    text += f"- Windows not used, residual: {make_rms(result['before'])} before, {make_rms(result['after'])} after, {make_rms(result['accepted_prediction'])} with the terms given.\n"
    text += f"- Diagnosis: {result['seconds']:.0f} s.\n"
    text += f"\n{machine.says}\n\n" if machine.says else "\n"
    text += "| parameter | plain model | corrected | with what remains | terms given | published |\n|---|--:|--:|--:|--:|--:|\n"
    return text + make_parameter_rows(result) + "\n"


def link(folder, source):
    for path in [*MODELS.glob("*.yaml"), *source.rglob("*")]:
        target = folder / path.name
        if path.is_file() and not target.exists():
            target.symlink_to(path.resolve())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("twinmap", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--out", type=Path, required=True, help="the page, Markdown")
    parser.add_argument("--machines", nargs="+", choices=[m.model for m in MACHINES])
    parser.add_argument("--keep", type=Path, help="folder for what twinmap prints; results that are there are used")
    arguments = parser.parse_args()
    sections = []
    for machine in MACHINES:
        if arguments.machines and machine.model not in arguments.machines:
            continue
        with tempfile.TemporaryDirectory() as temporary:
            work = (arguments.keep / machine.model) if arguments.keep else Path(temporary)
            work.mkdir(parents=True, exist_ok=True)
            link(work, arguments.folder / machine.folder)
            known = work / "result.json"
            if known.exists():
                result = {**json.loads(known.read_text()), "machine": machine}
            else:
                result = measure(Runner(arguments.twinmap.resolve(), work), machine)
                known.write_text(json.dumps({k: v for k, v in result.items() if k != "machine"}))
            sections.append(make_section(result))
    arguments.out.write_text(HEAD + "".join(sections).rstrip() + "\n")


if __name__ == "__main__":
    main()
