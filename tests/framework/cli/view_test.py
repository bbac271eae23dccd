"""twinmap view: the page and the picture of a mechanism."""
import base64
import json
import os
import re
import shutil
import struct
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ET
from math import atan2, cos, pi, sin
from pathlib import Path
from unittest import mock

import numpy as np
from support import EXPERIMENTS, call

CHAIN = """
name: chain
parameters: {k: {bounds: [99, 101], unit: N/m}}
system:
  bodies:
    one: {mass: 1, joint: {type: slider, coordinates: [x]}}
    two: {mass: 1, joint: {type: slider, coordinates: [y], in_parent: {point: [1, 0, 0]}}}
  force_laws:
    - {coordinate: x, force: k*(y - 2*x)}
    - {coordinate: y, force: k*(x - 2*y)}
initial: {coordinates: {x: 0.1}}
outputs: {x: {coordinate: x}}
simulation: {duration: 1}
features: [{samples: {outputs: [x], start: 0, interval: 0.01, count: 101}}]
noise: {stddev: {x: 1e-3}}
"""
# A tetrahedron's faces as triangles, polylist, polygons and a strip; two nodes draw it, one of them by a node of a library.
COLLADA = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimetre" meter="0.01"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="solid"><mesh>
<source id="places"><float_array id="numbers" count="16">0 0 0 9  10 0 0 9  0 20 0 9  0 0 +3e1 9</float_array>
<technique_common><accessor source="#numbers" count="4" stride="4"/></technique_common></source>
<vertices id="corners"><input semantic="POSITION" source="#places"/></vertices>
<triangles count="1"><input semantic="NORMAL" source="#places" offset="0"/>
<input semantic="VERTEX" source="#corners" offset="1"/><p>3 0 3 1 3 2</p></triangles>
<polylist count="1"><input semantic="VERTEX" source="#corners" offset="0"/><vcount>3</vcount><p>0 1 3</p></polylist>
<polygons count="1"><input semantic="VERTEX" source="#corners" offset="0"/><p>0 2 3</p></polygons>
<tristrips count="1"><input semantic="VERTEX" source="#corners" offset="0"/><p>1 2 3</p></tristrips>
</mesh></geometry></library_geometries>
<library_nodes><node id="part"><rotate>0 0 2 90</rotate><instance_geometry url="#solid"/></node></library_nodes>
<library_visual_scenes><visual_scene id="scene"><node>NODES</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#scene"/></scene></COLLADA>
"""
SEEN = "mass: 1, shapes: [{sphere: 0.2}]"
# Links of 0.1 m that turn about z, y and x by turns.
LINK = (
    '<link name="l{i}"><inertial><origin xyz="0 0 0.05"/><mass value="0.5"/><inertia ixx="1e-3" iyy="1e-3" izz="2e-4" '
    'ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="j{i}" type="revolute"><parent link="l{before}"/>'
    '<child link="l{i}"/><origin xyz="0 0 0.1" rpy="0.1 0.1 0"/><axis xyz="{axis}"/><limit effort="10" velocity="3" lower="-2" '
    'upper="2"/><dynamics damping="0.5"/></joint>'
)
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


def read_poses(text):
    """Of each pose the columns of the rotation, then the origin."""
    numbers = []
    for x, y, z, w, *origin in struct.iter_unpack("<7f", base64.b64decode(text)):
        numbers += [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)]
        numbers += [2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)]
        numbers += [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), *origin]
    return numbers


def read_scene(page):
    text = re.search(r'<script type="application/json" id="scene">(.*?)</script>', page, re.DOTALL).group(1)
    scene = json.loads(text.replace("<\\/", "</"))
    for motion in scene["motions"] + scene["modes"]:
        motion["poses"] = read_poses(motion["poses"])
    return scene


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

    def test_what_cannot_be_simulated_stands_still_and_says_why(self):
        text = PENDULUM.replace("pen<du>lum", "pendulum").replace("simulation: {", "simulation: {max_steps: 3, ")
        self.file.write_text(text)
        self.assertEqual(call("simulate", self.file).returncode, 1)
        scene = read_scene(self.view()[0])
        self.assertEqual(len(scene["times"]), 1)
        self.assertIn("the mechanism stands still: the simulation failed: step limit", scene["remarks"][0])
        self.assertAlmostEqual(scene["motions"][0]["poses"][12], cos(0.4), delta=1e-6)

    def test_what_acts_on_joints_and_between_bodies_is_named_there(self):
        scene = {name: self.draw(name) for name in ("duffing/cart", "mechanisms/stick_slip", "mechanisms/slider_crank")}
        self.assertEqual(scene["duffing/cart"]["bodies"][1]["acting"], ["spring", "damper", "force law"])
        self.assertIn("friction", scene["mechanisms/stick_slip"]["bodies"][1]["acting"])
        self.assertEqual([mark["kind"] for mark in scene["mechanisms/slider_crank"]["marks"]], ["constraint"])
        picture = (self.folder / "picture.svg").read_text()
        self.assertIn('class="constraint"', picture)

    def draw(self, name):
        files = ("--out", self.folder / "page.html", "--svg", self.folder / "picture.svg")
        self.assertEqual(call("view", EXPERIMENTS / f"{name}.yaml", *files).returncode, 0, name)
        return read_scene((self.folder / "page.html").read_text())

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
        self.assertEqual([motion["name"] for motion in motions], ["nominal", "updated (ok)", "measured"])
        self.assertNotEqual(motions[0]["poses"], motions[1]["poses"])

    def test_the_measured_motion_is_what_the_sensors_read_and_the_residual_is_noise(self):
        measured = self.folder / "m.csv"
        call("simulate", self.file, "parameters.g=9.2", "--noise", "--csv", measured)
        self.assertEqual(call("view", self.file, measured, "--out", self.folder / "page.html").returncode, 0)
        scene = read_scene((self.folder / "page.html").read_text())
        rows = [list(map(float, row.split(","))) for row in measured.read_text().splitlines()[1:]]
        poses = scene["motions"][2]["poses"]
        for k, (t, q, x) in enumerate(rows):
            self.assertAlmostEqual(scene["times"][k], t, delta=1e-9)
            drawn = atan2(poses[36 * k + 18], poses[36 * k + 12])  # of the arm about y
            self.assertLess(abs(drawn - q), 6e-3)  # q and x, of 1e-3 each, are two sensors of one angle
        for output, column in zip(scene["outputs"], zip(*rows)):
            self.assertEqual(output["measured"]["scale"], "sd")
            squares = [r**2 for r in output["measured"]["residual"]]
            self.assertAlmostEqual(sum(squares) / len(squares), 1, delta=0.4)  # 4 sds of chi2(201) / 201
        self.assertEqual([output["body"] for output in scene["outputs"]], [1, 2])

    def test_coordinates_without_a_sensor_follow_the_updated_model(self):
        self.file.write_text(PENDULUM.replace("[q, x]", "[x]").replace("pen<du>lum", "pendulum"))
        measured = self.folder / "m.csv"
        call("simulate", self.file, "--csv", measured)
        result = call("view", self.file, measured, "--out", self.folder / "page.html")
        self.assertEqual(result.returncode, 0, result.stderr)
        motions = read_scene((self.folder / "page.html").read_text())["motions"]
        for one, other in zip(motions[1]["poses"], motions[2]["poses"]):
            self.assertAlmostEqual(one, other, delta=1e-4)

    def test_modes_are_those_of_two_equal_masses_between_three_equal_springs(self):
        self.file.write_text(CHAIN)
        scene = read_scene(self.view()[0])
        self.assertEqual(len(scene["modes"]), 2)
        for mode, square, sign in zip(scene["modes"], (100, 300), (1, -1)):
            self.assertAlmostEqual(mode["frequency"], square**0.5 / (2 * pi), delta=1e-6)
            self.assertAlmostEqual(mode["damping"], 0, delta=1e-9)
            for frame in range(25):
                one, other = (mode["poses"][36 * frame + 12 * body + 9] for body in (1, 2))
                self.assertAlmostEqual(other - 1, sign * one, delta=1e-6)  # y is 0 at 1 m
            self.assertGreater(mode["poses"][12 + 9] ** 2 + mode["poses"][36 * 6 + 12 + 9] ** 2, 0)

    def test_modes_of_more_coordinates_than_are_recorded_at_once_are_those_of_a_chain(self):
        n, names = 12, ["0"] + [f"x{i}" for i in range(1, 13)] + ["0"]
        bodies = "".join(
            f"    b{i}: {{mass: 1, joint: {{type: slider, coordinates: [x{i}]}}}}\n" for i in range(1, n + 1)
        )
        laws = "".join(
            f"    - {{coordinate: {at}, force: k*({before} - 2*{at} + {after})}}\n"
            for before, at, after in zip(names, names[1:-1], names[2:])
        )
        head, tail = CHAIN.split("  bodies:\n")[0], CHAIN[CHAIN.index("initial:") :]
        text = f"{head}  bodies:\n{bodies}  force_laws:\n{laws}{tail}"
        self.file.write_text(re.sub(r"\bx\b", "x1", text))
        frequencies = [mode["frequency"] for mode in read_scene(self.view()[0])["modes"]]
        self.assertEqual(len(frequencies), n)
        for i, frequency in enumerate(frequencies, 1):  # between walls, k / m = 100 1/s2
            self.assertAlmostEqual(frequency, 20 * sin(i * pi / (2 * (n + 1))) / (2 * pi), delta=1e-6)

    def add_shapes(self, shapes):
        text = PENDULUM.replace("pen<du>lum", "pendulum").replace(
            "      mass: 2", f"      shapes: {shapes}\n      mass: 2"
        )
        self.file.write_text(text)

    def test_shapes_are_drawn_where_they_are_said_to_be_and_change_no_response(self):
        plain = call("simulate", self.file).stdout
        self.add_shapes(
            "[{box: [0.1, 0.2, 1], point: [0, 0, -0.5]}, {cylinder: {radius: 0.1, length: 0.3}, "
            "orientation: [1.5707963267948966, 0, 0]}, {sphere: 0.2}, {capsule: {radius: 0.1, length: 1}}]"
        )
        self.assertEqual(call("simulate", self.file).stdout, plain)
        page, picture = self.view()
        shapes = read_scene(page)["bodies"][1]["shapes"]
        self.assertEqual([shape["kind"] for shape in shapes], ["box", "cylinder", "sphere", "capsule"])
        self.assertEqual(shapes[0]["size"] + shapes[0]["frame"][9:], [0.1, 0.2, 1, 0, 0, -0.5])
        self.assertEqual(shapes[1]["size"], [0.2, 0.2, 0.3])
        for number, expected in zip(shapes[1]["frame"], [1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 0]):
            self.assertAlmostEqual(number, expected, delta=1e-12)
        classes = [element.tag for element in ET.fromstring(picture).iter() if element.get("class") == "body"]
        self.assertEqual(classes, [f"{SVG}polygon"] * 4 + [f"{SVG}ellipse"])

    def test_meshes_of_three_formats_are_one_and_a_missing_one_is_a_box(self):
        corners = [(0, 0, 0), (10, 0, 0), (0, 20, 0), (0, 0, 30)]
        faces = [(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)]
        binary = bytes(80) + struct.pack("<I", len(faces))
        text = "solid tetrahedron\n"
        for face in faces:
            binary += struct.pack("<12fH", 0, 0, 0, *(x for i in face for x in corners[i]), 0)
            text += "facet normal 0 0 0\nouter loop\n"
            text += "".join("vertex %g %g %g\n" % corners[i] for i in face) + "endloop\nendfacet\n"
        (self.folder / "binary.stl").write_bytes(binary)
        (self.folder / "text.STL").write_text(text)
        lines = ["v %g %g %g" % corner for corner in corners] + [
            "f %d/1 %d//2 %d" % tuple(i + 1 for i in face) for face in faces
        ]
        (self.folder / "lines.obj").write_text("\n".join(lines))
        self.add_shapes(
            "["
            + ", ".join(
                f"{{mesh: {name}, scale: [0.001, 0.001, 0.001]}}"
                for name in ("binary.stl", "text.STL", "lines.obj", "none.stl")
            )
            + "]"
        )
        result = call("view", self.file, "--out", self.folder / "page.html")
        self.assertIn("none.stl", result.stderr)
        self.assertIn("a box is drawn in its place", result.stderr)
        one, two, three, box = read_scene((self.folder / "page.html").read_text())["bodies"][1]["shapes"]
        self.assertEqual(one["size"], [0.01, 0.02, 0.03])
        self.assertEqual(len(base64.b64decode(one["triangles"])), 48)
        points = {tuple(point) for point in struct.iter_unpack("<3H", base64.b64decode(one["points"]))}
        self.assertEqual(points, {(0, 0, 0), (65535, 0, 0), (0, 65535, 0), (0, 0, 65535)})
        self.assertEqual(one, two)
        self.assertEqual(one, three)
        self.assertEqual(box["kind"], "box")

    def read_collada(self, text, scale=1):
        """What is drawn of it, and warnings."""
        (self.folder / "solid.DAE").write_text(text)
        self.add_shapes(f"[{{mesh: solid.DAE, scale: [{scale}, {scale}, {scale}]}}]")
        result = call("view", self.file, "--out", self.folder / "page.html")
        self.assertEqual(result.returncode, 0, result.stderr)
        return read_scene((self.folder / "page.html").read_text())["bodies"][1]["shapes"][0], result.stderr

    def list_triangles(self, shape):
        """Corners of triangles in m."""
        points = [
            [at + edge * step / 65535 for at, edge, step in zip(shape["frame"][9:], shape["size"], point)]
            for point in struct.iter_unpack("<3H", base64.b64decode(shape["points"]))
        ]
        return np.array(
            [[points[i] for i in face] for face in struct.iter_unpack("<3I", base64.b64decode(shape["triangles"]))]
        )

    def test_a_collada_file_is_drawn_in_its_unit_by_its_nodes(self):
        corners = np.array([(0, 0, 0), (10, 0, 0), (0, 20, 0), (0, 0, 30)]) / 100
        faces = [(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)]
        plain = "<instance_geometry url='#solid'/>"
        shape, warnings = self.read_collada(COLLADA.replace("NODES", plain), 10)
        self.assertEqual(warnings.count("warning"), 0)
        np.testing.assert_allclose(self.list_triangles(shape), [10 * corners[list(face)] for face in faces], atol=1e-4)
        # Row by row; then a mirror image of the part that is turned by 90 degrees, whose faces still look outwards.
        moved = "<matrix>1 0 0 100  0 1 0 0  0 0 1 0  0 0 0 1</matrix>" + plain
        part = "<node><translate>0 0 -100</translate><scale>1 -1 1</scale><instance_node url='#part'/></node>"
        triangles = self.list_triangles(self.read_collada(COLLADA.replace("NODES", moved + part))[0])
        np.testing.assert_allclose(triangles[:4], [corners[list(face)] + [1, 0, 0] for face in faces], atol=1e-4)
        turned = np.array([(-y, x, z) for x, y, z in corners]) * [1, -1, 1] + [1, 0, -1]
        expected = [turned[[a, c, b]] for a, b, c in faces]
        np.testing.assert_allclose(triangles[4:], expected, atol=1e-4)

    def test_a_collada_file_that_cannot_be_read_is_a_box_and_says_why(self):
        good = COLLADA.replace("NODES", "<instance_geometry url='#solid'/>")
        for text, reason in (
            ("<COLLADA>", "is not XML"),
            ("<svg/>", "no <COLLADA>"),
            (good.replace("url='#solid'", "url='#other'"), "points at nothing in the file: '#other'"),
            (good.replace("+3e1", "3,1"), "not a number: '3,1'"),
            (good.replace("<p>0 1 3</p>", "<p>0 1 4</p>"), "corner that does not exist: 4"),
            (good.replace("<vcount>3</vcount>", "<vcount>4</vcount>"), "fewer corners"),
            (good.replace("+3e1", "nan"), "not finite"),
            (COLLADA.replace("NODES", "<skew>1 2 3 4 5 6 7</skew>"), "<skew> is not read"),
            (COLLADA.replace("NODES", "<matrix>1 2 3</matrix>"), "must have 16 numbers"),
            (COLLADA.replace("NODES", ""), "no triangles"),
            (COLLADA.replace("NODES", "<node id='a'><instance_node url='#a'/></node>"), "without end"),
        ):
            shape, warnings = self.read_collada(text)
            self.assertEqual(shape["kind"], "box", reason)
            self.assertRegex(warnings, f"solid.DAE: .*{reason}.*; a box is drawn in its place")

    def test_a_collada_file_of_endless_copies_is_refused_at_once(self):
        doubling = "".join(
            f"<node id='n{i}'><instance_node url='#n{i + 1}'/><instance_node url='#n{i + 1}'/></node>"
            for i in range(60)
        )
        nodes = "<instance_node url='#n0'/>"
        text = COLLADA.replace("<library_nodes>", "<library_nodes>" + doubling + "<node id='n60'/>")
        shape, warnings = self.read_collada(text.replace("NODES", nodes))
        self.assertEqual(shape["kind"], "box")
        self.assertIn("more than 2000000 triangles", warnings)

    def test_a_fine_mesh_is_coarsened_and_says_so(self):
        steps = 400  # 320 000 triangles of a wavy plane
        lines = ["v %g %g %g" % (i, j, sin(i) + cos(j)) for i in range(steps) for j in range(steps)]
        for i in range(steps - 1):
            for j in range(steps - 1):
                at = i * steps + j + 1
                lines.append(f"f {at} {at + 1} {at + steps + 1} {at + steps}")
        (self.folder / "fine.obj").write_text("\n".join(lines))
        self.add_shapes("[{mesh: fine.obj}]")
        result = call("view", self.file, "--out", self.folder / "page.html")
        self.assertRegex(result.stderr, r"fine.obj: is drawn with \d+ of its 318402 triangles")
        page = (self.folder / "page.html").read_text()
        self.assertLess(len(page), 20e6)
        mesh = read_scene(page)["bodies"][1]["shapes"][0]
        self.assertLess(len(base64.b64decode(mesh["triangles"])) / 12, 200001)
        self.assertEqual(mesh["size"][:2], [399, 399])

    def test_shapes_that_are_none_are_refused_with_their_place(self):
        for shapes, what in (
            ("[{box: [1, 0, 1]}]", "edges above 0"),
            ("[{sphere: -1}]", "above 0"),
            ("[{sphere: 1, box: [1, 1, 1]}]", "exactly one of"),
            ("[{sphere: 1, scale: [2, 2, 2]}]", "scale"),
            ("[{cone: 1}]", "cone"),
            ("[{cylinder: {radius: 1}}]", "length"),
        ):
            self.add_shapes(shapes)
            result = call("check", self.file)
            self.assertEqual(result.returncode, 2, shapes)
            self.assertRegex(result.stderr, rf"pendulum.yaml:\d+:\d+: .*{what}", shapes)

    def film(self, *arguments):
        """The film's stream as ffprobe describes it, and its frames, one byte a pixel, by brightness."""
        film = self.folder / "film.mp4"
        result = call("view", *arguments, "--mp4", film)
        self.assertEqual(result.returncode, 0, result.stderr)
        asked = ["-show_entries", "stream=width,height,duration,nb_frames", "-of", "json", film]
        stream = json.loads(subprocess.run(["ffprobe", "-v", "error", *asked], capture_output=True, check=True).stdout)
        raw = ["ffmpeg", "-v", "error", "-i", film, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
        pixels = subprocess.run(raw, capture_output=True, check=True).stdout
        width, height = (stream["streams"][0][key] for key in ("width", "height"))
        return stream["streams"][0], np.frombuffer(pixels, np.uint8).reshape(-1, height, width, 3).astype(int)

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
    def test_a_film_shows_the_motion_in_real_time(self):
        self.file.write_text(CHAIN.replace("duration: 1", "duration: 2").replace("mass: 1", SEEN))
        stream, frames = self.film(self.file)
        self.assertEqual(int(stream["nb_frames"]), 51)
        self.assertAlmostEqual(float(stream["duration"]), 51 / 25, delta=1e-6)
        # Both carriages slide along the picture's width. Their sum, x + y = 0.1 cos 10 t, is the first mode alone:
        # the first and the last blue column follow it. Above 100 pixels stands what blue means.
        blue = (frames[:, 100:, :, 2] - frames[:, 100:, :, 0] > 30).any(axis=1)
        where = [np.flatnonzero(columns)[[0, -1]].mean() for columns in blue]
        self.assertGreater(np.corrcoef(where, np.cos(10 * np.arange(51) / 25))[0, 1], 0.99)

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
    def test_a_film_overlays_all_motions_and_is_slowed_where_they_are_short(self):
        measured = self.folder / "m.csv"
        call("simulate", self.file, "parameters.g=9.2", "--noise", "--csv", measured)
        self.assertEqual(len(self.film(self.file, measured)[1]), 51)
        self.file.write_text(CHAIN.replace("duration: 1", "duration: 0.1").replace("count: 101", "count: 11"))
        self.assertEqual(len(self.film(self.file)[1]), 51)  # 2 s at 0.05 times the speed

    def test_without_ffmpeg_a_film_says_what_to_install(self):
        with mock.patch.dict(os.environ, {"PATH": ""}):
            result = call("view", self.file, "--mp4", self.folder / "film.mp4")
        self.assertEqual(result.returncode, 1)
        self.assertIn("apt install ffmpeg", result.stderr)

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
    def test_what_does_not_move_has_no_film(self):
        still = PENDULUM.replace("pen<du>lum", "still").replace("simulation: {", "simulation: {max_steps: 3, ")
        self.file.write_text(still)
        for file in (self.file, EXPERIMENTS / "python_plant/python_plant.yaml"):
            result = call("view", file, "--mp4", self.folder / "film.mp4")
            self.assertEqual((result.returncode, (self.folder / "film.mp4").exists()), (1, False), file)
            self.assertIn("leave --mp4 out", result.stderr)

    def test_a_chain_of_sixty_joints_is_simulated_and_drawn_and_what_was_measured_beside_it(self):
        links = "".join(LINK.format(i=i, before=i - 1, axis=("0 0 1", "0 1 0", "1 0 0")[i % 3]) for i in range(1, 61))
        (self.folder / "chain.urdf").write_text(f'<robot name="chain"><link name="l0"/>{links}</robot>')
        imported = call("import", self.folder / "chain.urdf")
        self.assertEqual(imported.returncode, 0, imported.stderr)
        text = imported.stdout.replace("unknown", "1e-3").replace(
            "simulation: {duration: 1}", "simulation: {duration: 0.1}"
        )
        self.file.write_text(re.sub(r"count: \d+", "count: 11", text))
        measured = self.folder / "m.csv"
        simulated = call("simulate", self.file, "--noise", "--csv", measured)
        self.assertEqual(simulated.returncode, 0, simulated.stderr)
        result = call("view", self.file, measured, "--out", self.folder / "page.html")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("of more than 30 bodies the model is not fitted", result.stderr)
        self.assertIn("no modes: they are sought of at most 30 coordinates", result.stderr)
        scene = read_scene((self.folder / "page.html").read_text())
        self.assertEqual([motion["name"] for motion in scene["motions"]], ["nominal", "measured"])
        one, other = (np.array(motion["poses"]) for motion in scene["motions"])
        self.assertLess(abs(one - other).max(), 60 * 6e-3)  # noise of 1e-3 rad at each joint
        self.assertGreater(abs(one - other).max(), 1e-4)

    def test_a_model_from_elsewhere_has_a_picture_of_its_outputs(self):
        call("view", EXPERIMENTS / "python_plant/python_plant.yaml", "--svg", self.folder / "picture.svg")
        root = ET.parse(self.folder / "picture.svg").getroot()
        self.assertEqual([element.get("class") for element in root.iter(f"{SVG}polyline")], ["signal"] * 2)

    def test_experiments_with_loops_contacts_and_masses_in_a_row_are_drawn(self):
        for name in ("mechanisms/slider_crank", "mechanisms/bouncing_ball", "three_mass_chain/modes", "two_beam/best"):
            result = call("view", EXPERIMENTS / f"{name}.yaml", "--svg", self.folder / "picture.svg")
            self.assertEqual(result.returncode, 0, f"{name}: {result.stderr}")
            self.assertGreater((self.folder / "picture.svg").read_text().count("<ellipse"), 0, name)


if __name__ == "__main__":
    unittest.main()
