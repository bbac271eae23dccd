"""twinmap import: robots' files as experiments, against Pinocchio and MuJoCo (robots/make_*_golden.py)."""
import json
import math
import os
import re
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import yaml
from support import call

ROBOTS = Path(__file__).resolve().parent / "robots"
GOLDEN = json.loads((ROBOTS / "robots_golden.json").read_text())
ARM = (ROBOTS / "arm.urdf").read_text()
MJCF_GOLDEN = json.loads((ROBOTS / "mjcf_golden.json").read_text())


def import_robot(file, *options):
    result = call("import", file, *options)
    assert result.returncode == 0, result.stderr
    return yaml.safe_load(result.stdout), result


def find_joints(experiment):
    return {body["joint"].get("name"): (name, body["joint"]) for name, body in experiment["system"]["bodies"].items()}


def set_state(experiment, state):
    """The robot's own forces and motion, without what dissipates, which Pinocchio leaves out."""
    joints = find_joints(experiment)
    coordinates = {name: joint["coordinates"][0] for name, (_, joint) in joints.items() if name in state["coordinates"]}
    initial = {"coordinates": {}, "speeds": {}}
    for name, coordinate in coordinates.items():
        initial["coordinates"][coordinate] = state["coordinates"][name]
        initial["speeds"][coordinate] = state["speeds"][name]
    for gear in [one["gear"] for one in experiment["system"].get("constraints", [])]:
        for key, offset in (("coordinates", gear["offset"]), ("speeds", 0)):
            initial[key][gear["coordinate"]] = gear["ratio"] * initial[key][gear["driver"]] + offset
    if "base" in state:
        base = next(
            body["joint"] for body in experiment["system"]["bodies"].values() if body["joint"]["type"] == "free"
        )
        initial["coordinates"].update(zip(base["coordinates"], state["base"]))
        initial["speeds"].update(zip(base["coordinates"], state["base_rates"]))
    experiment["initial"] = initial
    for law in experiment["system"]["force_laws"]:
        name = next(name for name, coordinate in coordinates.items() if coordinate == law["coordinate"])
        law["force"] = repr(state["forces"][name])
    del experiment["excitation"]
    experiment["system"].pop("friction", None)
    experiment["system"].pop("dampers", None)
    return coordinates


def calc_accelerations(experiment, state, folder):
    coordinates = set_state(experiment, state)
    types = {
        joint["coordinates"][0]: joint["type"]
        for _, joint in find_joints(experiment).values()
        if "coordinates" in joint
    }
    outputs = {
        name: {"expression": f"{coordinate}_ddot", "unit": "m/s2" if types[coordinate] == "slider" else "rad/s2"}
        for name, coordinate in coordinates.items()
    }
    for axis in range(3 if "base" in state else 0):
        direction = [int(axis == i) for i in range(3)]
        outputs[f"force_{axis}"] = {"specific_force": {"body": "trunk", "direction": direction}}
    experiment["outputs"] = outputs
    experiment["features"] = [{"samples": {"outputs": list(outputs), "start": 0, "interval": 0.01, "count": 1}}]
    experiment["noise"] = {"stddev": dict.fromkeys(outputs, 1)}
    file = folder / "robot.yaml"
    file.write_text(yaml.safe_dump(experiment, sort_keys=False))
    result = call("simulate", file)
    assert result.returncode == 0, result.stderr
    names, values = result.stdout.splitlines()[:2]
    return dict(zip(names.split(","), map(float, values.split(","))))


