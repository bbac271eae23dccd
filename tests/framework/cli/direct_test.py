"""Inference from an experiment file alone: no run, no map."""
import json
import unittest

import numpy as np

from support import EXPERIMENTS, MIRROR, FolderTestCase, call, read_csv, write_csv

CART = EXPERIMENTS / "duffing/cart.yaml"
TRUE = {"k": 95.0, "d": 1.2, "k3": 2500.0}
POINT = [f"parameters.{name}={value}" for name, value in TRUE.items()]


class Direct(FolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.measured = cls.simulate(CART, "measured.csv", *POINT)

    @classmethod
    def simulate(cls, experiment, name, *overrides):
        path = cls.folder / name
        result = call("simulate", experiment, "--noise", "--csv", path, *overrides)
        assert result.returncode == 0, result.stderr
        return path

    def infer(self, *arguments):
        result = call("infer", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def test_finds_the_parameters_without_a_run(self):
        found = json.loads(self.infer(CART, self.measured, "--json"))
        self.assertEqual((found["status"], found["method"]), ("ok", "posterior"))
        covariance = np.array(found["covariance"])
        for i, (name, true) in enumerate(TRUE.items()):
            estimate = found["parameters"][name]
            self.assertLess(abs(estimate["mean"] - true), 4 * estimate["sd"], name)
            self.assertTrue(estimate["lower"] < estimate["mean"] < estimate["upper"])
            self.assertAlmostEqual(covariance[i, i] ** 0.5 / estimate["sd"], 1)
        self.assertGreater(found["posterior"]["effective_sample_size"], 100)

    def test_table_and_csv_say_the_same(self):
        found = json.loads(self.infer(CART, self.measured, "--json"))
        table = self.infer(CART, self.measured)
        self.assertIn("measured.csv: ok (p = ", table)
        self.assertIn("best fit found by", table)
        path = self.folder / "found.csv"
        path.write_text(self.infer(CART, self.measured, "--csv"))
        for row in read_csv(path):
            estimate = found["parameters"][row["parameter"]]
            for column, key in (("mean", "mean"), ("sd", "sd"), ("lower", "lower"), ("upper", "upper")):
                self.assertEqual(float(row[column]), estimate[key])
            self.assertEqual((row["status"], row["method"]), ("ok", "posterior"))

    def test_draws_have_the_moments_that_are_printed(self):
        draws = self.folder / "draws.csv"
        found = json.loads(self.infer(CART, self.measured, "--json", "--posterior=1000", "--draws", draws))
        rows = read_csv(draws)
        weights = np.array([float(row["weight"]) for row in rows])
        self.assertGreaterEqual(len(rows), 1000)
        for name in TRUE:
            values = np.array([float(row[name]) for row in rows])
            self.assertAlmostEqual(weights @ values / found["parameters"][name]["mean"], 1, places=9)

    def test_both_signs_that_fit_are_named(self):
        path = self.folder / "mirror.yaml"
        path.write_text(MIRROR)
        measured = self.simulate(path, "mirror.csv", "parameters.e=0.05", "parameters.k=4")
        found = json.loads(self.infer(path, measured, "--json"))
        self.assertEqual(found["status"], "multimodal")
        modes = sorted(mode["parameters"]["e"]["mean"] for mode in found["components"])
        self.assertEqual(len(modes), 2)
        for mode, true in zip(modes, (-0.05, 0.05)):
            self.assertAlmostEqual(mode, true, delta=0.01)
        for mode in found["components"]:
            self.assertAlmostEqual(mode["weight"], 0.5, delta=0.1)
        self.assertIn("multimodal, several parameter values may fit", self.infer(path, measured))
        (self.folder / "mirror_found.csv").write_text(self.infer(path, measured, "--csv"))
        row = read_csv(self.folder / "mirror_found.csv")[0]
        self.assertEqual(row["status"], "multimodal")
        self.assertEqual(
            [float(part.split(":")[0]) for part in row["components"].split("; ")],
            [mode["weight"] for mode in found["components"]],
        )

    def test_a_run_names_both_signs_too(self):
        path = self.folder / "mirror_run.yaml"
        path.write_text(MIRROR)
        measured = self.simulate(path, "mirror_run.csv", "parameters.e=0.05", "parameters.k=4")
        run = self.folder / "mirror_run"
        result = call(
            "run", path, "design.train.samples=60", "design.test.samples=60", "evaluation.limit=false", "--out", run
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        found = json.loads(self.infer(run, measured, "--json"))
        self.assertEqual((found["status"], found["method"]), ("multimodal", "posterior"))
        modes = sorted(mode["parameters"]["e"]["mean"] for mode in found["components"])
        for mode, true in zip(modes, (-0.05, 0.05)):
            self.assertAlmostEqual(mode, true, delta=0.01)
        self.assertEqual(found["parameters"], found["posterior"]["parameters"])
        self.assertIn("parameters", found["inverse_map"])

    def test_another_machine_is_a_mismatch(self):
        rows = read_csv(self.measured)
        names = list(rows[0])
        columns = [[float(row[name]) for row in rows] for name in names]
        wrong = self.folder / "wrong.csv"
        x = names.index("x")
        columns[x] = list(np.roll(columns[x], 7))
        write_csv(wrong, names, columns)
        found = json.loads(self.infer(CART, wrong, "--json"))
        self.assertEqual(found["status"], "model_mismatch")
        self.assertLess(found["trust"]["p_value"], 1e-6)
        self.assertIn("No parameter values within the bounds fit", self.infer(CART, wrong))

    def test_what_it_cannot_do_is_explained(self):
        result = call("infer", CART, self.measured, "--refine")
        self.assertEqual(result.returncode, 2)
        self.assertIn("inferred by simulation alone", result.stderr)
        result = call("infer", self.folder / "no.yaml", self.measured)
        self.assertEqual(result.returncode, 2)
        self.assertIn("no.yaml", result.stderr)


if __name__ == "__main__":
    unittest.main()
