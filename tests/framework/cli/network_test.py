"""A run whose map is a network: what it leaves, and what is inferred with it."""
import filecmp
import json
import re
import unittest

from support import EXPERIMENTS, FolderTestCase, OwnFolderTestCase, call, read_csv, run_once

BEST = EXPERIMENTS / "two_beam/best.yaml"
SMALL = ["design.train.samples=60", "design.test.samples=60", "refine=never", "evaluation.limit=false"]
TAUGHT = "inverse_map={network: {steps: 1500, surrogate_samples: 4000}}"
DIRECT = "inverse_map={network: {samples_from: simulations, steps: 200, hidden: [16]}}"

# Two springs in parallel, of which the response tells the sum alone: what is inferred of each is as good as uniform.
SPRINGS = """
name: parallel_springs
seed: 2
parameters:
  k_left: {bounds: [80, 120]}
  k_right: {bounds: [80, 120]}
  d: {bounds: [1, 2]}
system:
  bodies:
    cart: {mass: 2, joint: {type: slider, axis: [0, 1, 0], coordinates: [y]}}
  springs:
    - {coordinate: y, stiffness: k_left}
    - {coordinate: y, stiffness: k_right}
  dampers:
    - {coordinate: y, damping: d}
initial: {coordinates: {y: 0.1}}
outputs:
  y: {coordinate: y}
simulation: {duration: 2}
features:
  - samples: {outputs: [y], start: 0.05, interval: 0.05, count: 40}
noise:
  stddev: {y: 1e-3}
design:
  train: {method: latin_hypercube, samples: 4000}
  test: {method: uniform, samples: 1500}
inverse_map: {network: {samples_from: simulations, hidden: [8], steps: 1000, batch: 256}}
refine: never
"""


