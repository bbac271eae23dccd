"""The cases: an experiment, what its machines have besides, true values drawn by seed, recordings simulated by twinmap.

A case's folder holds what a peer gets (case.json, model.yaml, a CSV file a machine and trial) and truth.json, which it does not:
the values, and the standard deviations that noise and priors leave (Fisher information of the model along its response).
"""
import dataclasses
import json
import math
import subprocess
import zlib
from pathlib import Path

import numpy as np
import yaml

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
#: Truths are simulated more precisely than any peer does.
PRECISE = {"simulation.relative_tolerance": 1e-10, "simulation.absolute_tolerance": 1e-12}


@dataclasses.dataclass(frozen=True)
class Kind:
    name: str
    file: Path
    about: str
    truth: dict = dataclasses.field(default_factory=dict)
    spikes: int = 0
    #: Fewer where a simulation costs most.
    machines: int = 40


KINDS = [
    Kind("closed_form", HERE / "cases/closed_form.yaml", "linear in its parameters, so that the posterior is known"),
    Kind("two_beam", ROOT / "experiments/two_beam/best.yaml", "two beams after a pulse, 4 parameters"),
    Kind(
        "double_pendulum_mild",
        ROOT / "experiments/mechanisms/double_pendulum_mild.yaml",
        "a double pendulum on a cart after a mild pulse, 5 parameters",
    ),
    Kind(
        "servo_axis",
        ROOT / "experiments/mechanisms/servo_axis.yaml",
        "a linear axis in its position loop, with winding and friction, 5 parameters",
    ),
    Kind("stick_slip", ROOT / "experiments/mechanisms/stick_slip.yaml", "a slide that sticks and slips, 4 parameters"),
    Kind("product", ROOT / "bench/machines/product.yaml", "only the product of m and L is seen, 4 parameters"),
    Kind("mirror", ROOT / "bench/machines/mirror.yaml", "the sign of e is not seen, 3 parameters"),
    Kind(
        "lacking_friction",
        HERE / "cases/lacking_friction.yaml",
        "a driven pendulum with dry friction of 0.02 N m that the model lacks, 3 parameters",
        {"system.friction": "[{coordinate: q, model: regularised, coulomb: 0.02, onset_speed: 1e-3}]"},
    ),
    Kind(
        "spikes",
        HERE / "cases/spikes.yaml",
        "a cart with noise that nobody knows and four spikes of 30 to 200 of its sds, 3 parameters",
        {"noise.stddev.x": 1.7e-4},
        spikes=4,
    ),
    Kind(
        "two_recordings",
        HERE / "cases/two_recordings.yaml",
        "a pendulum let go, which tells ratios alone, and driven by a known torque: two recordings together, 4 parameters",
    ),
    Kind(
        "seven_joint_arm",
        ROOT / "experiments/mechanisms/seven_joint_arm.yaml",
        "seven joints under PD laws, two recordings of 20 s, angles alone, 40 parameters",
        machines=10,
    ),
]


def spread(prior):
    """Mean and sd of a normal or lognormal prior, the latter where it is about normal."""
    ((kind, prior),) = prior.items()
    if kind == "normal":
        return float(prior["mean"]), float(prior["stddev"])
    return float(prior["median"]), float(prior["median"]) * math.log(float(prior["factor"]))


def draw(parameter, rng):
    """From its prior, else within its bounds."""
    if "prior" not in parameter:
        return rng.uniform(*map(float, parameter["bounds"]))
    (kind, prior), *_ = parameter["prior"].items()
    if kind == "normal":
        return float(prior["mean"]) + float(prior["stddev"]) * rng.standard_normal()
    return float(prior["median"]) * float(prior["factor"]) ** rng.standard_normal()


