"""Posteriors of measurements under the surrogate."""
import csv
import io
import json
import unittest

import numpy as np

from support import EXPERIMENTS, FolderTestCase, call, read_csv

TABLE1 = EXPERIMENTS / "two_beam/table1.yaml"
TRUE = {"d_y": 0.95, "d_theta": 2.1e-4, "k_y": 8.5, "k_theta": 0.034}
POINT = [f"parameters.{name}={value}" for name, value in TRUE.items()]


class Posterior(FolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.run_folder = cls.run_experiment("run", "inverse_map=surrogate")
        cls.measured = cls.folder / "measured.csv"
        result = call("simulate", TABLE1, "--noise", "--csv", cls.measured, *POINT)
        assert result.returncode == 0, result.stderr

    @classmethod
    def run_experiment(cls, name, *overrides):
        result = call(
            "run",
            TABLE1,
            "design.train.samples=60",
            "design.test.samples=60",
            "evaluation.limit=false",
            *overrides,
            "--out",
            cls.folder / name,
        )
        assert result.returncode == 0, result.stderr
        return cls.folder / name

    def infer(self, *arguments, run=None, **options):
        result = call("infer", run or self.run_folder, *arguments, **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def test_stands_beside_the_normal_answer(self):
        answer = json.loads(
            self.infer(self.measured, "--json", "--no-refine", "--posterior=1000", "--posterior-from", "surrogate")
        )
        posterior = answer["posterior"]
        self.assertEqual(posterior["status"], "ok")
        self.assertGreater(posterior["effective_sample_size"], 300)
        self.assertLess(posterior["pareto_shape"], 0.7)
        for name, true in TRUE.items():
            found, normal = posterior["parameters"][name], answer["parameters"][name]
            self.assertLess(abs(found["mean"] - true), 4 * found["sd"], name)
            self.assertAlmostEqual(found["sd"] / normal["sd"], 1, delta=0.15)  # 4 x 1 / sqrt(2 x 300), and the limit's
            probabilities, values = np.array(found["quantiles"]).T
            np.testing.assert_allclose(probabilities, [0.025, 0.16, 0.5, 0.84, 0.975])
            self.assertTrue((np.diff(values) > 0).all())
            self.assertEqual([found["lower"], found["upper"]], [values[0], values[-1]])
        self.assertEqual((posterior["from"], answer["method"]), ("surrogate", "surrogate"))

    def test_of_the_simulator_is_the_estimate(self):
        answer = json.loads(self.infer(self.measured, "--json", "--no-refine", "--posterior"))
        self.assertEqual((answer["method"], answer["posterior"]["from"]), ("posterior", "simulator"))
        self.assertEqual(answer["status"], "ok")
        self.assertEqual(answer["parameters"], answer["posterior"]["parameters"])
        by_surrogate = json.loads(self.infer(self.measured, "--json", "--no-refine", "--posterior-from", "surrogate"))[
            "posterior"
        ]["parameters"]
        for name, true in TRUE.items():
            found, other = answer["parameters"][name], by_surrogate[name]
            self.assertLess(abs(found["mean"] - true), 4 * found["sd"], name)
            self.assertLess(abs(found["mean"] - other["mean"]), 0.5 * found["sd"], name)
            self.assertAlmostEqual(found["sd"] / other["sd"], 1, delta=0.25)
        table = self.infer(self.measured, "--posterior")
        self.assertRegex(table, r"sampled on the simulator\n")  # nothing limits it

    def test_joint_draws_have_its_moments(self):
        file = self.folder / "draws.csv"
        posterior = json.loads(self.infer(self.measured, "--json", "--posterior=2000", "--draws", file))["posterior"]
        rows = read_csv(file)
        self.assertEqual(len(rows), posterior["evaluations"])
        weights = np.array([float(row["weight"]) for row in rows])
        self.assertAlmostEqual(weights.sum(), 1, places=9)
        self.assertEqual({row["source"] for row in rows}, {str(self.measured)})
        for name in TRUE:
            values, found = np.array([float(row[name]) for row in rows]), posterior["parameters"][name]
            self.assertLess(abs(weights @ values - found["mean"]), 1e-6 * found["sd"])
            self.assertAlmostEqual((weights @ (values - found["mean"]) ** 2) ** 0.5 / found["sd"], 1, places=6)

    def test_profiles_fall_from_the_estimate_to_both_sides(self):
        for source in (self.run_folder, TABLE1):
            file = self.folder / "profile.csv"
            answer = json.loads(self.infer(self.measured, "--json", "--profile", file, run=source))
            rows = read_csv(file)
            self.assertEqual([row["parameter"] for row in rows], [name for name in TRUE for _ in range(13)])
            for name in TRUE:
                found = answer["parameters"][name]
                own = [row for row in rows if row["parameter"] == name]
                values = np.array([float(row["value"]) for row in own])
                ratios = np.array([float(row["log_likelihood_ratio"]) for row in own])
                self.assertEqual([row[name] for row in own], [row["value"] for row in own])
                self.assertTrue((np.diff(values) > 0).all())
                self.assertLessEqual(ratios.max(), 0)
                distances = (values - found["mean"]) / found["sd"]
                np.testing.assert_allclose(ratios, -0.5 * distances**2, atol=1.5)
                told = answer["posterior"]["profiles"][name]
                np.testing.assert_allclose(told["log_likelihood_ratio"], ratios)
                for other in TRUE:
                    np.testing.assert_allclose(told["parameters"][other], [float(row[other]) for row in own])

    def test_profiles_are_drawn_on_a_page(self):
        page = self.folder / "page.html"
        self.infer(self.measured, "--profile", self.folder / "p.csv", "--page", page, run=TABLE1)
        self.assertIn("Profile likelihoods", page.read_text())

    def test_is_the_same_in_every_format_and_whatever_came_before(self):
        alone = json.loads(self.infer(self.measured, "--json", "--posterior"))["posterior"]
        stream = 2 * (self.measured.read_text() + "\n")
        for line in self.infer("--follow", "--posterior", input=stream).splitlines():
            self.assertEqual(json.loads(line)["posterior"], alone)
        rows = list(csv.DictReader(io.StringIO(self.infer(self.measured, "--csv", "--posterior"))))
        for row in rows:
            found = alone["parameters"][row["parameter"]]
            self.assertEqual([float(row["posterior_mean"]), float(row["posterior_sd"])], [found["mean"], found["sd"]])
            self.assertEqual(
                [float(row[f"posterior_q{q}"]) for q in ("2.5", "16", "50", "84", "97.5")],
                [value for _, value in found["quantiles"]],
            )
        text = self.infer(self.measured, "--posterior", "--posterior-from", "surrogate")
        self.assertIn("posterior under the surrogate (effective sample size", text)

    def test_other_maps_use_the_surrogate_that_judges(self):
        run = self.run_experiment("gp", "inverse_map=gp")
        posterior = json.loads(
            self.infer(self.measured, "--json", "--posterior", "--posterior-from", "surrogate", run=run)
        )["posterior"]
        self.assertEqual(posterior["status"], "posterior_uncalibrated")
        self.assertIn("nothing has compared it with true values", posterior["doubt"])
        for name, true in TRUE.items():
            found = posterior["parameters"][name]
            self.assertLess(abs(found["mean"] - true), 4 * found["sd"], name)

    def test_are_right_where_the_run_found_their_ranks_even(self):
        run = self.run_experiment("ranked", "inverse_map=gp", "evaluation.calibration=sbc")
        answer = json.loads(
            self.infer(self.measured, "--json", "--posterior", "--posterior-from", "surrogate", run=run)
        )
        self.assertEqual(answer["posterior"]["status"], "ok")
        self.assertNotIn("posterior_uncalibrated", answer["statuses"])

    def test_errors_say_what_to_do(self):
        silent = self.run_experiment("silent", "inverse_map=gp", "noise.stddev.y=0", "transform=[z_score]")
        for arguments, expected in (
            (
                [silent, self.measured, "--posterior-from", "surrogate"],
                "give every output noise and train with 'inverse_map: surrogate'",
            ),
            ([silent, self.measured, "--posterior-from", "simulator"], "give every output that features read"),
            ([self.run_folder, self.measured, "--posterior-from", "map"], "--posterior-from"),
            ([self.run_folder, self.measured, "--posterior=10"], "at least 200 draws, not 10"),
            ([self.run_folder, self.measured, "--draws", "d.csv"], "--draws requires --posterior"),
            ([self.run_folder, self.measured, "--posterior", "--draws", self.folder / "no/d.csv"], "cannot be written"),
            ([TABLE1, self.measured, "--profile", self.folder / "no/p.csv"], "cannot be written"),
            ([TABLE1, self.measured, "--joint", "--profile", "p.csv"], "one measurement at a time"),
            (
                [self.run_folder, self.measured, "--profile", "p.csv", "--posterior-from", "surrogate"],
                "--profile is of the simulator",
            ),
        ):
            result = call("infer", *arguments)
            self.assertNotEqual(result.returncode, 0)
            self.assertIn(expected, result.stderr)


class Calibration(FolderTestCase):
    def run_calibrated(self, name, *overrides):
        result = call(
            "run",
            TABLE1,
            "inverse_map=surrogate",
            "design.train.samples=60",
            "design.test.samples=60",
            "refine=never",
            "evaluation.limit=false",
            "evaluation.calibration=sbc",
            *overrides,
            "--out",
            self.folder / name,
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        return result, self.folder / name

    def test_ranks_the_truth_of_each_test_sample_on_any_number_of_threads(self):
        (_, one), (_, three) = (self.run_calibrated(f"threads{n}", "--threads", str(n)) for n in (1, 3))
        self.assertEqual((one / "sbc.csv").read_bytes(), (three / "sbc.csv").read_bytes())
        rows = read_csv(one / "sbc.csv")
        self.assertEqual([row["quantity"] for row in rows[::10]], [*TRUE, "joint"])
        for first in range(0, len(rows), 10):
            bins = rows[first : first + 10]
            self.assertEqual(sum(int(row["count"]) for row in bins), int(bins[0]["measurements"]))
            self.assertEqual(int(bins[0]["measurements"]) + int(bins[0]["unreliable"]), 60)
            self.assertGreater(float(bins[0]["p_value"]), 1e-4)
        self.assertIn("Calibration of the posteriors", (one / "report.html").read_text())

    def test_says_why_there_is_none(self):
        result, run = self.run_calibrated("few", "design.test.samples=40")
        self.assertIn("40 of 40 test samples have a reliable posterior, 50 are needed", result.stderr + result.stdout)
        self.assertFalse((run / "sbc.csv").exists())
        result, run = self.run_calibrated("silent", "inverse_map=gp", "noise.stddev.y=0", "transform=[z_score]")
        self.assertIn(
            "the calibration of posteriors is not tested: the run has no surrogate",
            result.stderr + result.stdout + (run / "run.log").read_text(),
        )
