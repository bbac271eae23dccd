"""The twinmap command from outside: exit codes, messages, and what a run leaves in its folder."""
import csv
import fcntl
import filecmp
import json
import os
import shutil
import statistics
import subprocess
import time
import unittest

import h5py
import numpy as np
import yaml

from support import EXPERIMENTS, TWINMAP, OwnFolderTestCase, call, read_csv, run_once, wait_until

TABLE1 = EXPERIMENTS / "two_beam/table1.yaml"
CART = EXPERIMENTS / "duffing/cart.yaml"
CHAIN = EXPERIMENTS / "three_mass_chain"
SMALL = ["design.train.samples=40", "design.test.samples=20"]
NO_LIMIT = "evaluation.limit=false"  # a stencil of simulations less at each test point
RESULTS = [
    "correlations.csv",
    "failures.csv",
    "features.csv",
    "hyperparameters.csv",
    "identifiability.csv",
    "joint.csv",
    "maps.h5",
    "metrics.csv",
    "pit.csv",
    "predictions.csv",
    "resolved.yaml",
    "responses.csv",
    "samples.h5",
    "table.md",
    "table.tex",
    "track_power.csv",
    "training.csv",
    "trust_power.csv",
]


def read_table(lines):
    return np.array([[float(x) for x in row] for row in list(csv.reader(lines))[1:]])


class TestCase(OwnFolderTestCase):
    def run_experiment(self, name, *arguments, file=TABLE1, small=SMALL):
        result = call("run", file, *small, *arguments, "--out", self.folder / name)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result


class Check(TestCase):
    def test_prints_the_resolved_experiment_which_checks_as_itself(self):
        resolved = call("check", TABLE1, "noise.scale=2")
        self.assertEqual(resolved.returncode, 0, resolved.stderr)
        self.assertIn("  scale: 2\n", resolved.stdout)
        path = self.folder / "resolved.yaml"
        path.write_text(resolved.stdout)
        self.assertEqual(call("check", path).stdout, resolved.stdout)


class Schema(TestCase):
    def test_knows_every_key_of_a_resolved_experiment(self):
        schema = json.loads(call("schema").stdout)
        experiment = yaml.safe_load(call("check", TABLE1).stdout)
        self.assertEqual(unknown_keys(experiment, schema, ""), [])
        self.assertEqual(unknown_keys({"noise": {"scal": 1}}, schema, ""), ["noise.scal"])


def unknown_keys(value, schema, path):
    """Paths of the keys that the schema does not name."""
    if isinstance(value, list):
        return [key for item in value for key in unknown_keys(item, schema.get("items", {}), path + "[]")]
    if not isinstance(value, dict):
        return []
    options = [option for option in [schema, *schema.get("oneOf", [])] if option.get("type") == "object"]
    if not options:
        return [path]
    unknown = []
    for key, item in value.items():
        below = options[0].get("properties", {}).get(key, options[0]["additionalProperties"])
        unknown += unknown_keys(item, below, f"{path}.{key}".strip(".")) if below else [f"{path}.{key}".strip(".")]
    return unknown


