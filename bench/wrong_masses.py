"""How often `twinmap infer` distrusts good measurements, and those of a machine with a mass that is 3 % wrong.

Usage: wrong_masses.py TWINMAP [--good N] [--bad N] [--keep FOLDER] EXPERIMENT...
Trains each EXPERIMENT, then infers fresh simulated measurements with noise (default: 400) and, for each constant with the
unit kg and each body whose mass is a number, measurements (default: 100) of machines in which it is 3 % larger. A row each: the share called model_mismatch, of
bad ones also of those whose clean response is more than 5 noise standard deviations from what any parameters of the model
give (the least misfit that a refinement of the clean response finds). Needs outputs whose noise is a number.
"""
import argparse
import json
import subprocess
import tempfile
from pathlib import Path

import h5py
import numpy as np
import yaml

WRONG = 1.03
FAR = 5.0


def run(twinmap, experiment, folder, *overrides):
    subprocess.run(
        [twinmap, "run", experiment, "evaluation.limit=false", *overrides, "--out", folder, "--quiet"],
        check=True,
        capture_output=True,
    )


def simulate(twinmap, experiment, folder, count, *overrides):
    """Clean responses (count x outputs x times) of points that no training has seen, and the times."""
    run(
        twinmap,
        experiment,
        folder,
        "seed=4711",
        "design.train.samples=40",
        "refine=never",
        f"design.test.samples={count}",
        *overrides,
    )
    with h5py.File(folder / "samples.h5") as file:
        return file["test/responses"][:], file["times"][:]


def infer(twinmap, folder, outputs, times, responses):
    """What is said of each response."""
    lines = []
    for response in responses:
        lines += ["t," + ",".join(outputs)]
        lines += [",".join(repr(float(v)) for v in (t, *row)) for t, row in zip(times, response.T)]
        lines += [""]
    result = subprocess.run(
        [twinmap, "infer", folder, "--follow"], input="\n".join(lines), capture_output=True, text=True, check=True
    )
    return [json.loads(line) for line in result.stdout.splitlines()]


def is_mismatch(answers):
    return np.array(["model_mismatch" in answer["statuses"] for answer in answers])


def calc_misfits(answers):
    """Of clean responses: their distance from the model, in noise standard deviations."""
    return np.sqrt([answer.get("refined", answer["trust"])["chi_square"] for answer in answers])


def describe(found):
    return f"{100 * found.mean():6.2f} % of {len(found)}" if len(found) else "     - of 0"


class Case:
    def __init__(self, twinmap, experiment, keep):
        self.twinmap, self.experiment, self.keep = twinmap, experiment, keep
        self.spec = yaml.safe_load(Path(experiment).read_text(encoding="utf-8"))
        self.outputs = list(self.spec["noise"]["stddev"])
        self.noise = np.array([float(sd) for sd in self.spec["noise"]["stddev"].values()])[:, None]
        self.rng = np.random.default_rng(1)

    def list_masses(self):
        """Name -> key path and value."""
        constants = {
            name: (f"constants.{name}.value", float(constant["value"]))
            for name, constant in self.spec.get("constants", {}).items()
            if isinstance(constant, dict) and constant.get("unit") == "kg"
        }
        bodies = {
            name: (f"system.bodies.{name}.mass", float(body["mass"]))
            for name, body in self.spec["system"]["bodies"].items()
            if isinstance(body["mass"], (int, float))
        }
        return {**constants, **bodies}

    def measure(self, clean):
        return clean + self.noise * self.rng.standard_normal(clean.shape)

    def infer(self, folder, times, responses, name):
        answers = infer(self.twinmap, folder / "map", self.outputs, times, responses)
        if self.keep:
            text = "\n".join(json.dumps(answer) for answer in answers)
            (self.keep / f"{Path(self.experiment).stem}_{name}.jsonl").write_text(text, encoding="utf-8")
        return answers

    def report(self, good, bad, folder):
        name = Path(self.experiment).stem
        run(self.twinmap, self.experiment, folder / "map")
        clean, times = simulate(self.twinmap, self.experiment, folder / "good", good)
        answers = self.infer(folder, times, self.measure(clean), "good")
        print(f"{name:22s} good              {describe(is_mismatch(answers))}", flush=True)
        for mass, (key, value) in self.list_masses().items():
            wrong, _ = simulate(self.twinmap, self.experiment, folder / mass, bad, f"{key}={WRONG * value!r}")
            far = calc_misfits(self.infer(folder, times, wrong, mass + "_clean")) > FAR
            found = is_mismatch(self.infer(folder, times, self.measure(wrong), mass))
            print(f"{name:22s} {mass:6s} 3 % wrong {describe(found)}; above 5 sd {describe(found[far])}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("twinmap")
    parser.add_argument("experiments", nargs="+")
    parser.add_argument("--good", type=int, default=400)
    parser.add_argument("--bad", type=int, default=100)
    parser.add_argument("--keep", type=Path, help="write what infer says into this folder")
    arguments = parser.parse_args()
    if arguments.keep:
        arguments.keep.mkdir(parents=True, exist_ok=True)
    for experiment in arguments.experiments:
        with tempfile.TemporaryDirectory() as folder:
            Case(arguments.twinmap, experiment, arguments.keep).report(arguments.good, arguments.bad, Path(folder))


if __name__ == "__main__":
    main()
