"""Base parameters of the arm of example-robot-data (panda): twinmap's error over the information limit, and coverage.

Usage: panda.py TWINMAP FOLDER [--machines N]      (pip install example-robot-data pin pyyaml)
Machines whose seven inertias are drawn from priors of 20 % about the URDF, with armature, viscous and Coulomb friction on
each joint, move through 20 s of sines. Pinocchio gives the torques; noise is added, twinmap infers from the table. The base
parameters are those that it names; their limit comes from Pinocchio's regressor and the priors. A machine that FOLDER has
an answer of is not inferred again.
"""
import argparse
import json
import os
import re
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pinocchio
import yaml

JOINTS = [f"panda_joint{i}" for i in range(1, 8)]
LOWER = np.array([-2.9, -1.76, -2.9, -3.07, -2.9, -0.02, -2.9])
UPPER = np.array([2.9, 1.76, 2.9, -0.07, 2.9, 3.75, 2.9])
FREQUENCIES = np.array([0.1, 0.2, 0.3, 0.4, 0.5])  # Hz
DURATION, INTERVAL = 20.0, 0.01  # s
NOISE = 0.05  # N m
# What an engineer who reads the drives' data sheet would write in place of the limits that a URDF gives.
RANGES = {"friction": 2.0, "damping": 2.0, "armature": 0.2}  # N m, N m s/rad, kg m2
NUMBERS = ["m", "mx", "my", "mz", "Ixx", "Ixy", "Iyy", "Ixz", "Iyz", "Izz"]  # as Pinocchio has them
KINDS = ["mass", "cx", "cy", "cz", "lx", "ly", "lz", "sxy", "sxz", "syz"]


def find_urdf():
    root = Path(pinocchio.__file__).parents[4]
    return next(root.glob("**/example-robot-data/robots/panda_description/urdf/panda.urdf"))


def move():
    """Times, and angles, speeds and accelerations (7 x times): the same sines for all machines."""
    rng = np.random.default_rng(0)
    times = np.arange(round(DURATION / INTERVAL) + 1) * INTERVAL
    amplitudes = rng.uniform(0.3, 1, (7, 5))
    amplitudes *= 0.3 * (UPPER - LOWER)[:, None] / amplitudes.sum(axis=1, keepdims=True)
    phases = rng.uniform(0, 2 * np.pi, (7, 5))
    rates = 2 * np.pi * FREQUENCIES
    angles = rates[:, None] * times + phases[..., None]
    total = lambda values: (amplitudes[..., None] * values).sum(axis=1)
    return (
        times,
        (LOWER + UPPER)[:, None] / 2 + total(np.sin(angles)),
        total(rates[:, None] * np.cos(angles)),
        total(-(rates[:, None] ** 2) * np.sin(angles)),
    )


def write_table(file, times, angles, torques):
    names = ["t", *JOINTS, *[f"{joint}_torque" for joint in JOINTS]]
    np.savetxt(file, np.vstack([times, angles, torques]).T, delimiter=",", header=",".join(names), comments="")