class Import(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def refuse(self, text, *options):
        """(line, message) of the refusal."""
        file = self.folder / "robot.urdf"
        file.write_text(text)
        result = call("import", file, *options)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stdout, "")
        message = result.stderr.splitlines()[-1]
        line = re.search(r"robot\.urdf:(\d+)", message)
        return int(line.group(1)) if line else 0, message

    def find_line(self, text, what):
        return 1 + text[: text.index(what)].count("\n")

    def check_accelerations(self, name, *options, armature=False):
        for state in GOLDEN[name]:
            experiment, _ = import_robot(ROBOTS / f"{name}.urdf", *options)
            if armature:
                joints = find_joints(experiment)
                experiment["system"]["armature"] = [
                    {"coordinate": joints[joint][1]["coordinates"][0], "inertia": inertia}
                    for joint, inertia in GOLDEN["armature"].items()
                ]
            found = calc_accelerations(experiment, state, self.folder)
            expected = dict(state["accelerations"])
            expected.update({f"force_{i}": value for i, value in enumerate(state.get("specific_force", []))})
            largest = max(map(abs, expected.values()))
            for key, value in expected.items():
                self.assertAlmostEqual(found[key], value, delta=1e-9 * largest, msg=key)

    def test_accelerations_are_those_of_pinocchio_with_mimic_joints_and_armature(self):
        self.check_accelerations("arm", armature=True)

    def test_accelerations_of_a_free_base_are_those_of_pinocchio(self):
        self.check_accelerations("walker", "--base", "free")

    def test_forces_of_a_recorded_motion_are_those_of_pinocchio(self):
        for state in GOLDEN["arm"]:
            experiment, _ = import_robot(ROBOTS / "arm.urdf", "--from-motion")
            system = experiment["system"]
            system["armature"] = [
                {"coordinate": joint, "inertia": inertia} for joint, inertia in GOLDEN["armature"].items()
            ]
            times = [0.05 * k for k in range(8)]
            for motion in system["motions"]:
                q, v, a = (state[key][motion["coordinate"]] for key in ("coordinates", "speeds", "accelerations"))
                table = {
                    "times": times,
                    "values": [q + v * t + a * t**2 / 2 for t in times],
                    "interpolation": "cubic",
                }
                experiment["excitation"][motion["follows"]] = {"unit": "1", "tables": [table]}
            for signal in experiment["excitation"].values():
                signal.pop("unit")
            experiment["simulation"] = {"duration": times[-1]}
            experiment["features"][0]["samples"].update(interval=0.05, count=2)
            experiment["noise"] = {"stddev": dict.fromkeys(experiment["outputs"], 1)}
            file = self.folder / "robot.yaml"
            file.write_text(yaml.safe_dump(experiment, sort_keys=False))
            result = call("simulate", file)
            self.assertEqual(result.returncode, 0, result.stderr)
            names, values = result.stdout.splitlines()[:2]
            found = dict(zip(names.split(","), map(float, values.split(","))))
            expected = dict(state["forces"])
            speed = state["speeds"]["shoulder"]  # what the URDF says of its losses
            expected["shoulder"] += 0.7 * speed + math.copysign(0.3, speed)
            self.assertEqual({name.rsplit("_", 1)[0] for name in found} - {"t"}, set(expected))
            for joint, value in expected.items():
                output = f"{joint}_force" if joint in ("rail", "left") else f"{joint}_torque"
                self.assertAlmostEqual(found[output], value, delta=1e-9 * max(map(abs, expected.values())), msg=joint)

    def test_the_motion_of_a_free_base_is_no_recording_of_joints(self):
        result = call("import", ROBOTS / "walker.urdf", "--base", "free", "--from-motion")
        self.assertEqual(result.returncode, 2)
        self.assertRegex(result.stderr, r"walker\.urdf:\d+: link 'trunk' flies.*leave --from-motion out")

    def test_what_is_left_out_is_named_with_its_lines_and_is_an_error_where_that_is_asked_for(self):
        _, result = import_robot(ROBOTS / "arm.urdf")
        for what in ("<collision>", "<transmission>", "<material>", "limit effort", "<link> without mass"):
            line = next(line for line in result.stderr.splitlines() if f": {what}: " in line)
            self.assertIn("#   " + line.removeprefix(f"not carried over: {ROBOTS / 'arm.urdf'}:"), result.stdout)
        self.assertIn(f"arm.urdf:{self.find_line(ARM, '<collision>')}: <collision>", result.stderr)
        strict = call("import", ROBOTS / "arm.urdf", "--strict")
        self.assertEqual((strict.returncode, strict.stdout), (2, ""))

    def test_what_is_visual_becomes_shapes_of_the_body_that_it_moves_with(self):
        file = self.folder / "robot.urdf"
        more = (
            '<visual><origin xyz="0 0 1" rpy="0 0 1.5"/><geometry><mesh filename="parts/a b.stl" scale="1 1 2"/>'
            '</geometry></visual><visual><geometry><sphere radius="0"/></geometry></visual><visual><geometry>'
            '<cylinder radius="0.1" length="0.3"/></geometry></visual><visual>'
        )
        file.write_text(ARM.replace("<visual>", more, 1))
        experiment, result = import_robot(file)
        shapes = next(body["shapes"] for body in experiment["system"]["bodies"].values() if "shapes" in body)
        self.assertEqual(
            [set(shape) - {"point", "orientation", "scale"} for shape in shapes], [{"mesh"}, {"cylinder"}, {"box"}]
        )
        self.assertEqual(shapes[0]["mesh"], str(self.folder / "parts/a b.stl"))
        self.assertEqual((shapes[0]["scale"], shapes[0]["point"]), ([1, 1, 2], [0, 0, 1]))
        self.assertAlmostEqual(shapes[0]["orientation"][2], 1.5, delta=1e-12)
        self.assertEqual(shapes[1]["cylinder"], {"radius": 0.1, "length": 0.3})
        self.assertIn(": <visual> without a shape: ", result.stderr)

    def test_a_mesh_in_a_package_is_found_above_the_robot_or_where_ros_says(self):
        file, mesh = self.folder / "arm_description/urdf/robot.urdf", "package://arm_description/meshes/a.dae"
        file.parent.mkdir(parents=True)
        visual = f'<visual><geometry><mesh filename="{mesh}"/></geometry></visual><visual>'
        file.write_text(ARM.replace("<visual>", visual, 1))
        elsewhere = self.folder / "ws/arm_description/meshes/a.dae"
        beside = self.folder / "arm_description/meshes/a.dae"
        for place, ros in ((None, ""), (elsewhere, "/none:" + str(self.folder / "ws")), (beside, "")):
            if place:
                place.parent.mkdir(parents=True)
                place.write_text("")
            with mock.patch.dict(os.environ, {"ROS_PACKAGE_PATH": ros}):
                experiment, result = import_robot(file)
            shapes = next(body["shapes"] for body in experiment["system"]["bodies"].values() if "shapes" in body)
            self.assertEqual(shapes[0]["mesh"], str(place or mesh))
            self.assertEqual(": package://: a mesh in a package of ROS that is not found" in result.stderr, not place)

    def test_what_is_not_of_urdf_is_named(self):
        file = self.folder / "robot.urdf"
        file.write_text(
            ARM.replace("<visual>", '<shape colour="blue"/><visual>').replace('name="rail"', 'name="rail" odd="1"')
        )
        _, result = import_robot(file)
        self.assertIn(": <shape>: is not of URDF", result.stderr)
        self.assertIn(": joint odd: is not of URDF", result.stderr)

    def test_limits_become_stops_losses_stay_and_chosen_joints_move(self):
        system = import_robot(ROBOTS / "arm.urdf", "--stops")[0]["system"]
        self.assertIn({"coordinate": "shoulder", "above": 2.5, "restitution": 0}, system["stops"])
        self.assertEqual(system["dampers"], [{"coordinate": "shoulder", "damping": 0.7}])
        self.assertEqual(system["friction"], [{"coordinate": "shoulder", "model": "coulomb", "coulomb": 0.3}])
        experiment, _ = import_robot(ROBOTS / "arm.urdf", "--joints", "shoulder,rail")
        self.assertEqual(list(experiment["outputs"]), ["shoulder", "rail"])

    def test_chosen_parameters_have_the_files_values_amid_their_bounds(self):
        plain, _ = import_robot(ROBOTS / "arm.urdf")
        file = self.folder / "robot.yaml"
        file.write_text(call("import", ROBOTS / "arm.urdf", "--parameters", "inertia,friction,armature,damping",
                             "--joints", "shoulder,rail").stdout)  # fmt: skip
        chosen = yaml.safe_load(file.read_text())
        self.assertEqual(call("check", file).returncode, 0)
        parameters = chosen["parameters"]
        self.assertEqual(parameters["upper_arm_mass"]["prior"]["normal"], {"mean": 2.5, "stddev": 0.5})
        self.assertEqual(parameters["shoulder_damping"]["prior"]["normal"]["mean"], 0.7)
        self.assertEqual(parameters["rail_friction"]["bounds"], [0, 100])  # its effort
        self.assertEqual(parameters["rail_damping"]["bounds"], [0, 100])  # effort / velocity
        self.assertEqual(parameters["rail_armature"]["bounds"], [0, 0.8])  # the mass that it moves
        names = {
            name: parameter["prior"]["normal"]["mean"] for name, parameter in parameters.items() if "prior" in parameter
        }
        spread = [names[f"upper_arm_l{axis}"] for axis in "xyz"]
        skew = [names[f"upper_arm_s{axes}"] for axes in ("xy", "xz", "yz")]
        root = [[spread[0], skew[0], skew[1]], [0, spread[1], skew[2]], [0, 0, spread[2]]]
        moment = [[2.5 * sum(a * b for a, b in zip(x, y)) for y in root] for x in root]
        inertia = plain["system"]["bodies"]["upper_arm"]["inertia"]
        trace = sum(moment[i][i] for i in range(3))
        for i in range(3):
            self.assertAlmostEqual(trace - moment[i][i], inertia["moments"][i], delta=1e-15)
        for value, (i, j) in zip(inertia["products"], ((0, 1), (0, 2), (1, 2))):
            self.assertAlmostEqual(-moment[i][j], value, delta=1e-15)

    def test_wrong_files_are_refused_with_line_and_remedy(self):
        finger = ARM[ARM.index('<link name="left_finger">') :]
        finger = finger[: finger.index("</inertial>") + len("</inertial>")]
        cases = (
            (ARM.replace(finger, '<link name="left_finger">'), '<link name="left_finger">', "give it <inertial>"),
            (ARM.replace('<axis xyz="0 1 0"/>', '<axis xyz="0 1 0"/><mimic joint="right"/>'),
             '<mimic joint="right"/>', "leave one <mimic> out"),
            (ARM.replace('<transmission name="drive">', '<xacro:drive/><transmission name="drive">'),
             "<xacro:drive/>", "xacro robot.urdf.xacro > robot.urdf"),
            (ARM.replace('<mass value="0.8"/>', '<mass value="${m}"/>'), '<mass value="${m}"/>', "xacro robot.urdf.xacro >"),
            (ARM.replace('<mass value="0.8"/>', '<mass value="heavy"/>'), '<mass value="heavy"/>', "must hold numbers"),
            (ARM.replace('<parent link="slide"/>', '<parent link="slid"/>'), '<joint name="wrist" ', "has no link 'slid'"),
            (ARM.replace('<child link="slide"/>', '<child link="hand"/>'), '<joint name="wrist_hand"', "two joints to parents"),
            (ARM.replace('<axis xyz="0.2 1 -0.3"/>', '<axis xyz="0 0 0"/>'), '<axis xyz="0 0 0"/>', "must not be zero"),
            (ARM.replace('ixy="0.0001"', "").replace('ixy="1e-4"', ""), '<inertia ixx="0.0012"', "needs the attribute 'ixy'"),
        )  # fmt: skip
        for text, place, remedy in cases:
            line, message = self.refuse(text)
            self.assertEqual(line, self.find_line(text, place), message)
            self.assertIn(remedy, message)
        line, message = self.refuse(ARM.replace("</robot>", "</robo>"))
        self.assertEqual(line, ARM.rstrip().count("\n") + 1, message)
        self.assertIn("is not XML", message)
        line, message = self.refuse(ARM.replace('<link name="hand"', '<link name="ha\x01nd"', 1))
        self.assertEqual(line, self.find_line(ARM, '<link name="hand"'), message)
        self.assertIn("not text in UTF-8", message)
        self.assertIn("has no joint 'elbow'", self.refuse(ARM, "--joints", "elbow")[1])

    def test_an_inertia_that_no_body_has_is_named_and_taken_as_it_is(self):
        text = ARM.replace('ixx="0.002" ixy="0" ixz="0" iyy="0.002" iyz="0" izz="0.001"',
                           'ixx="0.002" ixy="0" ixz="0" iyy="0.002" iyz="0" izz="0.005"')  # fmt: skip
        file = self.folder / "robot.urdf"
        file.write_text(text)
        experiment, result = import_robot(file)
        line = self.find_line(text, 'izz="0.005"')
        self.assertRegex(result.stderr, rf"robot\.urdf:{line}: inertia of link 'slide': its largest principal moment")
        self.assertTrue(experiment["system"]["bodies"]["slide"]["inertia"]["unchecked"])
        (self.folder / "robot.yaml").write_text(result.stdout)
        self.assertEqual(call("simulate", self.folder / "robot.yaml").returncode, 0)

    def test_a_recordings_columns_become_the_measurement_and_the_excitation(self):
        recording = self.folder / "recording.csv"
        rows = "".join(f"{100 + 20 * k},{k},{2 * k},0.5,7\n" for k in range(51))
        recording.write_text("t [ms],shoulder [deg],shoulder_torque,rail,temperature\n" + rows)
        result = call("import", ROBOTS / "arm.urdf", "--csv", recording)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("column 'temperature' of", result.stderr)
        experiment = yaml.safe_load(result.stdout)
        measurement = experiment["measurement"]
        self.assertEqual(measurement["columns"], {"shoulder": "shoulder [deg]", "rail": "rail"})
        self.assertEqual((measurement["time"], measurement["start"]), ("t [ms]", 0.1))
        samples = experiment["features"][0]["samples"]
        self.assertEqual(samples, {"outputs": ["shoulder", "rail"], "start": 0, "interval": 0.02, "count": 51})
        self.assertEqual(experiment["simulation"], {"duration": 1})
        measured = experiment["excitation"]["shoulder_torque"]["tables"][0]["measured"]
        self.assertEqual((measured["column"], measured["start"]), ("shoulder_torque", 0.1))
        (self.folder / "robot.yaml").write_text(result.stdout)
        checked = call("check", self.folder / "robot.yaml", "--svg", self.folder / "robot.svg")
        self.assertEqual(checked.returncode, 0, checked.stderr)
        self.assertIn("<ellipse", (self.folder / "robot.svg").read_text())
        recording.write_text("t,a\n0,1\n1,2\n")
        self.assertIn("no column is called as a joint", call("import", ROBOTS / "arm.urdf", "--csv", recording).stderr)

    def test_a_link_without_mass_between_joints_is_a_frame_that_carries_others(self):
        chain = ROBOTS.joinpath("walker.urdf").read_text()
        start = chain.index("<inertial>", chain.index('name="hip"'))
        chain = chain[:start] + chain[chain.index("</inertial>", start) + len("</inertial>") :]
        file = self.folder / "robot.urdf"
        file.write_text(chain)
        experiment, _ = import_robot(file)
        hip = experiment["system"]["bodies"]["hip"]
        self.assertEqual((hip["mass"], hip["massless"]), (0, True))
        (self.folder / "robot.yaml").write_text(call("import", file).stdout)
        self.assertEqual(call("check", self.folder / "robot.yaml").returncode, 0)  # compared with Simbody