class ExitCodes(TestCase):
    def assert_wrong_input(self, *arguments, message):
        result = call(*arguments)
        self.assertEqual(result.returncode, 2, result)
        self.assertIn(message, result.stderr + result.stdout)

    def test_wrong_usage_and_wrong_experiments_are_2(self):
        self.assert_wrong_input("infre", message="no command is called 'infre'; did you mean 'infer'?")
        self.assert_wrong_input("run", message="FILE is required")
        self.assert_wrong_input("run", TABLE1, "--threads", "0", message="--threads")
        self.assert_wrong_input("check", TABLE1, "--bogus", message="--bogus")
        self.assert_wrong_input("check", "/no/such/file.yaml", message="/no/such/file.yaml")
        self.assert_wrong_input("check", TABLE1, "noise.scal=1", message="did you mean 'scale'?")
        self.assert_wrong_input("simulate", TABLE1, "parameters.k_z=1", message="did you mean 'k_y'?")
        self.assert_wrong_input("simulate", TABLE1, "parameters.k_y=much", message="'much' must be a number")

    def test_help_and_version_are_0(self):
        for arguments in (["--help"], ["--version"], ["run", "--help"], ["simulate", "--help"]):
            self.assertEqual(call(*arguments).returncode, 0)

    def test_alone_it_lists_its_commands(self):
        result = call()
        self.assertEqual((result.returncode, result.stdout), (2, ""))
        for line in ("From a model to an estimate:", "  infer ", "twinmap run experiments/duffing/cart.yaml"):
            self.assertIn(line, result.stderr)

    def test_check_abbreviates_long_tables_unless_asked_for_all(self):
        times = [round(0.1 * i, 1) for i in range(40)]
        table = f"excitation.F={{unit: N, tables: [{{times: {times}, values: {times}}}]}}"
        short = call("check", CART, table)
        self.assertIn("times: [40 values, 0 .. 3.9], values: [40 values, 0 .. 3.9]", short.stdout)
        self.assertIn("check --full prints all values", short.stdout)
        whole = self.folder / "whole.yaml"
        whole.write_text(call("check", CART, table, "--full").stdout)
        self.assertEqual(call("check", whole, "--full").returncode, 0)
        self.assertNotIn("values, ", whole.read_text())

    def test_a_force_that_jumps_is_named_as_the_reason_of_a_step_limit(self):
        law = "system.force_laws[0].force=F - 5 * sign(x_dot)"
        result = call("simulate", CART, law, "simulation.max_steps=200")
        self.assertEqual(result.returncode, 1)
        self.assertRegex(
            result.stderr, r"step limit of 200 .*force_laws\[0\].*sign\(x_dot\) jumps: give this term as friction"
        )

    def test_bounds_that_contain_0_give_errors_relative_to_the_range_and_a_remark(self):
        few = ["design.train.samples=60", "design.test.samples=20", "evaluation.limit=false", "refine=never"]
        result = call("run", CART, "parameters.d.bounds=[0, 2]", *few, "--out", self.folder / "run")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("the bounds of d contain 0: its errors are in % of its range", result.stderr)

    def test_a_model_that_cannot_exist_is_found_by_check_and_before_a_run(self):
        path = self.folder / "heavy.yaml"
        path.write_text(TABLE1.read_text().replace("value: 0.13,", "value: -0.13,"))
        line = next(i for i, text in enumerate(path.read_text().splitlines(), 1) if "mass: m2" in text)
        for command in (
            ["check", path],
            ["run", path, *SMALL, "--out", self.folder / "run"],
            ["check", path, "noise.scale=1,2"],
        ):
            self.assert_wrong_input(
                *command,
                message="at the centre of the bounds: body 'beam2': mass = -0.13 kg " "must be positive",
            )
            self.assert_wrong_input(*command, message=f"{path}:{line}:")
        self.assertFalse((self.folder / "run").exists())
        self.assert_wrong_input(
            "check", TABLE1, "system.bodies.beam1.mass=-1", message="command line: system.bodies.beam1.mass:"
        )

    def test_an_initial_state_that_cannot_be_is_found_by_check(self):
        self.assert_wrong_input(
            "check",
            CART,
            "system.force_laws[0].force=F + sqrt(x - 1)",
            message="the accelerations of the initial state are not finite",
        )
        for at in ("box_center", "sample"):
            self.assert_wrong_input(
                "check",
                CART,
                "system.force_laws[0].force=F + 1e3 + 1e9 * x^4",
                f"initial={{equilibrium: {{at: {at}}}}}",
                message="static equilibrium not found",
            )

    def test_a_model_that_always_fails_stops_the_run_after_a_dozen(self):
        many = ["design.train.samples=3000", "design.test.samples=2000", "simulation.max_steps=3"]
        result = call("run", TABLE1, *many, "--out", self.folder / "run")
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, "the first 12 train simulations all failed: step limit of 3 reached")
        self.assertIn("try one sample: twinmap simulate FILE", result.stderr)

    def test_failures_are_1(self):
        result = call("simulate", TABLE1, "simulation.max_steps=3")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("step limit", result.stderr)
        result = call("run", TABLE1, *SMALL, "simulation.max_steps=3", "--out", self.folder / "run")
        self.assertEqual(result.returncode, 1)
        self.assertIn("the first 12 train simulations all failed: step limit", result.stderr)
        result = call("run", TABLE1, *SMALL, "--out", "/proc/no/such")
        self.assertEqual(result.returncode, 1)


class Terminated(TestCase):
    def test_sigterm_abandons_a_training_under_way(self):
        """With 3000 samples the training takes minutes, one evaluation of its likelihood about a second."""
        command = [
            TWINMAP,
            "run",
            EXPERIMENTS / "two_beam/table1.yaml",
            "design.train.samples=3000",
            "evaluation.limit=false",
            "--out",
            self.folder / "run",
        ]
        child = subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        wait_until((self.folder / "run/failures.csv").exists, child)  # written last before the training
        time.sleep(1.0)
        child.terminate()
        _, message = child.communicate(timeout=60)
        self.assertEqual(child.returncode, 128 + 15, message)
        self.assertIn("interrupted during training", message)
        self.assertFalse((self.folder / "run/maps.h5").exists())


class Simulate(TestCase):
    def test_writes_the_outputs_at_the_features_times(self):
        result = call("simulate", TABLE1, "parameters.k_y=7.5")
        rows = list(csv.reader(result.stdout.splitlines()))
        self.assertEqual(rows[0], ["t", "y", "theta"])
        times = [float(row[0]) for row in rows[1:]]
        np.testing.assert_allclose(times, 0.05 * np.arange(1, 101), rtol=1e-14)
        self.assertEqual(result.stderr, "")

    def test_parameters_default_to_the_box_centre(self):
        centre = ["parameters.k_y=10", "parameters.d_y=1", "parameters.d_theta=2e-4", "parameters.k_theta=0.036"]
        default, at_centre, elsewhere = (
            read_table(call("simulate", TABLE1, *point).stdout.splitlines())
            for point in ([], centre, ["parameters.d_y=1.1"])
        )
        np.testing.assert_allclose(default, at_centre, atol=1e-12)
        self.assertGreater(np.abs(default - elsewhere)[:, 1].max(), 1e-4)

    def test_overrides_may_be_shorter_than_parameters(self):
        self.assertEqual(call("simulate", TABLE1, "seed=3").returncode, 0)

    def test_noise_and_csv_are_as_asked(self):
        out = self.folder / "out.csv"
        self.assertEqual(call("simulate", TABLE1, "--noise", "--csv", out).stdout, "")
        clean = read_table(call("simulate", TABLE1).stdout.splitlines())
        noise = read_table(out.read_text().splitlines()) - clean
        np.testing.assert_allclose(noise[:, 1:].std(axis=0), [5e-5, 0.015], rtol=0.3)


