"""A run whose map is a surrogate: what it leaves, and what is inferred with it."""
import filecmp
import re
import unittest

from support import EXPERIMENTS, OwnFolderTestCase, call, read_csv

TABLE1 = EXPERIMENTS / "two_beam/table1.yaml"
SMALL = ["inverse_map=surrogate", "design.train.samples=60", "design.test.samples=30"]


class Surrogate(OwnFolderTestCase):
    def run_experiment(self, name, *arguments):
        result = call("run", TABLE1, *SMALL, *arguments, "--out", self.folder / name)
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.folder / name

    def test_writes_its_evaluation_and_what_cross_validation_says(self):
        run = self.run_experiment("run")
        metrics = read_csv(run / "metrics.csv")
        for row, validated in zip(metrics, read_csv(run / "cross_validation.csv"), strict=True):
            self.assertEqual(row["parameter"], validated["parameter"])
            self.assertGreater(float(row["coverage95"]), 0.8)
            self.assertGreater(float(row["loo_coverage95"]), 0.9)
            self.assertGreater(float(validated["stddev_scale"]), 0)
            self.assertEqual(validated["status"], "ok")
        self.assertEqual({row["method"] for row in read_csv(run / "methods.csv")}, {"surrogate"})
        self.assertTrue((run / "report.html").exists())

    def test_results_do_not_depend_on_the_threads(self):
        one, three = (self.run_experiment(f"threads{n}", "--threads", str(n)) for n in (1, 3))
        names = ["predictions.csv", "metrics.csv", "cross_validation.csv"]
        self.assertEqual(filecmp.cmpfiles(one, three, names, shallow=False), (names, [], []))

    def test_infers_measurements_from_its_file_alone(self):
        self.expect_inference_from_the_file_alone(self.run_experiment("run"), TABLE1, sds=3)

    def test_is_verified_by_training_it_again(self):
        result = call("verify", self.run_experiment("run"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("ok       maps.h5: fitted again", result.stdout)

    def test_a_feature_without_noise_is_named_as_the_reason(self):
        result = call("run", TABLE1, *SMALL, "noise.stddev.y=0", "--out", self.folder / "silent")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("the surrogate cannot be trained: the noise of a feature is 0", result.stderr)

    def test_the_automatic_map_is_a_surrogate_where_one_can_be_trained(self):
        few = ["inverse_map=automatic", "design.test.samples=20"]
        for name, overrides, method in [
            ("enough", ["design.train.samples=40"], "surrogate"),
            ("too_few", ["design.train.samples=20"], "gp"),
            ("silent", ["design.train.samples=40", "noise.stddev.y=0"], "gp"),
        ]:
            run = self.folder / name
            result = call("run", TABLE1, *few, *overrides, "transform=[z_score]", "--out", run)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual({row["method"] for row in read_csv(run / "methods.csv")}, {method}, name)

    def test_an_automatic_number_of_samples_is_recorded_and_taken_again(self):
        automatic = ["design.train.samples=automatic", "evaluation.limit=false"]
        run = self.run_experiment("automatic", *automatic)
        log = (run / "run.log").read_text()
        samples = int(re.search(r"training samples: (\d+) \(automatic\)", log)[1])
        self.assertIn(samples, [100, 200, 400, 800])
        self.assertIn("samples: automatic", (run / "resolved.yaml").read_text())
        self.assertIn(f"<dd>{samples}, chosen automatically</dd>", (run / "report.html").read_text())
        before = (run / "predictions.csv").read_bytes()
        self.assertEqual(call("verify", run).returncode, 0)
        self.assertEqual(call("verify", run, "--all").returncode, 0)
        self.run_experiment("automatic", *automatic)
        self.assertEqual((run / "predictions.csv").read_bytes(), before)
        fixed = self.run_experiment(
            "fixed",
            f"design.train={{method: nested_latin_hypercube, samples: {samples}, smallest: 100}}",
            "evaluation.limit=false",
        )
        self.assertEqual((fixed / "predictions.csv").read_bytes(), before)

    def test_a_sweep_chooses_the_samples_of_each_case(self):
        swept = ["design.train.samples=automatic", "evaluation.limit=false", "noise.scale=0.5,1"]
        alone = self.run_experiment("alone", *swept[:2])
        plan = call("plan", TABLE1, *SMALL, *swept)
        self.assertIn("800 training samples, the most there may be", plan.stdout)
        sweep = self.run_experiment("sweep", *swept)
        cases = sorted((sweep / "cases").iterdir())
        self.assertEqual(len(cases), 2)
        self.assertEqual((cases[1] / "predictions.csv").read_bytes(), (alone / "predictions.csv").read_bytes())