class Undetermined(FolderTestCase):
    """Errors that are not normal."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.file = cls.folder / "springs.yaml"
        cls.file.write_text(SPRINGS)
        cls.trained, cls.result = run_once(cls.file)
        cls.factors = {row["parameter"]: row for row in read_csv(cls.trained / "cross_validation.csv")}

    def test_intervals_hold_what_they_say(self):
        self.assertIn("of the left-out samples; the estimates are not", self.result.stderr)
        rows = read_csv(self.trained / "predictions.csv")
        for row in read_csv(self.trained / "metrics.csv"):
            name = row["parameter"]
            self.assertTrue(0.93 < float(row["coverage95"]) < 0.97, row)
            self.assertTrue(0.45 < float(row["coverage50"]) < 0.55, row)
            factor = float(self.factors[name]["interval_factor95"])
            self.assertTrue(all(float(one["interval_factor95"]) == factor for one in rows if one["parameter"] == name))
            within = [
                abs(float(one["inferred"]) - float(one["true"])) < factor * float(one["stddev"])
                for one in rows
                if one["parameter"] == name
            ]
            self.assertAlmostEqual(sum(within) / len(within), float(row["coverage95"]), places=12)
        for name in ("k_left", "k_right"):
            self.assertLess(float(self.factors[name]["interval_factor95"]), 1.9)

    def test_they_are_those_of_infer_and_of_what_is_exported(self):
        measured = self.folder / "measured.csv"
        self.assertEqual(call("simulate", self.file, "--csv", measured).returncode, 0)
        answer = json.loads(call("infer", self.trained, measured, "--json").stdout)["parameters"]
        for name, row in self.factors.items():
            found, factor = answer[name], float(row["interval_factor95"])
            self.assertAlmostEqual(found["lower"], found["mean"] - factor * found["sd"], places=9)
            self.assertAlmostEqual(found["upper"], found["mean"] + factor * found["sd"], places=9)
        self.assertEqual(
            call("export", self.trained, "--json", self.folder / "map.json", "--c", self.folder / "c").returncode, 0
        )
        expected = [float(row["interval_factor95"]) for row in self.factors.values()]
        self.assertEqual(json.loads((self.folder / "map.json").read_text())["interval_factor"], expected)
        table = re.search(r"interval_factor\[\d+\] = \{([^}]*)\}", (self.folder / "c/twinmap_map.c").read_text()).group(
            1
        )
        self.assertEqual([float(number) for number in table.split(",") if number.strip()], expected)

    def test_the_run_is_verified_and_compared_by_them(self):
        result = call("verify", self.trained)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        result = call("compare", self.trained, self.trained)
        self.assertEqual(result.returncode, 0, result.stderr)
        coverage = float(read_csv(self.trained / "metrics.csv")[0]["coverage95"])
        row = next(line for line in result.stdout.splitlines() if "coverage95" in line)
        self.assertIn(f"{coverage:.5g}", row)


class Network(OwnFolderTestCase):
    def run_experiment(self, name, *arguments):
        result = call("run", BEST, *SMALL, *arguments, "--out", self.folder / name)
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.folder / name

    def test_learns_from_a_surrogate_and_writes_its_evaluation(self):
        run = self.run_experiment("run", TAUGHT)
        self.assertIn("the network is trained on surrogate samples", (run / "run.log").read_text())
        for row, validated in zip(read_csv(run / "metrics.csv"), read_csv(run / "cross_validation.csv"), strict=True):
            self.assertEqual(row["parameter"], validated["parameter"])
            self.assertGreater(float(row["coverage95"]), 0.85)
            self.assertGreater(float(row["loo_coverage95"]), 0.93)
            self.assertGreater(float(validated["stddev_scale"]), 0)
        self.assertEqual({row["method"] for row in read_csv(run / "methods.csv")}, {"network"})
        self.assertTrue((run / "report.html").exists())

    def test_results_do_not_depend_on_the_threads(self):
        for kind in (TAUGHT.replace("1500", "150"), DIRECT):
            one, three = (self.run_experiment(f"{len(kind)}threads{n}", kind, "--threads", str(n)) for n in (1, 3))
            names = ["predictions.csv", "metrics.csv", "cross_validation.csv"]
            self.assertEqual(filecmp.cmpfiles(one, three, names, shallow=False), (names, [], []))

    def test_infers_measurements_from_its_file_alone(self):
        self.expect_inference_from_the_file_alone(self.run_experiment("run", TAUGHT), BEST, sds=4)

    def test_learns_from_simulations_and_is_verified_by_training_it_again(self):
        run = self.run_experiment("run", DIRECT)
        self.assertIn("the network is trained on the simulations: asked for", (run / "run.log").read_text())
        result = call("verify", run)
        self.assertEqual(result.returncode, 0, result.stderr + result.stdout)
        self.assertIn("ok       maps.h5: fitted again", result.stdout)

    def test_features_that_are_not_linear_have_their_noise_drawn_in_the_response(self):
        features = (
            "features=[{statistics: {outputs: [y, theta], quantities: [rms, mean], "
            "window: {start: 0.05, interval: 0.05, count: 100}}}]"
        )
        run = self.run_experiment("statistics", DIRECT, features, "transform=[z_score]")
        self.assertEqual(len(read_csv(run / "metrics.csv")), 4)

    def test_bad_keys_are_named(self):
        for keys, message in [
            ("{hidden: []}", "must give 1 to 8 hidden layers"),
            ("{hidden: [2000]}", "must give 1 to 8 hidden layers"),
            ("{surrogate_samples: 10}", "must give at least 1000 surrogate_samples"),
            ("{samples_from: nothing}", "samples_from"),
        ]:
            result = call("run", BEST, f"inverse_map={{network: {keys}}}", "--out", self.folder / "bad")
            self.assertNotEqual(result.returncode, 0)
            self.assertIn(message, result.stderr)

    def test_fewer_simulations_than_a_network_needs_are_refused(self):
        result = call("run", BEST, *SMALL, DIRECT, "design.train.samples=30", "--out", self.folder / "few")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("a network needs at least 50 training samples", result.stderr)
