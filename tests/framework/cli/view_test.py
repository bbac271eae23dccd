"""twinmap view: the page and the picture of a mechanism."""
import json
import re
import tempfile
import unittest
import xml.etree.ElementTree as ET
from math import cos, sin
from pathlib import Path

from support import EXPERIMENTS, call

SVG = "{http://www.w3.org/2000/svg}"
PENDULUM = """
name: pen<du>lum
parameters: {g: {bounds: [9, 10], unit: m/s2}}
system:
  gravity: [0, 0, -g]
  bodies:
    arm:
      mass: 2
      center_of_mass: [0, 0, -0.5]
      inertia: {moments: [0.2, 0.3, 0.25]}
      joint: {type: pin, axis: [0, 1, 0], coordinates: [q], in_parent: {point: [0.1, 0, 1]}}
    bob:
      mass: 1
      joint: {type: weld, parent: arm, in_parent: {point: [0, 0, -1]}}
  two_point_springs: [{from: {body: ground}, to: {body: bob}, stiffness: 3, rest_length: 0.2}]
initial: {coordinates: {q: 0.4}}
outputs: {q: {coordinate: q}, x: {position: {body: bob, direction: [1, 0, 0]}}}
simulation: {duration: 2}
features: [{samples: {outputs: [q, x], start: 0, interval: 0.01, count: 201}}]
noise: {stddev: {q: 1e-3, x: 1e-3}}
"""


def read_scene(page):
    text = re.search(r'<script type="application/json" id="scene">(.*?)</script>', page, re.DOTALL).group(1)
    return json.loads(text.replace("<\\/", "</"))


class View(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.file = self.folder / "pendulum.yaml"
        self.file.write_text(PENDULUM.replace("pen<du>lum", "pendulum"))

    def view(self, *options):
        result = call(
            "view", self.file, "--out", self.folder / "page.html", "--svg", self.folder / "picture.svg", *options
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        return (self.folder / "page.html").read_text(), (self.folder / "picture.svg").read_text()

    def test_poses_are_those_of_the_model_at_all_times(self):
        scene = read_scene(self.view()[0])
        rows = call("simulate", self.file).stdout.splitlines()[1:]
        self.assertEqual(len(scene["times"]), 201)
        poses = scene["motions"][0]["poses"]
        for k, row in enumerate(rows):
            t, q, x = map(float, row.split(","))
            self.assertAlmostEqual(scene["times"][k], t, delta=1e-12)
            arm, bob = poses[36 * k + 12 : 36 * k + 24], poses[36 * k + 24 : 36 * k + 36]
            expected = [cos(q), 0, -sin(q), 0, 1, 0, sin(q), 0, cos(q), 0.1, 0, 1]
            for one, other in zip(arm, expected):
                self.assertAlmostEqual(one, other, delta=1e-6)
            self.assertAlmostEqual(bob[9], x, delta=1e-6)
            self.assertAlmostEqual(bob[11], 1 - cos(q), delta=1e-6)
            self.assertAlmostEqual(scene["motions"][0]["outputs"][1][k], x, delta=1e-6)

    def test_bodies_are_the_ellipsoids_of_their_inertia(self):
        arm, bob = read_scene(self.view()[0])["bodies"][1:]
        a, b, c = (2.5 / 2 * (0.75 - 2 * moment) for moment in (0.2, 0.25, 0.3))  # squares, by increasing moments
        for radius, square in zip(arm["radii"], (a, b, c)):
            self.assertAlmostEqual(radius, square**0.5, delta=1e-12)
        self.assertEqual(arm["ellipsoid"][9:], [0, 0, -0.5])
        self.assertEqual(bob["radii"], [0, 0, 0])
        self.assertEqual(arm["axis"], [0, 1, 0])

    def test_the_page_needs_nothing_else_and_has_the_picture(self):
        page, picture = self.view()
        self.assertLess(len(page), 3e6)
        self.assertLess(len(picture), 60000)
        self.assertIsNone(re.search(r'(src|href)="', page))
        self.assertIn(picture, page)

    def test_the_picture_shows_bodies_joints_and_springs(self):
        root = ET.fromstring(self.view()[1])
        classes = [element.get("class") for element in root.iter() if element.get("class")]
        for kind, count in (("body", 2), ("joint", 1), ("axis", 1), ("spring", 1), ("sensor", 1)):
            self.assertEqual(classes.count(kind), count, kind)
        self.assertEqual([text.text for text in root.iter(f"{SVG}text")], ["arm", "bob"])

    def test_texts_of_the_experiment_stay_texts(self):
        self.file.write_text(PENDULUM.replace("name: pen<du>lum", 'name: "</script><b>"').replace("arm", "arm_b"))
        result = call("view", self.file, "--out", self.folder / "page.html")
        if result.returncode == 0:
            page = (self.folder / "page.html").read_text()
            self.assertNotIn("</script><b>", page)

    def test_the_updated_model_moves_beside_the_nominal_one(self):
        measured = self.folder / "m.csv"
        call("simulate", self.file, "parameters.g=9.2", "--noise", "--csv", measured)
        result = call("view", self.file, measured, "--out", self.folder / "page.html")
        self.assertEqual(result.returncode, 0, result.stderr)
        motions = read_scene((self.folder / "page.html").read_text())["motions"]
        self.assertEqual([motion["name"] for motion in motions], ["nominal", "updated (ok)"])
        self.assertNotEqual(motions[0]["poses"], motions[1]["poses"])

    def test_experiments_with_loops_contacts_and_masses_in_a_row_are_drawn(self):
        for name in ("mechanisms/slider_crank", "mechanisms/bouncing_ball", "three_mass_chain/modes", "two_beam/best"):
            result = call("view", EXPERIMENTS / f"{name}.yaml", "--svg", self.folder / "picture.svg")
            self.assertEqual(result.returncode, 0, f"{name}: {result.stderr}")
            self.assertGreater((self.folder / "picture.svg").read_text().count("<ellipse"), 0, name)


if __name__ == "__main__":
    unittest.main()
