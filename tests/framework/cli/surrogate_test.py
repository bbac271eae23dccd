"""A run whose inverse map is a surrogate: what it leaves, and what says that it is not kept yet."""
import filecmp
import unittest

from support import EXPERIMENTS, OwnFolderTestCase, call, read_csv

TABLE1 = EXPERIMENTS / "two_beam/table1.yaml"
SMALL = ["inverse_map={surrogate: {}}", "design.train.samples=60", "design.test.samples=30"]


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
        self.assertFalse((run / "maps.h5").exists())
        self.assertTrue((run / "report.html").exists())

    def test_results_do_not_depend_on_the_threads(self):
        one, three = (self.run_experiment(f"threads{n}", "--threads", str(n)) for n in (1, 3))
        names = ["predictions.csv", "metrics.csv", "cross_validation.csv"]
        self.assertEqual(filecmp.cmpfiles(one, three, names, shallow=False), (names, [], []))

    def test_measurements_are_refused_with_the_reason(self):
        run = self.run_experiment("run")
        result = call("infer", run, "any.csv")
        self.assertEqual(result.returncode, 1)
        self.assertIn("is a surrogate, which is not kept yet", result.stderr)

    def test_verification_says_what_it_leaves_out(self):
        result = call("verify", self.run_experiment("run"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("a surrogate is not kept", result.stdout)

    def test_a_feature_without_noise_is_named_as_the_reason(self):
        result = call("run", TABLE1, *SMALL, "noise.stddev.y=0", "--out", self.folder / "silent")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("the surrogate cannot be trained: the noise of a feature is 0", result.stderr)


if __name__ == "__main__":
    unittest.main()
