"""twinmap export --urdf: the user's file with an estimate's numbers."""
import csv
import difflib
import json
import os
import re
import tempfile
import unittest
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import yaml
from support import call

ROBOTS = Path(__file__).resolve().parent / "robots"
ARM = ROBOTS / "arm.urdf"
KINDS = "inertia,armature"


def read_priors(*options):
    """The parameters that an import proposes, as an estimate would state them."""
    result = call("import", ARM, "--parameters", KINDS, *options)
    assert result.returncode == 0, result.stderr
    parameters = yaml.safe_load(result.stdout)["parameters"]
    return {
        name: (one["prior"]["normal"]["mean"], one["prior"]["normal"]["stddev"])
        for name, one in parameters.items()
        if "prior" in one
    }


def read_link(text, name):
    """(mass, centre, tensor about the centre in the link's frame)."""
    inertial = ET.fromstring(text).find(f"link[@name='{name}']/inertial")
    origin, tensor = inertial.find("origin"), inertial.find("inertia")
    roll, pitch, yaw = map(float, origin.get("rpy", "0 0 0").split()) if origin is not None else (0, 0, 0)
    turn = np.eye(3)
    for angle, (i, j) in ((yaw, (0, 1)), (pitch, (2, 0)), (roll, (1, 2))):
        step = np.eye(3)
        step[i, i] = step[j, j] = np.cos(angle)
        step[i, j], step[j, i] = -np.sin(angle), np.sin(angle)
        turn = turn @ step
    get = lambda key: float(tensor.get(key))
    own = np.array([[get(f"i{min(a, b)}{max(a, b)}") for b in "xyz"] for a in "xyz"])
    center = np.array([float(x) for x in origin.get("xyz", "0 0 0").split()]) if origin is not None else np.zeros(3)
    return float(inertial.find("mass").get("value")), center, turn @ own @ turn.T


def calc_tensor(mass, spread, skew):
    root = np.array([[spread[0], skew[0], skew[1]], [0, spread[1], skew[2]], [0, 0, spread[2]]])
    moment = mass * root @ root.T
    return np.trace(moment) * np.eye(3) - moment


