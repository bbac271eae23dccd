"""A run of several experiments with one machine: one estimator of all, and what is made of it."""
import json
import re
import subprocess
import unittest

from support import WEIGHED_MACHINE, WEIGHED_TRIALS, FolderTestCase, call, read_csv

EXPERIMENT = WEIGHED_MACHINE + "design: {train: {samples: 100}, test: {samples: 100}}\n" + WEIGHED_TRIALS
TRUTH = ["parameters.k=95", "parameters.m=1.2"]


class Trials(FolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.file = cls.folder / "weighed.yaml"
        cls.file.write_text(EXPERIMENT)
        cls.run_folder = cls.folder / "run"
        cls.succeed("run", cls.file, "--out", cls.run_folder, "--quiet")
        for trial in ("free", "step"):
            cls.succeed("simulate", cls.file, f"trial={trial}", "--noise", "--csv", cls.folder / f"{trial}.csv", *TRUTH)

    @classmethod
    def succeed(cls, *arguments):
        result = call(*arguments)
        assert result.returncode == 0, result.stderr
        return result.stdout

    def name_recordings(self, *trials):
        return [part for trial in trials for part in ("--trial", f"{trial}={self.folder / trial}.csv")]

    def infer(self, *arguments):
        return json.loads(self.succeed("infer", *arguments, "--json"))

    def test_joint_estimate_is_at_the_limit_of_all(self):
        """The free decay alone sees k / m, so that only both tell k and m."""
        metrics = read_csv(self.run_folder / "metrics.csv")
        self.assertEqual([row["parameter"] for row in metrics], ["k", "m"])
        for row in metrics:
            self.assertLess(abs(float(row["ratio_to_limit"]) - 1.0), 3.5 * float(row["ratio_to_limit_se"]))
            self.assertGreater(float(row["coverage95"]), 0.87)  # 0.95 less 3.5 standard errors
        features = [row["feature"] for row in read_csv(self.run_folder / "features.csv")]
        self.assertEqual(len(features), 68)
        self.assertEqual((features[0], features[-1]), ("free.x(0.05 s)", "step.x(2.9 s)"))

    def test_recordings_of_all_trials_are_inferred_by_the_estimator(self):
        found = self.infer(self.run_folder, *self.name_recordings("step", "free"))
        self.assertEqual((found["status"], found["method"]), ("ok", "refined"))
        together = self.infer(self.file, *self.name_recordings("free", "step"))
        for name, truth in (("k", 95), ("m", 1.2)):
            by_run, by_simulation = found["parameters"][name], together["parameters"][name]
            self.assertLess(abs(by_run["mean"] - truth), 4 * by_run["sd"])
            self.assertLess(abs(by_run["mean"] - by_simulation["mean"]), 0.3 * by_run["sd"])
            self.assertLess(abs(by_run["sd"] / by_simulation["sd"] - 1), 0.15)

    def test_some_trials_or_repeats_are_inferred_by_simulation(self):
        for trials in (["step"], ["step", "step"]):
            result = call("infer", self.run_folder, *self.name_recordings(*trials), "--json")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("inferring by simulation", result.stderr)
            self.assertLess(abs(json.loads(result.stdout)["parameters"]["k"]["mean"] - 95), 5)

    def test_one_recording_without_its_trial_is_refused(self):
        result = call("infer", self.run_folder, self.folder / "free.csv")
        self.assertIn("describes the trials free, step", result.stderr)
        self.assertIn("--trial NAME=FILE", result.stderr)

    def test_run_is_verified(self):
        self.succeed("verify", self.run_folder)

    def test_sweep_has_all_trials_in_each_case_and_shards_make_the_same(self):
        sweep = [self.file, "noise.scale=1,2"]
        whole, sharded = self.folder / "sweep", self.folder / "sharded"
        self.succeed("run", *sweep, "--out", whole, "--quiet")
        errors = [float(row["limit_pct"]) for row in read_csv(whole / "sweep.csv") if row["parameter"] == "k"]
        self.assertAlmostEqual(errors[1] / errors[0], 2.0, delta=0.02)
        plan = self.succeed("submit", *sweep, "--on", "local", "--shards", "2", "--out", sharded)
        for number in range(1 + int(re.findall(r"^seq \d+ (\d+)", plan, re.MULTILINE)[-1])):
            self.succeed("shard", sharded, number)
        self.assertEqual((sharded / "sweep.csv").read_text(), (whole / "sweep.csv").read_text())

    def test_excitation_of_the_next_trial_is_designed_given_the_others(self):
        designed = self.folder / "designed.yaml"
        designed.write_text(
            EXPERIMENT
            + """
  next:
    excitation: {F: {unit: N, sines: [{amplitude: 2, frequency: 1}]}}
"""
        )
        free = "design.excitation={free: {'next.F.sines[0].frequency': [0.5, 3]}, criterion: d_optimal, budget: 60, average_over: 4}"
        self.succeed("design", "excitation", designed, free, "--out", self.folder / "design")
        for row in read_csv(self.folder / "design" / "limits.csv"):
            self.assertLess(float(row["mean_after"]), float(row["mean_before"]))
        chosen = (self.folder / "design" / "designed.yaml").read_text()
        self.assertIn("next:", chosen)
        self.succeed("check", self.folder / "design" / "designed.yaml")

    def test_exported_c_infers_from_the_features_of_all(self):
        code = self.folder / "c"
        self.succeed("export", self.run_folder, "--c", code)
        result = subprocess.run(["make", "test"], cwd=code, capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn("0 differences", result.stdout)


if __name__ == "__main__":
    unittest.main()
