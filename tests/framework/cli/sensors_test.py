"""Outputs and sample times are chosen by what they tell about the parameters."""
import itertools
import math
import unittest

from support import EXPERIMENTS, FolderTestCase, call, read_csv

CRANE = EXPERIMENTS / "crane/sensors.yaml"
OUTPUTS = ["y", "theta", "y_speed", "theta_speed", "cart_acceleration", "load_acceleration", "load_y", "load_z"]


def overrides(outputs, count, times=None):
    candidates = f"outputs: [{', '.join(outputs)}], count: {count}" + (f", times: {times}" if times else "")
    return [f"design.sensors.candidates={{{candidates}}}", "design.sensors.average_over=16"]


class Sensors(FolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.design = cls.folder / "design"
        cls.result = cls.choose(cls.design, *overrides(OUTPUTS, 3, 40))

    @classmethod
    def choose(cls, folder, *arguments, file=CRANE):
        result = call("design", "sensors", file, *arguments, "--out", folder)
        assert result.returncode == 0, result.stderr
        return result

    def test_the_chosen_three_are_nearly_the_best_of_all_triples(self):
        costs = {}
        for triple in itertools.combinations(OUTPUTS, 3):
            self.choose(self.folder / "triple", *overrides(triple, 3))
            costs[triple] = float(read_csv(self.folder / "triple/sensors.csv")[2]["criterion"])
        row = read_csv(self.design / "sensors.csv")[2]
        chosen = tuple(row["outputs"].split())
        self.assertAlmostEqual(costs[chosen], float(row["criterion"]), places=9)
        self.assertLess(math.exp((costs[chosen] - min(costs.values())) / 2), 1.05)  # in standard deviations

    def test_each_further_output_and_time_tells_more(self):
        for name, count in (("sensors.csv", 8), ("times.csv", 10)):
            rows = read_csv(self.design / name)
            self.assertEqual(len(rows), count)
            criteria = [float(row["criterion"]) for row in rows]
            self.assertEqual(criteria, sorted(criteria, reverse=True))
        sensors, times = read_csv(self.design / "sensors.csv"), read_csv(self.design / "times.csv")
        self.assertEqual(int(times[-1]["count"]), 40)
        self.assertGreater(float(times[-1]["criterion"]), float(sensors[2]["criterion"]))  # 40 of 100 times

    def test_parameters_that_stay_undetermined_are_named_with_what_they_are_confused_with(self):
        self.assertIn("k_left", self.result.stderr)
        self.assertIn("k_right", self.result.stderr)

    def test_the_designed_experiment_has_the_limit_that_was_foretold(self):
        run = self.folder / "run"
        result = call(
            "run",
            self.design / "designed.yaml",
            "design.train.samples=60",
            "design.test.samples=60",
            "refine=never",
            "inverse_map=surrogate",
            "--out",
            run,
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(read_csv(run / "features.csv")), 3 * 40)
        predicted = read_csv(self.design / "times.csv")[-1]
        middle = {"m_cart": 2, "m_load": 0.5, "length": 0.4, "d_cart": 3}
        for row in read_csv(run / "methods.csv"):
            if row["parameter"] in middle:
                limit = float(row["limit_pct"]) / 100 * middle[row["parameter"]]
                self.assertAlmostEqual(float(predicted[f"sd_{row['parameter']}"]) / limit, 1, delta=0.2)

    def test_the_page_shows_choice_curves_and_times(self):
        page = (self.design / "sensors.html").read_text()
        for text in ("What each further output buys", "What further sample times buy", "When to measure"):
            self.assertIn(text, page)

    def test_wrong_input_is_named(self):
        for arguments, message in (
            (overrides(["y", "nothing"], 1), "nothing"),
            (overrides(["y", "y"], 2), "is listed twice"),
            (overrides(["y", "theta"], 1, 1000), "must be at most 100, the sample times of the features"),
            (overrides(["y", "theta"], 3), "must not ask for more outputs than there are"),
            ([*overrides(["y", "load_y"], 1), "noise.stddev.load_y=0"], "an output with noise.stddev above 0"),
            (
                [
                    "features=[{statistics: {outputs: [y], quantities: [rms], "
                    "window: {start: 0.1, interval: 0.1, count: 30}}}]"
                ],
                "must be samples at the same times",
            ),
        ):
            result = call("design", "sensors", CRANE, *arguments, "--out", self.folder / "wrong")
            self.assertNotEqual(result.returncode, 0)
            self.assertIn(message, result.stderr)
        result = call("design", "sensors", EXPERIMENTS / "two_beam/table1.yaml", "--out", self.folder / "wrong")
        self.assertIn("needs the key 'design.sensors'", result.stderr)