def write_experiment(twinmap, urdf, folder, table):
    """As a user would: imported, with ranges of friction, damping and armature, and the noise of the torques."""
    text = subprocess.run(
        [twinmap, "import", urdf, "--from-motion", "--joints", ",".join(JOINTS), "--csv", table]
        + ["--parameters", "inertia,friction,armature,damping"],
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    for kind, most in RANGES.items():
        text = re.sub(rf"(_{kind}): {{.*?, unit", rf"\1: {{bounds: [0, {most}], unit", text)
    file = folder / "panda.yaml"
    file.write_text(text.replace("unknown", str(NOISE)))
    return file


def draw_machine(parameters, rng):
    """One value a parameter, from its prior within its bounds."""
    values = {}
    for name, spec in parameters.items():
        lower, upper = spec["bounds"]
        value = rng.uniform(lower, upper)
        if "prior" in spec:
            prior = spec["prior"]["normal"]
            value = np.inf
            while not lower < value < upper:
                value = rng.normal(prior["mean"], prior["stddev"])
        values[name] = value
    return values


def calc_inertia(values, link):
    """Mass, centre, and the tensor about it."""
    mass, cx, cy, cz, lx, ly, lz, sxy, sxz, syz = (values[f"{link}_{kind}"] for kind in KINDS)
    root = np.array([[lx, sxy, sxz], [0, ly, syz], [0, 0, lz]])
    second = mass * root @ root.T
    return mass, np.array([cx, cy, cz]), np.trace(second) * np.eye(3) - second


def write_urdf(urdf, file, values):
    tree = ElementTree.parse(urdf)
    for link in tree.findall("link"):
        if f"{link.get('name')}_mass" in values:
            mass, center, tensor = calc_inertia(values, link.get("name"))
            inertial = link.find("inertial")
            inertial.find("mass").set("value", repr(float(mass)))
            inertial.find("origin").attrib.update(xyz=" ".join(map(repr, center.tolist())), rpy="0 0 0")
            for name, (i, j) in {
                "ixx": (0, 0),
                "ixy": (0, 1),
                "ixz": (0, 2),
                "iyy": (1, 1),
                "iyz": (1, 2),
                "izz": (2, 2),
            }.items():
                inertial.find("inertia").set(name, repr(float(tensor[i, j])))
    tree.write(file)


class Arm:
    """By Pinocchio, the fingers at rest."""

    def __init__(self, file, gravity):
        whole = pinocchio.buildModelFromUrdf(str(file))
        fingers = [whole.getJointId(name) for name in whole.names if "finger" in name]
        self.model = pinocchio.buildReducedModel(whole, fingers, pinocchio.neutral(whole))
        self.model.gravity.linear[:] = [0, 0, -gravity]
        self.data = self.model.createData()

    def carry(self, link):
        """Joint that carries a link, and the ten numbers of the joint's body by the ten of the link."""
        frame = self.model.frames[self.model.getFrameId(link, pinocchio.FrameType.BODY)]
        columns = []
        for unit in np.eye(10):
            # a sum of two bodies that exist: unit + 1e3 times one, less that one
            body = 1e3 * np.array([1, 0, 0, 0, 1, 0, 1, 0, 0, 1])
            turn = lambda numbers: frame.placement.act(
                pinocchio.Inertia.FromDynamicParameters(numbers)
            ).toDynamicParameters()
            columns.append(turn(body + unit) - turn(body))
        return frame.parentJoint - 1, np.array(columns).T

    def calc_torques(self, motion, values):
        angles, speeds, accelerations = motion
        torques = np.array(
            [pinocchio.rnea(self.model, self.data, *one) for one in zip(angles.T, speeds.T, accelerations.T)]
        ).T
        for i, joint in enumerate(JOINTS):
            torques[i] += values[f"{joint}_friction"] * np.sign(speeds[i]) + values[f"{joint}_damping"] * speeds[i]
            torques[i] += values[f"{joint}_armature"] * accelerations[i]
        return torques

    def calc_information(self, motion, links):
        """Of the links' ten numbers each, friction, damping and armature of each joint, and gravity; with their names."""
        carried = [self.carry(link) for link in links]
        count = 10 * len(links) + 3 * len(JOINTS) + 1
        information = np.zeros((count, count))
        for q, v, a in zip(*[one.T for one in motion]):
            regressor = pinocchio.computeJointTorqueRegressor(self.model, self.data, q, v, a)
            weight = pinocchio.computeGeneralizedGravity(self.model, self.data, q) / -self.model.gravity.linear[2]
            rows = [regressor[:, 10 * joint : 10 * joint + 10] @ numbers for joint, numbers in carried]
            rows = np.hstack([*rows, np.diag(np.sign(v)), np.diag(v), np.diag(a), weight[:, None]])
            information += rows.T @ rows / NOISE**2
        names = [f"{link}.{number}" for link in links for number in NUMBERS]
        names += [f"{joint}_{kind}" for kind in ("friction", "damping", "armature") for joint in JOINTS]
        return information, [*names, "g"]


def list_links(parameters):
    return [name.removesuffix("_mass") for name in parameters if name.endswith("_mass")]


def calc_standard(values):
    """What torques are linear in, by the names of twinmap's terms."""
    standard = dict(values)
    for link in list_links(values):
        mass, center, tensor = calc_inertia(values, link)
        tensor = tensor + mass * (center @ center * np.eye(3) - np.outer(center, center))
        about = [tensor[i, j] for i, j in ((0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2))]
        standard.update(zip((f"{link}.{number}" for number in NUMBERS), [mass, *(mass * center), *about]))
    return standard


def calc_limit(arm, motion, parameters):
    """Covariance of the standard numbers that the torques and the priors leave, with their names."""
    links = list_links(parameters)
    information, names = arm.calc_information(motion, links)
    rng = np.random.default_rng(2)
    drawn = [calc_standard(draw_machine(parameters, rng)) for _ in range(4000)]
    values = np.array([[one[name] for name in names] for one in drawn])
    for k in range(len(links)):  # bodies are independent of each other
        own = slice(10 * k, 10 * k + 10)
        information[own, own] += np.linalg.inv(np.cov(values[:, own].T))
    for k in range(10 * len(links), len(names)):
        information[k, k] += 1 / np.var(values[:, k])
    return np.linalg.inv(information), names


class Study:
    def __init__(self, arguments):
        self.twinmap, self.folder = arguments.twinmap, arguments.folder
        self.folder.mkdir(parents=True, exist_ok=True)
        self.urdf = find_urdf()
        self.times, *self.motion = move()
        table = self.folder / "motion.csv"
        write_table(table, self.times, self.motion[0], np.zeros_like(self.motion[0]))
        self.experiment = write_experiment(self.twinmap, self.urdf, self.folder, table)
        self.parameters = yaml.safe_load(self.experiment.read_text())["parameters"]

    def draw(self, machine):
        """Truth and its table."""
        rng = np.random.default_rng([1, machine])
        values = draw_machine(self.parameters, rng)
        file = self.folder / f"truth_{machine}.urdf"
        write_urdf(self.urdf, file, values)
        torques = Arm(file, values["g"]).calc_torques(self.motion, values)
        write_table(
            self.folder / f"{machine}.csv",
            self.times,
            self.motion[0],
            torques + NOISE * rng.standard_normal(torques.shape),
        )
        return values, file

    def infer(self, machine):
        """The answer, its seconds of a processor and the largest memory in MB."""
        file = self.folder / f"{machine}.json"
        if not file.exists():
            command = [self.twinmap, "infer", self.experiment, self.folder / f"{machine}.csv", "--json"]
            with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as process:
                answer = json.loads(process.stdout.read())
                _, _, usage = os.wait4(process.pid, 0)
            answer["seconds"] = usage.ru_utime + usage.ru_stime
            answer["megabytes"] = usage.ru_maxrss / 1024
            file.write_text(json.dumps(answer))
        return json.loads(file.read_text())

    def list_base(self, machine, names):
        """Of each base parameter that is named: its weights of the standard numbers, mean and sd."""
        base = []
        for one in self.infer(machine).get("identified", []):
            weights = np.zeros(len(names))
            for term in one["terms"]:
                weights[names.index(term["of"])] = term["coefficient"]
            base.append((weights, one["mean"], one["sd"]))
        return base

    def judge(self, machine):
        """Errors of the base parameters over their sds and over the limit's."""
        values, truth = self.draw(machine)
        covariance, names = calc_limit(Arm(truth, values["g"]), self.motion, self.parameters)
        standard = calc_standard(values)
        exact = np.array([standard[name] for name in names])
        base = self.list_base(machine, names)
        errors = np.array([mean - weights @ exact for weights, mean, _ in base])
        sds = np.array([sd for _, _, sd in base])
        limits = np.array([np.sqrt(weights @ covariance @ weights) for weights, _, _ in base])
        return errors / sds, errors / limits


def calc_share(one_by_one):
    """A share over machines, and its standard error from their scatter."""
    shares = np.array([np.mean(one) for one in one_by_one])
    return f"{shares.mean():.3f} +- {shares.std(ddof=1) / np.sqrt(len(shares)):.3f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("twinmap")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--machines", type=int, default=100)
    arguments = parser.parse_args()
    study = Study(arguments)
    print("| machine | status | base parameters | error over limit | 95 % hold | 50 % hold | s | MB |")
    print("|--:|---|--:|--:|--:|--:|--:|--:|")
    squares, holds, halves, times = [], [], [], []
    for machine in range(1, arguments.machines + 1):
        by_sd, by_limit = study.judge(machine)
        answer = study.infer(machine)
        times.append(answer["seconds"])
        row = f"| {machine} | {answer['status']} | {len(by_sd)}"
        if len(by_sd) > 0:
            squares.append(by_limit**2)
            holds.append(np.abs(by_sd) < 1.96)
            halves.append(np.abs(by_sd) < 0.674)
            row += f" | {np.sqrt(squares[-1].mean()):.2f} | {holds[-1].mean():.2f} | {halves[-1].mean():.2f}"
        else:
            row += " | - | - | -"
        print(f"{row} | {answer['seconds']:.0f} | {answer['megabytes']:.0f} |", flush=True)
    print(
        f"| all | | {sum(map(len, holds))} | {np.sqrt(np.mean(np.concatenate(squares))):.3f} "
        f"| {calc_share(holds)} | {calc_share(halves)} | {np.mean(times):.0f} | |"
    )


if __name__ == "__main__":
    main()