class Run(TestCase):
    def copy_run(self, name):
        """The run of SMALL on two threads, which all tests share, as if it had been run here."""
        folder, result = run_once(TABLE1, *SMALL, "--threads", 2)
        shutil.copytree(folder, self.folder / name)
        return result

    def test_results_are_bitwise_the_same_for_any_number_of_threads(self):
        self.copy_run("t2")
        for threads in (1, 3, 5):
            self.run_experiment(f"t{threads}", "--threads", threads)
        for threads in (2, 3, 5):
            _, different, missing = filecmp.cmpfiles(
                self.folder / "t1", self.folder / f"t{threads}", RESULTS, shallow=False
            )
            self.assertEqual((different, missing), ([], []), threads)

    def test_the_resolved_experiment_gives_the_same_results(self):
        self.run_experiment("a", "seed=3")
        self.run_experiment("b", file=self.folder / "a/resolved.yaml", small=[])
        _, different, missing = filecmp.cmpfiles(self.folder / "a", self.folder / "b", RESULTS, shallow=False)
        self.assertEqual((different, missing), ([], []))

    def test_metrics_follow_from_the_predictions(self):
        result = self.copy_run("run")
        self.assertIn("| k_theta ", result.stdout)
        predictions = read_csv(self.folder / "run/predictions.csv")
        self.assertEqual(len(predictions), 4 * 20)
        for row in read_csv(self.folder / "run/metrics.csv"):
            mine = [p for p in predictions if p["parameter"] == row["parameter"]]
            errors = [100 * (float(p["inferred"]) / float(p["true"]) - 1) for p in mine]
            z = [(float(p["inferred"]) - float(p["true"])) / float(p["stddev"]) for p in mine]
            covered = [abs(value) < 1.959964 for value in z]
            self.assertAlmostEqual(float(row["bias_pct"]), statistics.mean(errors), 9)
            self.assertAlmostEqual(float(row["bias_pct_se"]), statistics.stdev(errors) / 20**0.5, 9)
            self.assertAlmostEqual(float(row["sd_pct"]), statistics.stdev(errors), 9)
            self.assertAlmostEqual(float(row["sd_pct_se"]), jackknife(statistics.stdev, errors), 9)
            self.assertAlmostEqual(float(row["mare_pct"]), statistics.mean(map(abs, errors)), 9)
            self.assertAlmostEqual(float(row["coverage95"]), statistics.mean(covered), 9)
            self.assertAlmostEqual(float(row["z_sd_se"]), jackknife(statistics.stdev, z), 9)
            crps = [
                100 * normal_crps(float(p["inferred"]), float(p["stddev"]), float(p["true"])) / float(p["true"])
                for p in mine
            ]
            self.assertAlmostEqual(float(row["crps_pct"]), statistics.mean(crps), 9)
            limit = [100 * float(p["limit_stddev"]) / float(p["true"]) for p in mine]
            self.assertAlmostEqual(float(row["limit_pct"]), statistics.mean(x**2 for x in limit) ** 0.5, 9)
            self.assertAlmostEqual(float(row["ratio_to_limit"]), float(row["sd_pct"]) / float(row["limit_pct"]), 9)

    def test_the_information_limit_can_be_switched_off(self):
        self.run_experiment("run", "evaluation.limit=false")
        self.assertNotIn("limit_pct", read_csv(self.folder / "run/metrics.csv")[0])
        self.assertFalse((self.folder / "run/features.csv").exists())

    def test_evaluation_writes_what_it_is_asked_for(self):
        asked = (
            "evaluation={posterior: {samples: 2, draws: 250}, "
            "baselines: [prior_mean, linear_regression, {least_squares: {samples: 3}}]}"
        )
        result = self.run_experiment("run", asked)
        self.assertIn("information limit of 20 test samples: ", result.stderr)  # its cost
        run = self.folder / "run"
        posteriors = read_csv(run / "posterior.csv")
        self.assertEqual(len(posteriors), 2 * 4)
        for row in posteriors:
            self.assertGreater(float(row["effective_sample_size"]), 100)
            self.assertAlmostEqual(float(row["limit_stddev"]) / float(row["posterior_stddev"]), 1, delta=0.15)
        baselines = read_csv(run / "baselines.csv")
        methods = [(row["method"], row["samples"]) for row in baselines if row["parameter"] == "k_y"]
        self.assertEqual(
            methods,
            [("map", "20"), ("prior_mean", "20"), ("linear_regression", "20"), ("map", "3"), ("least_squares", "3")],
        )
        error = {row["method"]: float(row["mare_pct"]) for row in baselines if row["parameter"] == "k_y"}
        self.assertLess(error["least_squares"], 0.1)
        self.assertLess(error["linear_regression"], error["prior_mean"])
        features = read_csv(run / "features.csv")
        self.assertEqual([len(features), features[0]["feature"], features[0]["unit"]], [200, "y(0.05 s)", "m"])
        self.assertEqual(
            [row["parameter"] for row in read_csv(run / "correlations.csv")], ["d_y", "d_theta", "k_y", "k_theta"]
        )
        self.assertEqual(len(read_csv(run / "identifiability.csv")), 4)

    def test_parameters_that_nothing_determines_are_named(self):
        unseen = ["parameters.unseen={bounds: [1, 2], unit: m}"]
        result = self.run_experiment("run", *unseen)
        self.assertIn("the data reduce the uncertainty of unseen by only", result.stderr)

    def test_calibration_files_follow_from_predictions_and_map(self):
        self.copy_run("run")
        predictions = read_csv(self.folder / "run/predictions.csv")
        normal = statistics.NormalDist()
        z = np.array([(float(p["inferred"]) - float(p["true"])) / float(p["stddev"]) for p in predictions])
        for name in ("d_y", "k_theta"):
            pit = [1 - normal.cdf(value) for value, p in zip(z, predictions) if p["parameter"] == name]
            counts = [int(row["count"]) for row in read_csv(self.folder / "run/pit.csv") if row["parameter"] == name]
            self.assertEqual(counts, list(np.histogram(pit, bins=10, range=(0, 1))[0]))
        with h5py.File(self.folder / "run/maps.h5") as maps:
            correlation = maps["map/residual_correlation"][:]
        np.testing.assert_array_equal(np.diag(correlation), 1)
        z = z.reshape(20, 4)
        distance = np.einsum("ij,ij->i", z, np.linalg.solve(correlation, z.T).T)
        stddev = np.array([float(p["stddev"]) for p in predictions]).reshape(20, 4)
        nlpd = 0.5 * (distance + np.linalg.slogdet(2 * np.pi * correlation)[1]) + np.log(stddev).sum(axis=1)
        joint = {row["metric"]: row for row in read_csv(self.folder / "run/joint.csv")}
        self.assertAlmostEqual(float(joint["coverage50"]["value"]), np.mean(distance < 3.3566940), 9)  # chi-square of 4
        self.assertAlmostEqual(float(joint["coverage95"]["value"]), np.mean(distance < 9.4877290), 9)
        self.assertAlmostEqual(float(joint["nlpd"]["value"]), nlpd.mean(), 9)
        self.assertAlmostEqual(float(joint["nlpd"]["se"]), nlpd.std(ddof=1) / 20**0.5, 9)

    def test_leave_one_out_foretells_the_test_errors(self):
        """With replicates: were the siblings of a draw kept, it would look far better than the test samples."""
        self.run_experiment(
            "run", "noise.replicates=3", NO_LIMIT, small=["design.train.samples=60", "design.test.samples=60"]
        )
        for row in read_csv(self.folder / "run/metrics.csv"):
            difference = abs(float(row["loo_sd_pct"]) - float(row["sd_pct"]))
            self.assertLess(difference, 4 * np.hypot(float(row["loo_sd_pct_se"]), float(row["sd_pct_se"])), row)
            self.assertGreater(float(row["loo_coverage95"]), 0.8)

    def test_maps_file_is_enough_to_predict(self):
        """docs/reference/files.md as numpy: with little noise, features are the clean responses of samples.h5."""
        for length_scales, noise, tolerance in (("shared", "constant", 1e-8), ("per_output", "follows_slope", 1e-4)):
            shutil.rmtree(self.folder / "run", ignore_errors=True)
            scale = 0 if noise == "constant" else 1e-6
            self.run_experiment(
                "run",
                NO_LIMIT,
                f"noise.scale={scale}",
                f"inverse_map.gp.length_scales={length_scales}",
                f"inverse_map.gp.noise={noise}",
                # Close bounds keep the variance from being a small difference of large numbers.
                "inverse_map.gp.bounds={signal_stddev: [0.01, 10], noise_stddev: [0.1, 1]}",
            )
            with h5py.File(self.folder / "run/samples.h5") as samples:
                features = samples["test/responses"][:].reshape(20, -1)
            rows = read_csv(self.folder / "run/predictions.csv")
            with h5py.File(self.folder / "run/maps.h5") as maps:
                self.assertEqual(features.shape[1], len(maps["features/name"]))
                x = transform(maps["map"], features)
                for p, name in enumerate(maps["parameters/name"].asstr()[:]):
                    mean, stddev = predict(maps["map"], p, x)
                    offset, scale = maps["map/target/offset"][p], maps["map/target/scale"][p]
                    mine = [row for row in rows if row["parameter"] == name]
                    inferred, sd = (np.array([float(r[key]) for r in mine]) for key in ("inferred", "stddev"))
                    if maps[f"map/processes/{p}"].attrs["approximation"] == b"exact":
                        np.testing.assert_allclose(offset + scale * mean, inferred, rtol=tolerance)
                        np.testing.assert_allclose(scale * stddev, sd, rtol=100 * tolerance)
                    else:  # compressed: the tables are of the exact process, whose sd it keeps to 2 %
                        self.assertLess(np.max(np.abs(offset + scale * mean - inferred) / sd), 0.02)
                        np.testing.assert_allclose(scale * stddev, sd, rtol=0.02)
                self.assertEqual(maps["map/noise/mean_of_slope"].size, 4 if noise == "follows_slope" else 0)

    def test_every_transform_is_stored_so_that_the_file_is_enough(self):
        """Features z_scored, selected or projected by numpy from maps.h5 are the inputs that the trust model has."""
        for steps, inputs in (
            ("[whiten: {by: covariance}, partial_least_squares]", None),
            ("[whiten, select: {fisher_information: {count: 6}}]", 6),
            ("[select: {mutual_information: {count: 5}}, z_score]", 5),
            ("[select: {features: [theta(1 s), y(0.5 s)]}, z_score]", 2),
        ):
            shutil.rmtree(self.folder / "run", ignore_errors=True)
            self.run_experiment("run", NO_LIMIT, f"transform={steps}", "inverse_map.gp.starts=1", "noise.scale=0.01")
            with h5py.File(self.folder / "run/samples.h5") as samples:
                features = samples["train/responses"][:].reshape(40, -1)
            with h5py.File(self.folder / "run/maps.h5") as maps:
                x, stored = (
                    transform(maps["map"], features),
                    maps["trust/cloud/inputs"][:] * maps["trust/cloud/scale"][:],
                )
                self.assertEqual(x.shape, stored.shape)
                self.assertIn(inputs, (None, x.shape[1]))
                np.testing.assert_allclose(x, stored, rtol=1e-6, atol=1e-9)

    def test_wrong_selections_are_found_before_anything_is_simulated(self):
        result = call(
            "run", TABLE1, "transform=[select: {features: [theta(1 s), theta(1.05s)]}]", "--out", self.folder / "run"
        )
        self.assertEqual(result.returncode, 2)
        self.assertIn("'theta(1.05s)' is not a feature; did you mean 'theta(1.05 s)'?", result.stderr)

    def test_samples_file_is_readable_and_named(self):
        self.copy_run("run")
        with h5py.File(self.folder / "run/samples.h5") as file:
            self.assertEqual(list(file["outputs/name"].asstr()), ["y", "theta"])
            self.assertEqual(list(file["outputs/unit"].asstr()), ["m", "rad"])
            self.assertEqual(file["train/responses"].shape, (40, 2, 100))
            self.assertEqual(file["train/parameters"].shape, (40, 4))
            self.assertTrue(np.isfinite(file["train/responses"]).all())
            lower, upper = file["parameters/lower"][:], file["parameters/upper"][:]
            points = file["train/parameters"][:]
            slices = np.sort(np.floor(40 * (points - lower) / (upper - lower)).astype(int), axis=0)
            self.assertTrue((slices == np.arange(40)[:, None]).all())  # a Latin hypercube

    def test_failed_samples_are_reported_and_shift_no_other(self):
        heavy = [
            NO_LIMIT,
            "parameters.m={bounds: [-0.5, 6], unit: kg, relative_to: range}",
            "constants.m1=m",
            "simulation.allowed_failures=0.5",
        ]
        result = self.run_experiment("run", *heavy)
        self.assertIn("samples could not be simulated", result.stderr)
        failures = read_csv(self.folder / "run/failures.csv")
        self.assertGreater(len(failures), 0)
        with h5py.File(self.folder / "run/samples.h5") as file:
            for group in ("train", "test"):
                mass = file[f"{group}/parameters"][:, 4]
                ok = file[f"{group}/ok"][:].astype(bool)
                np.testing.assert_array_equal(ok, mass > 0)
                np.testing.assert_array_equal(ok, np.isfinite(file[f"{group}/responses"]).all(axis=(1, 2)))
                listed = [int(f["sample"]) for f in failures if f["set"] == group]
                self.assertEqual(listed, list(np.flatnonzero(~ok)))
            true_mass = file["test/parameters"][:, 4]
        for failure in failures:
            self.assertIn("mass", failure["reason"])
        for row in read_csv(self.folder / "run/predictions.csv"):
            if row["parameter"] == "m":
                self.assertEqual(float(row["true"]), true_mass[int(row["sample"])])
        self.assertIn(
            f"{len(failures)} of the samples could not be simulated", (self.folder / "run/report.html").read_text()
        )
        self.assertEqual(json.loads((self.folder / "run/provenance.json").read_text())["failed_samples"], len(failures))

    def test_samples_that_lack_a_feature_fail_with_a_reason(self):
        """The second maximum of y lies within the window for stiff springs alone."""
        peaks = [
            NO_LIMIT,
            "features=[{samples: {outputs: [y, theta], start: 0.05, interval: 0.05, count: 100}}, "
            "{extrema: {output: y, window: {start: 0.05, interval: 0.01, count: 496}, kind: maxima, peaks: 2}}]",
            "simulation.allowed_failures=0.9",
        ]
        result = self.run_experiment("run", *peaks)
        self.assertIn("samples could not be simulated", result.stderr)
        failures = read_csv(self.folder / "run/failures.csv")
        self.assertEqual({f["set"] for f in failures}, {"train", "test"})
        for failure in failures:
            self.assertRegex(failure["reason"], "feature 'y maximum [12] value' is missing in the response")
        with h5py.File(self.folder / "run/samples.h5") as file:
            self.assertTrue(np.isfinite(file["test/responses"]).all())  # they were simulated
            true_stiffness = file["test/parameters"][:, 2]
        lacking = {int(f["sample"]) for f in failures if f["set"] == "test"}
        present = set(range(20)) - lacking
        self.assertLess(true_stiffness[list(lacking)].max(), true_stiffness[list(present)].min() + 0.5)
        rows = [row for row in read_csv(self.folder / "run/predictions.csv") if row["parameter"] == "k_y"]
        self.assertEqual({int(row["sample"]) for row in rows}, present)
        for row in rows:
            self.assertEqual(float(row["true"]), true_stiffness[int(row["sample"])])

    def test_training_is_reported_start_by_start(self):
        self.run_experiment(
            "run", NO_LIMIT, "inverse_map.gp.starts=3", "inverse_map.gp.length_scale_prior={log_stddev: 1}"
        )
        rows = read_csv(self.folder / "run/training.csv")
        self.assertEqual(
            [(r["parameter"], r["start"]) for r in rows if r["parameter"] == "k_y"],
            [("k_y", "0"), ("k_y", "1"), ("k_y", "2")],
        )
        nlml = {r["parameter"]: float(r["nlml"]) for r in read_csv(self.folder / "run/metrics.csv")}
        for row in rows:
            if row["best"] == "1":
                self.assertAlmostEqual(float(row["nlml"]), nlml[row["parameter"]], 6)
                self.assertGreater(float(row["condition"]), 1)

    def assert_same_results(self, a, b):
        _, different, missing = filecmp.cmpfiles(self.folder / a, self.folder / b, RESULTS, shallow=False)
        self.assertEqual((different, missing), ([], []))

    def count_reused(self, name):
        return json.loads((self.folder / name / "provenance.json").read_text())["reused_samples"]

    def test_killed_and_continued_gives_the_same_files(self):
        self.copy_run("undisturbed")
        child = subprocess.Popen(
            [TWINMAP, "run", TABLE1, *SMALL, "--out", self.folder / "run"],
            stderr=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
        )
        while child.poll() is None and not list(self.folder.glob("run/chunks/*/*.chunk")):
            time.sleep(0.002)
        child.kill()
        child.wait()
        self.assertFalse((self.folder / "run/metrics.csv").exists())
        self.run_experiment("run")
        self.assertGreater(self.count_reused("run"), 0)
        self.assert_same_results("run", "undisturbed")
        result = self.run_experiment("run")
        self.assertIn("40 of the train samples had been simulated before", result.stderr)
        self.assertEqual(self.count_reused("run"), 60)
        self.assert_same_results("run", "undisturbed")

    def test_runs_share_a_store_whatever_the_noise_and_the_map(self):
        store = ["--store", self.folder / "store"]
        nested = ["design.train.method=nested_latin_hypercube"]
        self.run_experiment("a", *nested, *store, NO_LIMIT)
        self.run_experiment("b", *nested, *store, NO_LIMIT, "noise.scale=3", "inverse_map.gp.covariance=matern52")
        self.run_experiment("c", *nested, *store, "design.train.samples=50")
        self.assertEqual([self.count_reused(run) for run in "abc"], [0, 60, 60])
        self.run_experiment("alone", *nested, "design.train.samples=50")
        self.assert_same_results("c", "alone")
        self.assertFalse((self.folder / "a/chunks").exists())
        self.run_experiment("d", *nested, *store, NO_LIMIT, "constants.m1=3.4")
        self.assertEqual(self.count_reused("d"), 0)

    def test_damaged_chunks_are_reported_and_simulated_again(self):
        self.copy_run("a")
        self.copy_run("b")
        chunk = next((self.folder / "b").glob("chunks/*/*.chunk"))
        data = bytearray(chunk.read_bytes())
        data[len(data) // 2] ^= 8
        chunk.write_bytes(data)
        result = self.run_experiment("b")
        self.assertIn(f"{chunk}.set-aside: set aside: its checksum is wrong", result.stderr)
        self.assert_same_results("a", "b")

    def test_a_folder_in_use_is_refused(self):
        (self.folder / "run").mkdir()
        with open(self.folder / "run/lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            lock.write(str(os.getpid()))
            lock.flush()
            result = call("run", TABLE1, *SMALL, "--out", self.folder / "run")
        self.assertEqual(result.returncode, 1)
        self.assertIn(f"{self.folder / 'run'}: is in use by process {os.getpid()};", result.stderr)

    def test_failed_gates_are_named_and_fail_the_run_where_asked(self):
        gates = "gates=[{metric: coverage95, min: 0}, {metric: sd_pct, parameter: k_y, max: 1e-9}]"
        result = self.run_experiment("run", NO_LIMIT, gates)
        self.assertIn("gate failed: sd_pct \u2264 1e-09, k_y", result.stderr)
        self.assertNotIn("coverage95", result.stderr)
        self.assertEqual(call("report", self.folder / "run", "--fail-on-gates").returncode, 3)
        self.assertEqual(call("report", self.folder / "run").returncode, 0)
        result = call("check", TABLE1, "gates=[{metric: coverage, min: 0}]")
        self.assertEqual(result.returncode, 2)
        self.assertIn("'coverage' is not a metric", result.stderr)

    def test_the_report_is_made_again_from_the_folder_alone(self):
        self.copy_run("run")
        first = (self.folder / "run/report.html").read_bytes()
        shutil.move(self.folder / "run", self.folder / "moved")
        self.assertEqual(call("report", self.folder / "moved").returncode, 0)
        self.assertEqual((self.folder / "moved/report.html").read_bytes(), first)
        result = call("report", self.folder / "moved", self.folder / "moved", "--out", self.folder / "both")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("2 runs side by side", (self.folder / "both/report.html").read_text())
        result = call("report", self.folder / "nowhere")
        self.assertEqual(result.returncode, 1)
        self.assertIn("is not a folder of a run", result.stderr)

    def test_examples_of_updated_models_fit_their_measurement(self):
        self.copy_run("run")
        rows = read_csv(self.folder / "run/responses.csv")
        self.assertEqual(len(rows), 3 * 2 * 100)
        with h5py.File(self.folder / "run/samples.h5") as file:
            clean = file["test/responses"][:]
        for name in ("best", "median", "worst"):
            mine = [row for row in rows if row["case"] == name]
            noise, measured, nominal, updated = (
                np.array([float(row[column]) for row in mine])
                for column in ("noise_stddev", "measured", "nominal", "updated")
            )
            truth = clean[int(mine[0]["sample"])].ravel()  # output by output, as the rows
            self.assertAlmostEqual(np.std((measured - truth) / noise), 1, delta=0.25)
            self.assertLess(np.std((measured - updated) / noise), np.std((measured - nominal) / noise))

    def test_provenance_says_how(self):
        self.copy_run("run")
        provenance = json.loads((self.folder / "run/provenance.json").read_text())
        self.assertEqual(provenance["threads"], 2)
        self.assertEqual(provenance["seed"], 1)
        self.assertIn("design.train.samples=40", provenance["command"])
        self.assertEqual(len(provenance["seconds"]), 9)
        self.assertEqual(provenance["online"]["updates"], 20)
        self.assertGreaterEqual(provenance["online"]["p99_us"], provenance["online"]["median_us"])
        self.assertGreater(provenance["peak_memory_mb"], 1)
        self.assertEqual([p.name for p in (self.folder / "run").glob("*.tmp")], [])

    def test_threads_are_those_of_openmp_by_default(self):
        result = call(
            *("run", TABLE1, *SMALL, NO_LIMIT, "--out", self.folder / "run"),
            env={**os.environ, "OMP_NUM_THREADS": "3"},
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(json.loads((self.folder / "run/provenance.json").read_text())["threads"], 3)


def jackknife(figure, values):
    without = [figure(values[:i] + values[i + 1 :]) for i in range(len(values))]
    return ((len(values) - 1) * statistics.pvariance(without)) ** 0.5


def normal_crps(mean, stddev, truth):
    """Gneiting and Raftery (2007)."""
    z, normal = (truth - mean) / stddev, statistics.NormalDist()
    return stddev * (z * (2 * normal.cdf(z) - 1) + 2 * normal.pdf(z) - np.pi**-0.5)


class ThreeMassChain(TestCase):
    """A linear system, updated from its modes and from frequency response functions, in small."""

    def assert_updates_well(self, name, sd_pct):
        for row in read_csv(self.folder / name / "metrics.csv"):
            self.assertLess(float(row["sd_pct"]), sd_pct, row["parameter"])  # that of the prior is 12 %
            self.assertGreater(float(row["coverage95"]), 0.75, row["parameter"])

    def test_is_updated_from_its_modes_without_a_simulation_in_time(self):
        self.run_experiment(
            "run", file=CHAIN / "modes.yaml", small=["design.train.samples=100", "design.test.samples=60"]
        )
        self.assert_updates_well("run", 6)
        with h5py.File(self.folder / "run/samples.h5") as file:
            self.assertEqual(file["test/responses"].shape, (60, 0, 0))
            points, frequencies = file["test/parameters"][:], file["test/natural_frequencies"][:]
            damping_ratios = file["test/damping_ratios"][:]
        for point, frequency, damping in zip(points, frequencies, damping_ratios):
            values = chain_eigenvalues(*point)
            np.testing.assert_allclose(frequency, np.abs(values) / (2 * np.pi), rtol=1e-8)
            np.testing.assert_allclose(damping, -values.real / np.abs(values), rtol=1e-7)

    def test_is_updated_from_frequency_response_functions(self):
        self.run_experiment(
            "run",
            file=CHAIN / "frequency_response.yaml",
            small=["design.train.samples=100", "design.test.samples=40", NO_LIMIT],
        )
        self.assert_updates_well("run", 6)

    def test_modes_are_simulated_as_a_table(self):
        result = call("simulate", CHAIN / "modes.yaml", "parameters.k1=900")
        rows = list(csv.reader(result.stdout.splitlines()))
        self.assertEqual(rows[0], ["mode", "frequency", "damping_ratio"])
        values = chain_eigenvalues(900, 1000, 1000, 10)
        np.testing.assert_allclose([float(row[1]) for row in rows[1:]], np.abs(values) / (2 * np.pi), rtol=1e-8)
        both = call(
            "simulate",
            CHAIN / "frequency_response.yaml",
            "noise.modes={frequency: 0.1, damping_ratio: 0.1}",
            "features=[{modes: {count: 1}}, {samples: {outputs: [mass1], start: 0, interval: 0.1, count: 100}}]",
        )
        outputs, modes = both.stdout.split("\n\n")
        self.assertEqual(len(outputs.splitlines()), 101)
        self.assertEqual(len(modes.splitlines()), 2)

    def test_an_excitation_without_energy_is_a_located_error(self):
        result = call(
            "run",
            CHAIN / "frequency_response.yaml",
            "features[0].frequency_response.frequencies=[0.5, 6.5]",
            "--out",
            self.folder / "run",
        )
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("frequencies[1]: '6.5' is a frequency at which excitation 'F' has no energy", result.stderr)


def chain_eigenvalues(k1, k2, k3, d):
    """Those with positive imaginary part, by increasing magnitude, of M x'' + C x' + K x = 0."""
    chain = np.array([[2, -1, 0], [-1, 2, -1], [0, -1, 1]])
    stiffness = np.array([[k1 + k2, -k2, 0], [-k2, k2 + k3, -k3], [0, -k3, k3]])
    inverse_mass = np.diag([1 / 2, 1, 1 / 0.5])
    a = np.block([[np.zeros((3, 3)), np.eye(3)], [-inverse_mass @ stiffness, -inverse_mass @ chain * d]])
    values = np.linalg.eigvals(a)
    values = values[values.imag > 0]
    return values[np.argsort(np.abs(values))]


def transform(maps, features):
    for i in range(int(maps["transform/steps"][()])):
        step = maps[f"transform/{i}"]
        features = (features - step["offset"][:]) / step["scale"][:]
        if step["projection"].size:
            features = features @ step["projection"][:].T
    return features


def predict(map_, parameter, x):
    """Mean and standard deviation of the standardised parameter, from docs/reference/files.md."""
    group = map_[f"processes/{parameter}"]
    assert group.attrs["covariance"] == b"squared_exponential" and group.attrs["mean"] == b"constant"
    exact = group.attrs["approximation"] == b"exact"
    inputs, weights = (map_["training_inputs"], group["alpha"]) if exact else (group["inducing"], group["weights"])
    signal, noise = group["signal_stddev"][()], group["noise_stddev"][()]
    k = covary(group, inputs[:], x)
    v = np.linalg.solve(group["factor" if exact else "inducing_factor"][:], k.T)
    if exact:
        basis = np.linalg.solve(group["factor"][:], np.ones(len(inputs)))
        rest = (1 - basis @ v) ** 2 / (basis @ basis)
    else:
        a = np.linalg.solve(group["correction_factor"][:], v)
        gap = np.linalg.solve(group["basis_factor"][:], 1 - group["whitened_basis"][:].reshape(1, -1) @ a / noise)
        rest = (a**2).sum(axis=0) + (gap**2).sum(axis=0)
    variance = signal**2 - (v**2).sum(axis=0) + rest
    slope = np.ones(len(x))
    if map_["noise/mean_of_slope"].size:
        changes = [
            (covary(group, inputs[:], x + l) - covary(group, inputs[:], x - l)) @ weights[:]
            for l in map_["noise/directions"][:]
        ]
        slope = np.maximum((np.array(changes) ** 2).sum(axis=0) / 4 / map_["noise/mean_of_slope"][parameter], 0.1)
    return k @ weights[:] + group["mean_coefficients"][0], np.sqrt(variance + noise**2 * slope)


def covary(group, inputs, x):
    groups = group["length_scale_groups"][:]
    scales = group["length_scales"][:][groups if groups.size else np.zeros(inputs.shape[1], int)]
    distance = (((x[:, None, :] - inputs[None, :, :]) / scales) ** 2).sum(axis=2)
    return group["signal_stddev"][()] ** 2 * np.exp(-0.5 * distance)