class Mjcf(unittest.TestCase):
    """What MuJoCo compiles is in the golden: in place of Python stands a program that prints it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def import_with(self, answer, *options, file=ROBOTS / "finger.xml"):
        (self.folder / "answer.json").write_text(json.dumps(answer) + "\n")
        python = self.folder / "python3"
        python.write_text(f"#!/bin/sh\nread request\ncat {self.folder}/answer.json\n")
        python.chmod(0o755)
        return call("import", file, *options, env={**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"})

    def test_accelerations_are_those_of_mujoco(self):
        for state in MJCF_GOLDEN["states"]:
            result = self.import_with(MJCF_GOLDEN["compiled"])
            self.assertEqual(result.returncode, 0, result.stderr)
            experiment = yaml.safe_load(result.stdout)
            system = experiment["system"]
            del system["friction"]
            base = system["bodies"]["ball"]["joint"]["coordinates"]
            experiment["initial"] = {
                "coordinates": {**state["coordinates"], **dict(zip(base, state["base"]))},
                "speeds": {**state["speeds"], **dict(zip(base, state["base_rates"]))},
            }
            for name, value in state["controls"].items():
                experiment["excitation"][name]["pulses"][0]["amplitude"] = value
            units = {"rail": "m/s2", "swivel": "rad/s2", "bend": "rad/s2"}
            outputs = {name: {"expression": f"{name}_ddot", "unit": unit} for name, unit in units.items()}
            for axis in range(3):
                direction = [int(axis == i) for i in range(3)]
                outputs[f"force_{axis}"] = {"specific_force": {"body": "ball", "direction": direction}}
            experiment["outputs"] = outputs
            experiment["features"] = [{"samples": {"outputs": list(outputs), "start": 0, "interval": 0.01, "count": 1}}]
            experiment["noise"] = {"stddev": dict.fromkeys(outputs, 1)}
            (self.folder / "robot.yaml").write_text(yaml.safe_dump(experiment, sort_keys=False))
            simulated = call("simulate", self.folder / "robot.yaml")
            self.assertEqual(simulated.returncode, 0, simulated.stderr)
            names, values = simulated.stdout.splitlines()[:2]
            found = dict(zip(names.split(","), map(float, values.split(","))))
            expected = {**state["accelerations"], **{f"force_{i}": x for i, x in enumerate(state["specific_force"])}}
            largest = max(map(abs, expected.values()))
            for key, value in expected.items():
                self.assertAlmostEqual(found[key], value, delta=1e-9 * largest, msg=key)

    def test_what_is_left_out_is_named(self):
        result = self.import_with(MJCF_GOLDEN["compiled"], "--parameters", "armature,damping", "--joints", "rail,bend")
        self.assertEqual(result.returncode, 0, result.stderr)
        for what in ("10, 17, 19, 25: <geom>", "32: <sensor>", "16: solref of frictionloss"):
            self.assertIn(f"finger.xml:{what}", result.stderr)
        parameters = yaml.safe_load(result.stdout)["parameters"]
        self.assertEqual(parameters["bend_armature"]["prior"]["normal"], {"mean": 0.01, "stddev": 0.002})

    def test_geoms_become_shapes(self):
        bodies = yaml.safe_load(self.import_with(MJCF_GOLDEN["compiled"]).stdout)["system"]["bodies"]
        self.assertEqual(bodies["ball"]["shapes"], [{"box": [0.1, 0.12, 0.14]}])  # half of that in MJCF
        self.assertEqual(bodies["tip"]["shapes"], [{"sphere": 0.03}])
        (capsule,) = bodies["link"]["shapes"]  # from 0 0 0 to 0.2 0 0.02
        self.assertAlmostEqual(capsule["capsule"]["length"], (0.2**2 + 0.02**2) ** 0.5, delta=1e-12)
        self.assertEqual(capsule["point"], [0.1, 0, 0.01])

    def test_messages_name_what_is_missing(self):
        for answer, message in (
            ({"missing": True}, "pip install mujoco"),
            ({"error": "Error: unknown element 'bod'"}, "MuJoCo does not compile it: Error: unknown element 'bod'"),
            ({"bodies": []}, "what MuJoCo made of it cannot be read"),
        ):
            result = self.import_with(answer)
            self.assertEqual((result.returncode, result.stdout), (2, ""))
            self.assertIn(message, result.stderr)
        self.assertIn("freejoint", self.import_with(MJCF_GOLDEN["compiled"], "--base", "free").stderr)


if __name__ == "__main__":
    unittest.main()
