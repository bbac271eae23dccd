"""A run whose map is a network: what it leaves, and what is inferred with it."""
import filecmp
import json
import unittest

from support import EXPERIMENTS, OwnFolderTestCase, call, read_csv

BEST = EXPERIMENTS / "two_beam/best.yaml"
SMALL = ["design.train.samples=60", "design.test.samples=60", "refine=never", "evaluation.limit=false"]
TAUGHT = "inverse_map={network: {steps: 1500, surrogate_samples: 4000}}"
DIRECT = "inverse_map={network: {samples_from: simulations, steps: 200, hidden: [16]}}"


class Network(OwnFolderTestCase):
    def run_experiment(self, name, *arguments):
        result = call("run", BEST, *SMALL, *arguments, "--out", self.folder / name)
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.folder / name

    def test_learns_from_a_surrogate_and_writes_its_evaluation(self):
        run = self.run_experiment("run", TAUGHT)
        self.assertIn("the network learns from a surrogate", (run / "run.log").read_text())
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
        run = self.run_experiment("run", TAUGHT)
        measured = self.folder / "measured.csv"
        given = {"k_y": 8.0, "k_theta": 0.04}
        overrides = [f"parameters.{name}={value}" for name, value in given.items()]
        self.assertEqual(call("simulate", BEST, *overrides, "--csv", measured).returncode, 0)
        (run / "maps.h5").rename(self.folder / "maps.h5")
        result = call("infer", self.folder / "maps.h5", measured, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        answer = json.loads(result.stdout)
        self.assertEqual(answer["status"], "ok")
        for name, value in given.items():
            found = answer["parameters"][name]
            self.assertLess(abs(found["mean"] - value), 4 * found["sd"], name)

    def test_learns_from_simulations_and_is_verified_by_training_it_again(self):
        run = self.run_experiment("run", DIRECT)
        self.assertIn("the network learns from the simulations: asked for", (run / "run.log").read_text())
        result = call("verify", run)
        self.assertEqual(result.returncode, 0, result.stderr + result.stdout)
        self.assertIn("ok       maps.h5: fitted again", result.stdout)

    def test_features_that_are_not_linear_have_their_noise_drawn_in_the_response(self):
        features = "features=[{statistics: {outputs: [y, theta], quantities: [rms, mean], " \
                   "window: {start: 0.05, interval: 0.05, count: 100}}}]"
        run = self.run_experiment("statistics", DIRECT, features, "transform=[z_score]")
        self.assertEqual(len(read_csv(run / "metrics.csv")), 4)

    def test_bad_keys_are_named(self):
        for keys, message in [("{hidden: []}", "must give 1 to 8 hidden layers"),
                              ("{hidden: [2000]}", "must give 1 to 8 hidden layers"),
                              ("{surrogate_samples: 10}", "must give at least 1000 surrogate_samples"),
                              ("{samples_from: nothing}", "samples_from")]:
            result = call("run", BEST, f"inverse_map={{network: {keys}}}", "--out", self.folder / "bad")
            self.assertNotEqual(result.returncode, 0)
            self.assertIn(message, result.stderr)

    def test_fewer_simulations_than_a_network_needs_are_refused(self):
        result = call("run", BEST, *SMALL, DIRECT, "design.train.samples=30", "--out", self.folder / "few")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("a network needs at least 50 training samples", result.stderr)


if __name__ == "__main__":
    unittest.main()
