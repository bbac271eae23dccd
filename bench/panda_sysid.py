"""The arm of bench/panda.py by mujoco.sysid: base parameters, its own intervals, and the inertias that it cannot know.

Usage: panda_sysid.py TWINMAP FOLDER [--machines N]      FOLDER: that of panda.py, with its answers
(pip install 'mujoco[sysid]' example-robot-data pin pyyaml)
mujoco.sysid gets the same tables and, beside them, exact speeds and accelerations; torques by mj_inverse, friction as
F sign(speed), since its frictionloss is soft about rest. Each link has a pseudo-inertia in the bounds that it proposes
(its parameters have bounds and no priors); friction, damping, armature and gravity have panda.py's bounds.
"""
import argparse
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import mujoco
import numpy as np
from mujoco import sysid
from panda import JOINTS, NOISE, RANGES, Arm, Study, calc_limit, calc_standard, list_links

# MuJoCo's pi: mass, first moments, tensor about the frame row by row; as calc_standard() has them.
NUMBERS = ["m", "mx", "my", "mz", "Ixx", "Ixy", "Ixz", None, "Iyy", "Iyz", None, None, "Izz"]
STEP = 1e-6


def load(urdf):
    """Without meshes, the fingers at rest."""
    tree = ElementTree.parse(urdf)
    for link in tree.findall("link"):
        for child in [*link.findall("visual"), *link.findall("collision")]:
            link.remove(child)
    for joint in tree.findall("joint"):
        if joint.get("type") == "prismatic":
            joint.set("type", "fixed")
    settings = ElementTree.SubElement(ElementTree.SubElement(tree.getroot(), "mujoco"), "compiler")
    settings.attrib.update(fusestatic="false", strippath="true")
    return mujoco.MjSpec.from_string(ElementTree.tostring(tree.getroot(), encoding="unicode"))


def set_joint(joint, attribute):
    def modify(spec, parameter):
        if attribute == "damping":  # a polynomial of the speed
            spec.joint(joint).damping[0] = parameter.value[0]
        else:
            spec.joint(joint).armature = parameter.value[0]

    return modify


def set_inertia(link):
    """As the default modifier, which leaves an orientation of NaN that the compiler of MuJoCo 4.0 refuses."""

    def modify(spec, parameter):
        sysid.apply_body_inertia(spec, link, parameter)
        spec.body(link).iquat = [1, 0, 0, 0]

    return modify


def set_gravity(spec, parameter):
    spec.option.gravity = [0, 0, -parameter.value[0]]


def make_parameters(spec, links):
    model = spec.compile()
    parameters = sysid.ParameterDict()
    for link in links:
        parameters.add(
            sysid.body_inertia_param(
                spec,
                model,
                link,
                inertia_type=sysid.InertiaType.Pseudo,
                param_name=link,
                modifier=set_inertia(link),
            )
        )
    for kind, most in RANGES.items():
        for joint in JOINTS:
            modifier = None if kind == "friction" else set_joint(joint, kind)
            parameters.add(sysid.Parameter(f"{joint}_{kind}", most / 2, 0, most, modifier=modifier))
    parameters.add(sysid.Parameter("g", 9.81, 9.78, 9.84, modifier=set_gravity))
    return parameters


class Residual:
    """Of torques along the recorded motion, in standard deviations of the noise; one row, or one a column of x."""

    def __init__(self, spec, motion, torques):
        self.spec, self.motion, self.torques = spec, motion, torques

    def calc_torques(self, parameters):
        model = sysid.apply_param_modifiers(parameters, self.spec.copy())
        data = mujoco.MjData(model)
        predicted = np.empty_like(self.torques)
        for i, (angles, speeds, accelerations) in enumerate(zip(*[one.T for one in self.motion])):
            data.qpos, data.qvel, data.qacc = angles, speeds, accelerations
            mujoco.mj_inverse(model, data)
            predicted[:, i] = data.qfrc_inverse
        friction = [parameters[f"{joint}_friction"].value[0] for joint in JOINTS]
        return predicted + np.array(friction)[:, None] * np.sign(self.motion[1])

    def __call__(self, x, parameters, **_):
        columns = x.reshape(len(x), -1)
        residuals = []
        for column in columns.T:
            parameters.update_from_vector(column)
            residuals.append(((self.calc_torques(parameters) - self.torques) / NOISE).ravel())
        return [np.array(residuals).T if x.ndim > 1 else residuals[0]], None, None


