"""twinmap compare and verify: two runs side by side, and a run against what it is recomputed to be."""
import csv
import io
import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import yaml

TWINMAP = os.environ["TWINMAP"]
TABLE1 = os.path.join(os.environ["TWINMAP_SOURCE_DIR"], "experiments/two_beam/table1.yaml")
SMALL = ["design.train.samples=40", "design.test.samples=30", "inverse_map.gp.starts=1"]


def call(*arguments):
    return subprocess.run([TWINMAP, *map(str, arguments)], capture_output=True, text=True, timeout=300)


def read_csv(text):
    return list(csv.DictReader(io.StringIO(text)))


class TestCase(unittest.TestCase):
    """Runs are made once for all tests of a class; `copy` gives a test one of its own to damage."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="twinmap_compare_")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)

    @classmethod
    def run_experiment(cls, name, *arguments, file=TABLE1):
        result = call("run", file, *SMALL, *arguments, "--out", cls.folder / name)
        assert result.returncode == 0, result.stderr

    def copy(self, name):
        target = self.folder / self.id()
        shutil.copytree(self.folder / name, target)
        return target

    def assert_wrong_input(self, *arguments, message):
        result = call(*arguments)
        self.assertEqual(result.returncode, 2, result)
        self.assertIn(message, result.stderr + result.stdout)


class Compare(TestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.run_experiment("a")
        cls.run_experiment("b", "noise.scale=0.5")
        cls.run_experiment("other_seed", "seed=2")
        experiment = yaml.safe_load(Path(TABLE1).read_text())
        del experiment["parameters"]["d_y"]
        experiment["constants"]["d_y"] = 1.0
        (cls.folder / "three.yaml").write_text(yaml.safe_dump(experiment, sort_keys=False))
        cls.run_experiment("three", file=cls.folder / "three.yaml")

    def compare(self, a, b, *options):
        result = call("compare", self.folder / a, self.folder / b, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr, "")
        return result.stdout

    def read_metrics(self, run):
        return {row["parameter"]: row for row in read_csv((self.folder / run / "metrics.csv").read_text())}

    def test_figures_are_those_of_both_runs_with_an_interval_of_their_difference(self):
        metrics_a, metrics_b = self.read_metrics("a"), self.read_metrics("b")
        rows = read_csv(self.compare("a", "b", "--csv"))
        figures = ["bias_pct", "sd_pct", "mare_pct", "coverage95", "nlpd", "crps_pct"]
        figures += [name for name in ("limit_pct", "ratio_to_limit") if name in metrics_a["d_y"]]
        self.assertEqual([(row["parameter"], row["figure"]) for row in rows],
                         [(parameter, figure) for parameter in metrics_a for figure in figures])
        for row in rows:
            a, b = (float(metrics[row["parameter"]][row["figure"]]) for metrics in (metrics_a, metrics_b))
            self.assertEqual((float(row["a"]), float(row["b"])), (a, b), row)
            self.assertAlmostEqual(float(row["difference"]), b - a, 12)
            self.assertEqual(row["paired"], "1")
            if row["figure"] == "coverage95":
                self.assertEqual((row["lower"], row["upper"]), ("", ""))
            else:
                self.assertLess(float(row["lower"]), b - a)
                self.assertGreater(float(row["upper"]), b - a)
        k_theta = next(row for row in rows if (row["parameter"], row["figure"]) == ("k_theta", "crps_pct"))
        self.assertLess(float(k_theta["upper"]), 0)  # half the noise

    def test_pairs_tell_more_than_independent_sets(self):
        paired, independent = (
            {(row["parameter"], row["figure"]): row for row in read_csv(self.compare("a", other, "--csv"))}
            for other in ("b", "other_seed"))
        self.assertEqual({row["paired"] for row in independent.values()}, {"0"})
        for figure in ("nlpd", "crps_pct"):
            widths = [float(rows["k_theta", figure]["upper"]) - float(rows["k_theta", figure]["lower"])
                      for rows in (paired, independent)]
            self.assertLess(2 * widths[0], widths[1])
        self.assertIn("The test sets are not the same (the true d_y of test sample 0 is ", self.compare("a", "other_seed"))
        self.assertIn("Both inferred the same 30 test samples", self.compare("a", "b"))

    def test_names_the_keys_that_differ(self):
        self.assertRegex(self.compare("a", "b"), r"\nnoise\.scale +1 +0\.5\n$")
        self.assertEqual(json.loads(self.compare("a", "other_seed", "--json"))["keys"],
                         [{"key": "seed", "a": "1", "b": "2"}])
        self.assertIn("The experiments are the same.", self.compare("a", "a"))

    def test_a_run_does_not_differ_from_itself(self):
        for row in read_csv(self.compare("a", "a", "--csv")):
            self.assertEqual(float(row["difference"]), 0)
            self.assertIn(row["lower"], ("0", ""))

    def test_parameters_that_only_one_run_has_are_named(self):
        self.assertIn("Only A has d_y.\n", self.compare("a", "three"))
        compared = json.loads(self.compare("three", "a", "--json"))
        self.assertEqual((compared["a"]["only"], compared["b"]["only"]), ([], ["d_y"]))
        self.assertEqual([parameter["name"] for parameter in compared["parameters"]], ["d_theta", "k_y", "k_theta"])

    def test_says_the_same_each_time(self):
        self.assertEqual(self.compare("a", "other_seed"), self.compare("a", "other_seed"))

    def test_folders_that_are_no_finished_run_are_wrong_input(self):
        run = self.folder / "a"
        self.assert_wrong_input("compare", run, message="B is required")
        self.assert_wrong_input("compare", run, run, "--csv", "--json", message="--csv excludes --json")
        self.assert_wrong_input("compare", run, self.folder / "nowhere", message="nowhere: there is no such folder")
        self.assert_wrong_input("compare", self.folder, run, message="is no folder of a run: it has no resolved.yaml")
        unfinished = self.copy("a")
        (unfinished / "provenance.json").unlink()
        self.assert_wrong_input("compare", run, unfinished, message="the run in it is not finished")
        sweep = self.folder / "sweep"
        (sweep / "cases/first").mkdir(parents=True)
        self.assert_wrong_input("compare", sweep, run, message=f"name one of its cases, such as {sweep}/cases/first")

    def test_damaged_predictions_are_a_located_failure(self):
        run = self.copy("a")
        lines = (run / "predictions.csv").read_text().splitlines()
        lines[3] = lines[3].replace("k_y", "k_z")
        (run / "predictions.csv").write_text("\n".join(lines) + "\n")
        result = call("compare", self.folder / "a", run)
        self.assertEqual(result.returncode, 1)
        self.assertIn("predictions.csv:4: parameter 'k_z' must be 'k_y'", result.stderr)


if __name__ == "__main__":
    unittest.main()