class RobotExport(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write_estimate(self, values, status="ok", scale=0.01):
        names = list(values)
        covariance = [[(scale * values[a]) ** 2 if a == b else 0 for b in names] for a in names]
        parameters = {name: {"mean": value, "sd": scale * abs(value), "unit": ""} for name, value in values.items()}
        estimate = {"source": "m.csv", "status": status, "parameters": parameters, "covariance": covariance}
        file = self.folder / "estimate.json"
        file.write_text(json.dumps(estimate) + "\n")
        return file

    def export(self, estimate, *options, urdf=ARM):
        return call("export", estimate, "--urdf", urdf, "--out", self.folder / "updated.urdf", *options)

    def test_the_values_of_the_file_leave_every_byte(self):
        values = {name: mean for name, (mean, _) in read_priors().items()}
        self.assertEqual(self.export(self.write_estimate(values)).returncode, 0)
        self.assertEqual((self.folder / "updated.urdf").read_bytes(), ARM.read_bytes())

    def test_new_values_are_read_back_and_a_diff_shows_numbers_alone(self):
        values = {name: 1.01 * mean + 0.1 * sd for name, (mean, sd) in read_priors().items()}
        values.update(
            {"g": 9.8, "rail_armature": 0.3, "wrist_friction": 0.02, "wrist_damping": 0.004, "shoulder_damping": 0.9}
        )
        estimate = self.write_estimate(values)
        result = self.export(estimate)
        self.assertEqual(result.returncode, 0, result.stderr)
        text, updated = ARM.read_text(), (self.folder / "updated.urdf").read_text()
        for link in ("upper.arm", "hand", "left_finger"):
            name = link.replace(".", "_")
            get = lambda suffixes: [values[f"{name}_{suffix}"] for suffix in suffixes]
            mass, center, tensor = read_link(updated, link)
            self.assertEqual(mass, values[f"{name}_mass"])
            self.assertEqual(list(center), get(("cx", "cy", "cz")))
            expected = calc_tensor(mass, get(("lx", "ly", "lz")), get(("sxy", "sxz", "syz")))
            np.testing.assert_allclose(tensor, expected, rtol=0, atol=1e-14 * np.abs(expected).max())
        number = r"[-+]?[0-9.]+(?:e[-+]?[0-9]+)?"
        added = '\n    <dynamics damping="0.004" friction="0.02"/>'
        self.assertIn(added, updated)
        origins = re.findall(r'\n? *<origin xyz="[^"]*" rpy="0 0 0"/>', updated)
        self.assertEqual(len(origins), 2)  # of slide and sensor, whose centre the file leaves to the default
        for origin in origins:
            updated = updated.replace(origin, "")
        self.assertEqual(re.sub(number, "#", updated.replace(added, "")), re.sub(number, "#", text))
        changed = [line for line in difflib.ndiff(text.splitlines(), updated.splitlines()) if line[0] in "+-"]
        self.assertTrue(all("visual" not in line and "limit" not in line for line in changed))
        beside = json.loads((self.folder / "updated.json").read_text())
        self.assertEqual(beside["status"], "ok")
        self.assertEqual(beside["parameters"]["hand_mass"]["mean"], values["hand_mass"])
        self.assertEqual(beside["not_in_robot_file"], ["g", "rail_armature"])
        np.testing.assert_allclose(beside["correlation"], np.eye(len(values)), atol=1e-12)

    def test_what_is_not_ok_or_fits_nothing_is_refused(self):
        result = self.export(self.write_estimate({"hand_mass": 0.7}, status="at_bounds"))
        self.assertEqual(result.returncode, 2)
        self.assertIn("at_bounds", result.stderr)
        self.assertFalse((self.folder / "updated.urdf").exists())
        result = self.export(self.write_estimate({"hand_mass": 0.7}, status="at_bounds"), "--anyway")
        self.assertEqual(result.returncode, 0, result.stderr)
        result = self.export(self.write_estimate({"hand_mas": 0.7}))
        self.assertEqual(result.returncode, 2)
        self.assertIn("parameter 'hand_mas' fits nothing", result.stderr)
        self.assertIn("did you mean 'hand_mass'", result.stderr)
        self.assertEqual(self.export(self.write_estimate({"hand_mass": -0.7})).returncode, 2)
        (self.folder / "other.json").write_text("{}")
        self.assertIn("is not an estimate", self.export(self.folder / "other.json").stderr)

    def test_draws_are_robots_that_exist_and_scatter_as_the_estimate_says(self):
        values = {name: mean for name, (mean, _) in read_priors().items() if name.startswith("hand")}
        estimate = self.write_estimate(values, scale=0.2)
        result = call("export", estimate, "--urdf", ARM, "--draws", 200, self.folder / "draws")
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = list(csv.DictReader((self.folder / "draws/draws.csv").open()))
        self.assertEqual(len(rows), 200)
        masses = []
        for row in rows:
            mass, _, tensor = read_link((self.folder / "draws" / row["file"]).read_text(), "hand")
            self.assertEqual(mass, float(row["hand_mass"]))
            moments = np.linalg.eigvalsh(tensor)
            self.assertGreater(moments[0], 0)
            self.assertGreater(moments[0] + moments[1], moments[2])
            masses.append(mass)
        self.assertAlmostEqual(np.mean(masses), 0.6, delta=4 * 0.12 / 200**0.5)
        self.assertAlmostEqual(np.std(masses), 0.12, delta=4 * 0.12 / 400**0.5)
        again = call("export", estimate, "--urdf", ARM, "--draws", 200, self.folder / "again")
        self.assertEqual(again.returncode, 0)
        name = rows[7]["file"]
        self.assertEqual((self.folder / "draws" / name).read_bytes(), (self.folder / "again" / name).read_bytes())

    def test_numbers_of_an_mjcf_are_put_in_or_added_where_classes_gave_them(self):
        golden = json.loads((ROBOTS / "mjcf_golden.json").read_text())
        (self.folder / "answer.json").write_text(json.dumps(golden["compiled"]) + "\n")
        python = self.folder / "python3"
        python.write_text(f"#!/bin/sh\nread request\ncat {self.folder}/answer.json\n")
        python.chmod(0o755)
        values = {"cart_mass": 1.75, "link_lx": 0.06, "bend_damping": 0.3, "rail_armature": 0.02, "bend_friction": 0.15}
        estimate = self.write_estimate(values)
        source = (ROBOTS / "finger.xml").read_text()
        result = call("export", estimate, "--mjcf", ROBOTS / "finger.xml", "--out", self.folder / "new.xml",
                      env={**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"})  # fmt: skip
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = (self.folder / "new.xml").read_text().splitlines()
        self.assertEqual([line for line in lines if "<inertial" not in line and "<joint" not in line],
                         [line for line in source.splitlines() if "<inertial" not in line and "<joint" not in line])  # fmt: skip
        text = "\n".join(lines)
        self.assertIn('<joint armature="0.02" name="rail" type="slide"', text)
        self.assertIn(
            '<joint damping="0.3" name="bend" class="soft" axis="0 1 0" pos="0 0.01 0" frictionloss="0.15"/>', text
        )
        bodies = {body.get("name"): body for body in ET.fromstring(text).iter("body")}
        cart = bodies["cart"].find("inertial")
        self.assertEqual(cart.get("mass"), "1.75")
        self.assertEqual(cart.get("pos"), "0.01 0.02 0.03")
        self.assertIsNone(cart.get("quat"))
        self.assertIsNone(cart.get("diaginertia"))
        tensor = [float(x) for x in cart.get("fullinertia").split()]
        self.assertAlmostEqual(sum(tensor[:3]), 0.015 * 1.75 / 1.5, delta=1e-15)  # the spread is the file's
        self.assertEqual(bodies["link"].find("inertial").get("mass"), "0.4")


if __name__ == "__main__":
    unittest.main()