def take_standard(parameters, links):
    """As calc_standard() of twinmap's."""
    standard = {name: one.value[0] for name, one in parameters.items() if name not in links}
    for link in links:
        numbers = sysid.model_modifier.pi_from_theta(parameters[link].value)
        standard.update({f"{link}.{number}": value for number, value in zip(NUMBERS, numbers) if number})
    return standard


def calc_slopes(parameters, links, names):
    """Of the standard numbers by the parameters."""
    at = parameters.as_vector()
    slopes = []
    for i in range(len(at)):
        ends = []
        for sign in (1, -1):
            moved = at.copy()
            moved[i] += sign * STEP
            parameters.update_from_vector(moved)
            ends.append(np.array([take_standard(parameters, links)[name] for name in names]))
        slopes.append((ends[0] - ends[1]) / (2 * STEP))
    parameters.update_from_vector(at)
    return np.array(slopes).T


def find_truth(spec, parameters, truth_spec, values, links):
    truth = parameters.copy()
    for name, one in truth.items():
        one.value = (
            sysid.model_modifier.theta_inertia_from_body(truth_spec, name)
            if name in links
            else np.array([values[name]])
        )
    return truth.as_vector()


class Judged:
    def __init__(self, study, machine):
        values, urdf = study.draw(machine)
        links = list_links(values)
        spec = load(study.urdf)
        parameters = make_parameters(spec, links)
        table = np.loadtxt(study.folder / f"{machine}.csv", delimiter=",", skiprows=1).T
        residual = Residual(spec, study.motion, table[8:])
        begin = time.process_time()
        found, result = sysid.optimize(parameters, residual, verbose=False)
        self.seconds = time.process_time() - begin
        rest = residual(result.x, found)[0][0]
        self.chi_square = rest @ rest / rest.size
        covariance, intervals = sysid.calculate_intervals([rest], result.jac)
        self.judge_own(found, intervals, find_truth(spec, parameters, load(urdf), values, links), 10 * len(links))
        self.judge_base(study, machine, values, urdf, found, links, covariance)

    def judge_own(self, found, intervals, truth, inertial):
        """Its parameters, those of the inertias first: the known ones have intervals narrower than their bounds."""
        lower, upper = found.get_bounds()
        is_known = 2 * intervals < upper - lower
        self.inertias = inertial
        self.unknown_inertias = int(np.sum(~is_known[:inertial]))
        self.hold = (np.abs(found.as_vector() - truth) < intervals)[is_known]

    def judge_base(self, study, machine, values, urdf, found, links, covariance):
        limit, names = calc_limit(Arm(urdf, values["g"]), study.motion, study.parameters)
        standard, truth = take_standard(found, links), calc_standard(values)
        errors = np.array([standard[name] - truth[name] for name in names])
        slopes = calc_slopes(found, links, names)
        by_limit, by_sd = [], []
        for weights, _, _ in study.list_base(machine, names):
            along = slopes.T @ weights
            by_limit.append(weights @ errors / np.sqrt(weights @ limit @ weights))
            by_sd.append(weights @ errors / np.sqrt(max(along @ covariance @ along, 1e-300)))
        self.by_limit, self.by_sd = np.array(by_limit), np.array(by_sd)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("twinmap")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--machines", type=int, default=3)
    arguments = parser.parse_args()
    study = Study(arguments)
    print(
        "| machine | chi-square a sample | error over limit | 95 % of base parameters hold | its own 95 % intervals hold | inertias it cannot know | seconds |"
    )
    print("|--:|--:|--:|--:|--:|--:|--:|")
    for machine in range(1, arguments.machines + 1):
        one = Judged(study, machine)
        print(
            f"| {machine} | {one.chi_square:.3f} | {np.sqrt(np.mean(one.by_limit**2)):.2f} "
            f"| {np.mean(np.abs(one.by_sd) < 1.96):.2f} | {np.mean(one.hold):.2f} of {len(one.hold)} "
            f"| {one.unknown_inertias} of {one.inertias} | {one.seconds:.0f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
