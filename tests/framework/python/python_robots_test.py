"""Robots and pictures in Python: imported from a URDF, written back, drawn."""
import json
import unittest
import warnings
import xml.etree.ElementTree as ET

import numpy as np

import twinmap
from package_support import SOURCE, FolderTestCase
from support import call  # the command's

ELBOW = SOURCE / "experiments/robot/elbow.urdf"


def read_elbow(**options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return twinmap.Experiment.from_urdf(ELBOW, **options)


class Robots(FolderTestCase):
    def test_an_experiment_is_that_of_the_command(self):
        experiment = read_elbow(parameters=["damping"])
        (self.folder / "elbow.urdf.yaml").write_text(call("import", ELBOW, "--parameters", "damping").stdout)
        other = twinmap.Experiment.from_file(self.folder / "elbow.urdf.yaml")
        self.assertEqual(experiment.to_yaml(), other.to_yaml())
        self.assertIn("shoulder_damping", [q.name for q in experiment.parameters])
        self.assertIn("type: free", read_elbow(base="free").to_yaml())

    def test_what_is_left_out_warns_or_is_an_error(self):
        with self.assertWarnsRegex(UserWarning, r"not carried over:\n.*elbow.urdf:\d+"):
            twinmap.Experiment.from_urdf(ELBOW)
        with self.assertRaisesRegex(twinmap.ExperimentError, "elbow.urdf"):
            twinmap.Experiment.from_urdf(ELBOW, strict=True)
        with self.assertRaisesRegex(ValueError, "base"):
            twinmap.Experiment.from_urdf(ELBOW, base="loose")

    def test_an_estimate_is_written_back_as_the_command_does(self):
        experiment = read_elbow(parameters=["damping"]).override(
            {f"noise.stddev.{q.name}": 1e-3 for q in read_elbow().outputs},
            {f"excitation.{joint}_torque.pulses[0].amplitude": 4 for joint in ("shoulder", "elbow")},
        )
        measured = experiment.simulate({"shoulder_damping": [0.7]}, noise=True).to_frame()
        estimate = experiment.infer(measured)
        self.assertEqual(estimate.status, "ok")
        estimate.write_urdf(ELBOW, self.folder / "updated.urdf")
        updated = ET.parse(self.folder / "updated.urdf").getroot()
        damping = updated.find(".//joint[@name='shoulder']/dynamics").get("damping")
        self.assertAlmostEqual(float(damping), estimate["shoulder_damping"][0], delta=1e-12)
        summary = json.loads((self.folder / "updated.json").read_text())
        self.assertEqual(summary["status"], "ok")
        (self.folder / "estimate.json").write_text(json.dumps(estimate.details))
        call("export", self.folder / "estimate.json", "--urdf", ELBOW, "--out", self.folder / "other.urdf")
        self.assertEqual((self.folder / "updated.urdf").read_bytes(), (self.folder / "other.urdf").read_bytes())


class Pictures(FolderTestCase):
    def test_a_view_is_the_page_and_the_picture_of_the_command(self):
        file = SOURCE / "experiments/mechanisms/spinning_top.yaml"
        view = twinmap.Experiment.from_file(file).view()
        call("view", file, "--out", self.folder / "page.html", "--svg", self.folder / "picture.svg")
        self.assertEqual(view.page, (self.folder / "page.html").read_text())
        self.assertEqual(view._repr_svg_(), (self.folder / "picture.svg").read_text())
        self.assertIn("<iframe srcdoc=", view._repr_html_())
        view.save(self.folder / "saved.svg")
        self.assertEqual((self.folder / "saved.svg").read_text(), view.picture)

    def test_values_move_beside_the_nominal_ones(self):
        experiment = twinmap.Experiment.from_file(SOURCE / "experiments/mechanisms/spinning_top.yaml")
        name = experiment.parameters[0].name
        page = experiment.view({name: experiment.parameters[0].upper}).page
        self.assertIn('{"name":"nominal"', page)
        self.assertIn('{"name":"updated"', page)
        centre = [0.5 * (q.lower + q.upper) for q in experiment.sampled]
        self.assertIn('{"name":"sample 1"', experiment.view(np.array([centre, centre])).page)


if __name__ == "__main__":
    unittest.main()
