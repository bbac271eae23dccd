"""Inference from an experiment file alone: no run, no map."""
import json
import unittest

import numpy as np

from support import EXPERIMENTS, FolderTestCase, call, read_csv, write_csv

CART = EXPERIMENTS / "duffing/cart.yaml"
TRUE = {"k": 95.0, "d": 1.2, "k3": 2500.0}
POINT = [f"parameters.{name}={value}" for name, value in TRUE.items()]

MIRROR = """
name: mirror
parameters:
  e: {bounds: [-0.1, 0.1], unit: m, relative_to: range}
  k: {bounds: [3, 6], unit: N m/rad}
constants: {m: {value: 1.5, unit: kg}}
system:
  bodies:
    table: {mass: 2, inertia: {moments: [0.01, 0.01, 0.01]}, joint: {type: pin, coordinates: [th]}}
    load: {mass: m, joint: {type: weld, parent: table, in_parent: {point: [e, 0, 0]}}}
  springs: [{coordinate: th, stiffness: k}]
  dampers: [{coordinate: th, damping: 0.03}]
  applied_moments: [{body: table, moment: [0, 0, T]}]
excitation: {T: {unit: N m, pulses: [{amplitude: 1, start: 0.05, end: 0.2}]}}
outputs: {th: {coordinate: th}}
simulation: {duration: 3}
features: [{samples: {outputs: [th], start: 0.03, interval: 0.03, count: 99}}]
noise: {stddev: {th: 3e-3}}
"""


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

    def infer_json(self):
        return json.loads(self.infer(CART, self.measured, "--json"))

    def stdout(self, *arguments):
        result = call(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

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
        modes = sorted(mode["parameters"]["e"]["mean"] for mode in found["modes"])
        self.assertEqual(len(modes), 2)
        for mode, true in zip(modes, (-0.05, 0.05)):
            self.assertAlmostEqual(mode, true, delta=0.01)
        for mode in found["modes"]:
            self.assertAlmostEqual(mode["weight"], 0.5, delta=0.1)
        self.assertIn("fits in separate places", self.infer(path, measured))

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

    def test_a_run_without_a_map_answers_as_its_file(self):
        run = self.folder / "run"
        result = call("run", CART, "inverse_map=none", "design.test.samples=40", "--out", run)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertFalse((run / "maps.h5").exists())
        self.assertTrue((run / "report.html").exists())
        for row in read_csv(run / "metrics.csv"):
            self.assertGreater(float(row["coverage95"]), 0.8)  # 40 samples: two of 10000 are below by chance
            self.assertTrue(0.6 < float(row["ratio_to_limit"]) < 1.6, row)  # errors of 11 to 16 %
        methods = read_csv(run / "methods.csv")
        self.assertEqual({row["method"] for row in methods}, {"posterior"})
        self.assertEqual(json.loads(self.infer(run, self.measured, "--json")), self.infer_json())
        self.assertEqual(call("verify", run).returncode, 0)
        self.assertIn("posterior on the simulator", self.stdout("check", run / "resolved.yaml"))
        result = call("infer", run, self.measured, "--refine")
        self.assertEqual(result.returncode, 2)
        result = call("run", CART, "inverse_map=none", "evaluation.baselines=[prior_mean]", "--out", run)
        self.assertEqual(result.returncode, 2)
        self.assertIn("every test sample is answered by its exact posterior", result.stderr)

    def test_without_a_map_sweeps_and_plans_work(self):
        sweep = self.folder / "sweep"
        overrides = ["inverse_map=none", "design.test.samples=10", "noise.scale=1,2"]
        self.assertIn("nothing is trained", self.stdout("plan", CART, *overrides, "--out", sweep))
        result = call("run", CART, *overrides, "--out", sweep)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(list((sweep / "cases").iterdir())), 2)

    def test_coarse_tolerances_are_named_and_automatic_ones_follow_the_noise(self):
        low = ["noise.scale=1e-4", "--noise", "--csv", self.folder / "low.csv"]
        result = call("simulate", CART, *low)
        self.assertIn("tolerances of the integration: ", result.stderr)
        self.assertNotIn("warning", result.stderr)
        path = self.folder / "coarse.yaml"
        path.write_text(CART.read_text().replace("{duration: 5}", "{duration: 5, relative_tolerance: 1e-3}"))
        result = call("simulate", path, "--csv", self.folder / "coarse.csv")
        line = next(i for i, text in enumerate(path.read_text().splitlines(), 1) if "1e-3}" in text)
        self.assertRegex(result.stderr, rf"coarse.yaml:{line}:\d+: simulation.relative_tolerance: 0.001: too coarse")
        self.assertIn("would do", result.stderr)

    def test_what_it_cannot_do_is_explained(self):
        result = call("infer", CART, self.measured, "--refine")
        self.assertEqual(result.returncode, 2)
        self.assertIn("inferred by simulation alone", result.stderr)
        result = call("infer", self.folder / "no.yaml", self.measured)
        self.assertEqual(result.returncode, 2)
        self.assertIn("no.yaml", result.stderr)


if __name__ == "__main__":
    unittest.main()
