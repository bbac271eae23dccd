"""Several maps compared on the same samples."""
import json
import unittest

from support import EXPERIMENTS, FolderTestCase, call, read_csv

TABLE1 = EXPERIMENTS / "two_beam/table1.yaml"
SMALL = ["design.train.samples=60", "design.test.samples=60", "refine=never"]
NETWORK = "{network: {samples_from: simulations, steps: 100, hidden: [8]}}"
PARAMETERS = ["d_y", "d_theta", "k_y", "k_theta"]


class Maps(FolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.run_folder = cls.folder / "run"
        result = call(
            "run",
            TABLE1,
            *SMALL,
            "inverse_map=surrogate",
            "evaluation.limit=true",
            f"evaluation.maps=[surrogate, gp, {NETWORK}, {NETWORK}]",
            "--out",
            cls.run_folder,
        )
        assert result.returncode == 0, result.stderr
        cls.rows = read_csv(cls.run_folder / "maps.csv")

    def test_each_has_a_row_for_each_parameter(self):
        names = ["surrogate", "gp", "network", "network_2"]
        self.assertEqual(
            [(row["map"], row["parameter"]) for row in self.rows],
            [(name, parameter) for name in names for parameter in PARAMETERS],
        )
        for row in self.rows:
            for column in ("training_seconds", "online_us", "ratio_to_limit"):
                self.assertGreater(float(row[column]), 0, column)
            self.assertEqual(int(row["bytes"]), (self.run_folder / f"maps/{row['map']}.h5").stat().st_size)

    def test_figures_are_those_of_a_run_with_that_map(self):
        for row, alone in zip(self.rows, read_csv(self.run_folder / "metrics.csv")):
            for column in ("bias_pct", "sd_pct", "limit_pct", "ratio_to_limit", "coverage95", "nlpd"):
                self.assertEqual(row[column], alone[column])
        joint = {row["metric"]: row["value"] for row in read_csv(self.run_folder / "joint.csv")}
        self.assertEqual(self.rows[0]["joint_nlpd"], joint["nlpd"])
        one, other = (
            [row[c] for row in self.rows if row["map"] == name for c in ("sd_pct", "nlpd")]
            for name in ("network", "network_2")
        )
        self.assertEqual(one, other)

    def test_each_can_infer(self):
        measured = self.folder / "measured.csv"
        self.assertEqual(call("simulate", TABLE1, "parameters.k_y=8", "--csv", measured).returncode, 0)
        for name in ("gp", "network"):
            result = call("infer", self.run_folder / f"maps/{name}.h5", measured, "--json")
            self.assertEqual(result.returncode, 0, result.stderr)
            found = json.loads(result.stdout)["parameters"]["k_y"]
            self.assertLess(abs(found["mean"] - 8), 0.1)  # few simulations, and the bounds are 5 and 15

    def test_the_report_shows_them(self):
        report = (self.run_folder / "report.html").read_text()
        self.assertIn("Which estimator", report)
        self.assertIn("network_2", report)

    def test_what_cannot_be_trained_is_named_and_left_out(self):
        run = self.folder / "few"
        result = call(
            "run", TABLE1, *SMALL, "design.train.samples=30", f"evaluation.maps=[gp, {NETWORK}]", "--out", run
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(
            "the estimator network is not compared: the network cannot be trained: a network needs at least 50 training samples",
            (run / "run.log").read_text() + result.stderr + (run / "provenance.json").read_text(),
        )
        self.assertEqual({row["map"] for row in read_csv(run / "maps.csv")}, {"gp"})
