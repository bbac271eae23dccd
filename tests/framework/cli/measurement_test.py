"""twinmap noise, simulated responses as measurements, and measured excitation, as a user meets them."""
import functools
import json
import os
import unittest

import h5py
import numpy as np
import scipy.io
import yaml

import support
from support import EXPERIMENTS, OwnFolderTestCase

TABLE1 = EXPERIMENTS / "two_beam/table1.yaml"
call = functools.partial(support.call, timeout=600)


class TestCase(OwnFolderTestCase):
    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path


class Noise(TestCase):
    def setUp(self):
        super().setUp()
        generator = np.random.default_rng(1)
        self.t = np.arange(2000) * 0.01
        self.y = generator.normal(0.0, 2.0, len(self.t))
        white = generator.normal(0.0, 1.0, len(self.t))
        self.theta = np.zeros(len(self.t))
        for k in range(1, len(self.t)):
            self.theta[k] = 0.8 * self.theta[k - 1] + white[k]

    def write_csv(self):
        rows = zip(self.t, self.y, self.theta)
        return self.write("a.csv", "t,enc1 [mm],theta\n" + "".join(f"{t!r},{y!r},{x!r}\n" for t, y, x in rows))

    def test_estimates_and_gives_yaml_that_an_experiment_takes(self):
        result = call("noise", self.write_csv())
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("enc1 [mm]", result.stdout)
        self.assertIn("none, white", result.stdout)
        noise = yaml.safe_load(result.stdout[result.stdout.index("noise:") :])["noise"]
        self.assertAlmostEqual(noise["stddev"]["enc1"], np.std(self.y), delta=1e-2 * 2)
        coefficients = noise["correlation"]["theta"]["autoregression"]
        self.assertEqual(len(coefficients), 1)
        self.assertAlmostEqual(coefficients[0], 0.8, delta=4 * np.sqrt(0.36 / len(self.t)))
        self.assertEqual(noise["correlation"]["theta"]["sample_time"], 0.01)

    def test_an_experiment_says_where_outputs_stand_and_takes_the_result(self):
        experiment = yaml.safe_load(TABLE1.read_text())
        experiment["measurement"] = {"columns": {"y": "enc1"}}
        path = self.write("e.yaml", yaml.safe_dump(experiment))
        result = call("noise", self.write_csv(), "--window", "0,9.995", "--experiment", path)
        self.assertEqual(result.returncode, 0, result.stderr)
        noise = yaml.safe_load(result.stdout[result.stdout.index("noise:") :])["noise"]
        self.assertAlmostEqual(noise["stddev"]["y"], np.std(self.y[:1000]) * 1e-3, delta=1e-5)
        experiment["noise"].update(noise)
        path = self.write("f.yaml", yaml.safe_dump(experiment))
        self.assertEqual(call("check", path).returncode, 0, call("check", path).stderr)

    def test_files_of_matlab_and_hdf5_give_the_same(self):
        reference = json.loads(call("noise", self.write_csv(), "--columns", "theta", "--json").stdout)
        for compressed in (False, True):
            scipy.io.savemat(self.folder / "a.mat", {"t": self.t, "theta": self.theta}, do_compression=compressed)
            self.assertEqual(self.read_columns("a.mat"), reference["columns"])
        with h5py.File(self.folder / "a.h5", "w") as file:
            file["t"] = self.t
            file["theta"] = self.theta
            file["theta"].attrs["unit"] = "rad"
        with_unit = [dict(reference["columns"][0], unit="rad")]
        self.assertEqual(self.read_columns("a.h5"), with_unit)
        with h5py.File(self.folder / "b.mat", "w", userblock_size=512) as file:  # version 7.3
            for name, values in (("t", self.t), ("theta", self.theta)):
                file[name] = values[:, None]
                file[name].attrs.create("MATLAB_class", np.bytes_("double"), dtype="S7")
        header = b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM"
        with open(self.folder / "b.mat", "r+b") as file:
            file.write(header)
        self.assertEqual(self.read_columns("b.mat"), reference["columns"])

    def read_columns(self, name):
        result = call("noise", self.folder / name, "--columns", "theta", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)["columns"]

    def test_wrong_input_exits_with_2_and_names_the_rule(self):
        for text, arguments, expected in (
            ("t,y\n0,1\n", ["--columns", "z"], "has no column 'z'"),
            ("t,y\n0,x\n", ["--columns", "y"], "a.csv:2: column 'y' has 'x' which must be a number"),
            ("t,y\n0,1\n", [], "column 'y' has 1 samples; must have at least 20"),
        ):
            result = call("noise", self.write("a.csv", text), *arguments)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn(expected, result.stderr)
        result = call("noise", self.folder / "nothing.csv")
        self.assertEqual(result.returncode, 2)
        self.assertIn("nothing.csv: does not exist", result.stderr)


class MeasuredExcitation(TestCase):
    def setUp(self):
        super().setUp()
        t = np.arange(-20, 600) * 0.01
        self.write("force.csv", "time,F [kN]\n" + "".join(f"{a + 0.5:.3f},{5e-3 * np.sin(3 * a):.17g}\n" for a in t))
        self.experiment = yaml.safe_load(TABLE1.read_text())
        self.experiment["excitation"]["F"] = {
            "unit": "N",
            "tables": [
                {
                    "measured": {"file": "force.csv", "column": "F", "time": "time", "start": 0.5},
                    "interpolation": "cubic",
                }
            ],
        }

    def simulate(self, *arguments):
        path = self.write("e.yaml", yaml.safe_dump(self.experiment))
        result = call("simulate", path, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return np.genfromtxt(result.stdout.splitlines(), delimiter=",", names=True)

    def test_simulates_the_input_that_was_measured(self):
        measured = self.simulate()
        self.experiment["excitation"]["F"] = {"unit": "N", "sines": [{"amplitude": 5, "frequency": 3 / (2 * np.pi)}]}
        exact = self.simulate()
        self.assertLess(np.max(np.abs(measured["y"] - exact["y"])), 1e-6 * np.max(np.abs(exact["y"])))

    def test_the_resolved_experiment_needs_the_file_no_more(self):
        path = self.write("e.yaml", yaml.safe_dump(self.experiment))
        resolved = call("check", path, "--full")
        self.assertEqual(resolved.returncode, 0, resolved.stderr)
        os.remove(self.folder / "force.csv")
        self.assertEqual(call("check", self.write("resolved.yaml", resolved.stdout), "--full").stdout, resolved.stdout)
        result = call("check", path)
        self.assertEqual(result.returncode, 2)
        self.assertIn("excitation.F.tables[0].measured.file", result.stderr)
        self.assertIn("force.csv: does not exist", result.stderr)

    def test_windows_can_be_swept(self):
        path = self.write("e.yaml", yaml.safe_dump(self.experiment))
        result = call(
            "run",
            path,
            "design.train.samples=20",
            "design.test.samples=5",
            "evaluation.limit=false",
            "excitation.F.tables[0].measured.start=0.5,0.6",
            "--out",
            self.folder / "sweep",
            "--quiet",
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        values = []
        for case in sorted((self.folder / "sweep/cases").iterdir()):
            table = yaml.safe_load((case / "resolved.yaml").read_text())["excitation"]["F"]["tables"][0]
            values.append(np.interp(1.0, table["times"], table["values"]))
        np.testing.assert_allclose(values, 5 * np.sin(3 * np.array([1.0, 1.1])), rtol=1e-3)
        self.assertEqual(call("status", self.folder / "sweep").returncode, 0)