class Maker:
    """Makes the folder of a case, machine by machine; what is there stays."""

    def __init__(self, kind, folder, twinmap):
        import twinmap as package

        self.kind, self.folder, self.twinmap = kind, folder, twinmap
        self.spec = yaml.safe_load(kind.file.read_text())
        self.trials = list(self.spec.get("trials", {})) or [None]
        self.experiments = [package.Experiment.from_file(kind.file, trial=trial) for trial in self.trials]
        self.seed = zlib.crc32(kind.name.encode()) % 10**6
        folder.mkdir(parents=True, exist_ok=True)

    def make(self, machines):
        (self.folder / "model.yaml").write_text(self.kind.file.read_text())
        (self.folder / "case.json").write_text(json.dumps(self.describe(), indent=1))
        file = self.folder / "truth.json"
        truths = json.loads(file.read_text()) if file.exists() else []
        for machine in range(len(truths) + 1, machines + 1):
            values = self.draw(machine)
            self.record(machine, values)
            truths.append({"values": list(values.values()), "limits": self.calc_limits(values)})
            file.write_text(json.dumps(truths))

    def describe(self):
        first, parameters = self.experiments[0], self.spec["parameters"]
        priors = [spread(one["prior"]) if "prior" in one else None for one in parameters.values()]
        noise = [self.spec["noise"]["stddev"][output.name] for output in first.outputs]
        return {
            "name": self.kind.name,
            "names": list(parameters),
            "lower": [one.lower for one in first.parameters],
            "upper": [one.upper for one in first.parameters],
            "priors": priors,
            "trials": self.trials,
            "outputs": [output.name for output in first.outputs],
            "noise": [None if sd == "unknown" else float(sd) for sd in noise],
            "times": first.times.tolist(),
        }

    def draw(self, machine):
        rng = np.random.default_rng([self.seed, machine])
        return {name: float(draw(one, rng)) for name, one in self.spec["parameters"].items()}

    def record(self, machine, values):
        truth = [f"{key}={value}" for key, value in {**PRECISE, **self.kind.truth}.items()]
        truth += [f"parameters.{name}={value!r}" for name, value in values.items()]
        for i, trial in enumerate(self.trials):
            file = self.folder / f"{machine}{'.' + trial if trial else ''}.csv"
            seed = [f"seed={self.seed + 10 * machine + i}", *([f"trial={trial}"] if trial else [])]
            command = [self.twinmap, "simulate", self.kind.file, "--noise", "--csv", file, *truth, *seed]
            subprocess.run(list(map(str, command)), check=True)
            if self.kind.spikes:
                self.add_spikes(file, np.random.default_rng([self.seed, machine, i]))

    def add_spikes(self, file, rng):
        header = file.read_text().splitlines()[0]
        table = np.loadtxt(file, delimiter=",", skiprows=1)
        sizes = rng.choice([-1, 1], self.kind.spikes) * rng.uniform(30, 200, self.kind.spikes)
        noise = float(next(value for key, value in self.kind.truth.items() if key.startswith("noise.stddev")))
        table[rng.choice(len(table), self.kind.spikes, replace=False), 1] += sizes * noise
        np.savetxt(file, table, delimiter=",", header=header, comments="", fmt="%.17g")

    def calc_limits(self, values):
        """Standard deviations of a normal posterior at the true values; a uniform prior counts by its variance."""
        point, information = np.array(list(values.values())), 0
        widths = np.array([one.upper - one.lower for one in self.experiments[0].parameters])
        steps = np.diag(1e-4 * widths)
        for experiment in self.experiments:
            above, below = np.split(self.simulate(experiment, np.vstack([point + steps, point - steps])), 2)
            sds = np.repeat(self.list_sds(experiment), len(experiment.times))
            slopes = (above - below) / (2 * np.diagonal(steps)[:, None]) / sds
            information = information + slopes @ slopes.T
        priors = [spread(one["prior"])[1] if "prior" in one else None for one in self.spec["parameters"].values()]
        variances = np.array([sd**2 if sd else width**2 / 12 for sd, width in zip(priors, widths)])
        return np.sqrt(np.diag(np.linalg.inv(information + np.diag(1 / variances)))).tolist()

    def simulate(self, experiment, points):
        """Precisely; where that cannot be done (one of the arm's), with the experiment's tolerances, 1e-6 sds of the noise off."""
        rows = experiment.override({**PRECISE, **self.list_noise()}).simulate(points).rows
        return rows if np.all(np.isfinite(rows)) else experiment.override(self.list_noise()).simulate(points).rows

    def list_noise(self):
        return {key: value for key, value in self.kind.truth.items() if key.startswith("noise.")}

    def list_sds(self, experiment):
        known = {key.split(".")[-1]: value for key, value in self.list_noise().items()}
        stated = self.spec["noise"]["stddev"]
        return [float(known.get(output.name, stated[output.name])) for output in experiment.outputs]
