"""Parameters of every role, from the experiment file to a verified run: a mass whose load is known, whose initial
position and whose sensor's offset are not."""
import csv
import unittest

import h5py
import numpy as np
import yaml

from support import FolderTestCase, call, read_csv

EXPERIMENT = """
name: mass
parameters:
  k: {bounds: [5, 15], unit: N/m}
  d: {bounds: [0.2, 0.6], unit: N s/m}
nuisance:
  y_0: {bounds: [-0.01, 0.01], unit: m}
  bias: {bounds: [-0.02, 0.02], unit: m}
inputs:
  load: {bounds: [0, 1], unit: kg}
constants: {m: {value: 1, unit: kg}}
system:
  bodies:
    mass: {mass: m + load, joint: {type: slider, coordinates: [y]}}
  springs: [{coordinate: y, stiffness: k}]
  dampers: [{coordinate: y, damping: d}]
  force_laws: [{coordinate: y, force: F}]
excitation:
  F:
    unit: N
    tables: [{times: [0, 0.2, 0.4, 0.6, 0.8, 1], values: [0, 0.7, 1, 0.5, -0.2, 0], interpolation: cubic}]
initial: {coordinates: {y: y_0}}
outputs: {y: {coordinate: y, offset: bias}}
simulation: {duration: 4}
features:
  - samples: {outputs: [y], start: 0.1, interval: 0.1, count: 40}
noise: {stddev: {y: 1e-3}, correlation: {y: {autoregression: [0.5]}}}
design: {train: {samples: 200}, test: {samples: 40}}
inverse_map: {gp: {}}
evaluation:
  posterior: {samples: 1, draws: 200}
  baselines: [linear_regression, {least_squares: {samples: 3}}]
"""


class Roles(FolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.file = cls.folder / "mass.yaml"
        cls.file.write_text(EXPERIMENT)
        cls.run_folder = cls.folder / "run"
        result = call("run", cls.file, "--out", cls.run_folder)
        assert result.returncode == 0, result.stderr

    def test_only_the_updating_parameters_are_inferred(self):
        rows = read_csv(self.run_folder / "metrics.csv")
        self.assertEqual([row["parameter"] for row in rows], ["k", "d"])
        for row in rows:
            self.assertGreater(float(row["ratio_to_limit"]), 0.7, row)
            self.assertGreater(float(row["coverage95"]), 0.7, row)

    def test_files_name_all_that_is_sampled(self):
        sampled = ["k", "d", "y_0", "bias", "load"]
        with h5py.File(self.run_folder / "samples.h5") as file:
            self.assertEqual(list(file["parameters/name"].asstr()[:]), sampled)
            self.assertEqual(file["train/parameters"].shape, (200, 5))
        header = (self.run_folder / "failures.csv").read_text().split("\n")[0]
        self.assertEqual(header, ",".join(["set", "sample", *sampled, "reason"]))
        with h5py.File(self.run_folder / "maps.h5") as file:
            self.assertEqual(list(file["parameters/name"].asstr()[:]), ["k", "d"])
            self.assertEqual(list(file["inputs/name"].asstr()[:]), ["load"])
            known = file["trust/cloud/inputs"][:, -1] * file["trust/cloud/scale"][-1]
            self.assertLessEqual(np.abs(known).max(), 1.0)

    def test_the_run_is_verified(self):
        result = call("verify", self.run_folder, "--all")
        self.assertEqual(result.returncode, 0, result.stdout)

    def test_any_of_them_can_be_set_in_a_simulation(self):
        def simulate(*values):
            result = call("simulate", self.file, *values)
            self.assertEqual(result.returncode, 0, result.stderr)
            rows = list(csv.DictReader(result.stdout.splitlines()))
            return np.array([float(row["y"]) for row in rows])

        shifted = simulate("nuisance.bias=0.01") - simulate()
        np.testing.assert_allclose(shifted, 0.01, atol=1e-15)
        self.assertGreater(np.abs(simulate("inputs.load=1") - simulate()).max(), 1e-3)

    def test_the_resolved_experiment_is_complete(self):
        resolved = yaml.safe_load((self.run_folder / "resolved.yaml").read_text())
        self.assertEqual(resolved["noise"]["correlation"]["y"]["sample_time"], 0.1)
        self.assertEqual(resolved["transform"][0], {"whiten": {"by": "covariance"}})
