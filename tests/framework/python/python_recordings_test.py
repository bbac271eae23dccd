"""Several recordings in Python: one estimate, whether they agree, and what a model lacks."""
import json
import unittest

import pandas as pd

import twinmap
from package_support import FolderTestCase
from support import EXPERIMENTS, call

CART = """
name: cart
parameters:
  k: {bounds: [80, 120], unit: N/m}
  d: {bounds: [0.5, 2], unit: N s/m}
system:
  bodies: {cart: {mass: 2, joint: {type: slider, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: k}]
  dampers: [{coordinate: x, damping: d}]
  force_laws: [{coordinate: x, force: FORCE}]
outputs: {x: {coordinate: x}}
simulation: {duration: 2}
features: [{samples: {outputs: [x], start: 0.02, interval: 0.02, count: 100}}]
noise: {stddev: {x: 1e-3}}
TRIALS
"""
TRIALS = """
excitation: {F: {unit: N, pulses: [{amplitude: 0, start: 0, end: 9}]}}
trials:
  free: {initial: {coordinates: {x: 0.05}}}
  step: {excitation: {F: {unit: N, pulses: [{amplitude: 4, start: 0, end: 9}]}}}
"""
FREE = "initial: {coordinates: {x: 0.05}}"


def describe(force, rest):
    return CART.replace("FORCE", force).replace("TRIALS", rest)


class Recordings(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.path = self.folder / "cart.yaml"
        self.path.write_text(describe("F", TRIALS))

    def measure(self, trial, k=95.0):
        experiment = twinmap.Experiment.from_file(self.path, trial=trial)
        return experiment.simulate({"k": k, "d": 1.2}, noise=True, seed=int(k)).to_frame()

    def measure_text(self, text, seed):
        return twinmap.Experiment.from_yaml(text).simulate({"k": 95, "d": 1.2}, noise=True, seed=seed).to_frame()

    def test_segments_have_the_estimate_of_the_command(self):
        levitation = EXPERIMENTS / "mechanisms" / "magnetic_levitation.yaml"
        recording = levitation.with_suffix(".csv")
        expected = json.loads(call("infer", levitation, recording, "--segments", "0.1", "--json").stdout)
        experiment = twinmap.Experiment.from_file(levitation)
        found = experiment.infer_segments(pd.read_csv(recording), 0.1)
        self.assertEqual(found.statuses, ["ok"])
        self.assertEqual(found.details["segments"], expected["segments"])
        for name, one in expected["parameters"].items():
            mean, stddev = found[name]
            self.assertAlmostEqual(mean, one["mean"], delta=1e-9 * abs(one["mean"]))
            self.assertAlmostEqual(stddev, one["sd"], delta=1e-9 * one["sd"])
        self.assertIn("20 segments of 0.1 s", repr(found))
        with self.assertRaisesRegex(ValueError, "length: must be above 0"):
            experiment.infer_segments(recording, -1.0)
        with self.assertRaisesRegex(twinmap.ExperimentError, "at least 200 draws, not 0"):
            experiment.infer_segments(recording, 0.1, draws=0)

    def test_draws_that_are_too_few_are_refused(self):
        recordings = {"free": self.measure("free"), "step": self.measure("step")}
        with self.assertRaisesRegex(twinmap.ExperimentError, "at least 200 draws, not 0"):
            twinmap.infer_together(self.path, recordings, draws=0)

    def test_trials_have_one_estimate_which_is_the_commands(self):
        free, step = self.measure("free"), self.measure("step")
        for name, frame in (("free", free), ("step", step)):
            frame.to_csv(self.folder / f"{name}.csv")
        together = twinmap.infer_together(self.path, {"free": free, "step": [step]})
        self.assertEqual(together.status, "ok", together)
        self.assertTrue(together.agrees)
        self.assertEqual(dict(together.alone), {"free": "ok", "step": "ok"})
        mean, stddev = together["k"]
        self.assertLess(abs(mean - 95), 4 * stddev)
        self.assertEqual(list(together.to_frame().index), ["k", "d"])
        self.assertEqual(together.covariance.shape, (2, 2))
        weighted = (together.draws["k"] * together.weights).sum()
        self.assertAlmostEqual(weighted, mean, delta=1e-6 * abs(mean))
        arguments = ["--trial", f"free={self.folder / 'free.csv'}", "--trial", f"step={self.folder / 'step.csv'}"]
        printed = json.loads(call("infer", self.path, *arguments, "--json").stdout)
        self.assertAlmostEqual(printed["parameters"]["k"]["mean"], mean, delta=1e-9 * abs(mean))

    def test_recordings_that_disagree_say_so(self):
        self.path.write_text(describe("0 * x", FREE))
        other = twinmap.Experiment.from_file(self.path).simulate({"k": 105, "d": 1.2}, noise=True).to_frame()
        same = twinmap.Experiment.from_file(self.path).simulate({"k": 95, "d": 1.2}, noise=True).to_frame()
        together = twinmap.infer_together(self.path, [same, other])
        self.assertIn("trials_disagree", together.statuses)
        self.assertFalse(together.agrees)
        self.assertEqual(together.contradictions.iloc[0]["parameter"], "k")
        with self.assertRaisesRegex(twinmap.ExperimentError, "one recording alone"):
            twinmap.infer_together(self.path, [same])

    def test_a_run_of_all_trials_infers_from_a_recording_of_each(self):
        experiment = twinmap.Experiment.from_file(self.path)
        small = experiment.override(design__train__samples=60, design__test__samples=40)
        trained = small.run(self.folder / "run").map
        self.assertEqual([output.name for output in trained.outputs], ["free.x", "step.x"])
        features = trained.read_trials({"step": self.measure("step"), "free": self.measure("free")})
        self.assertEqual(features.shape, (200,))
        estimate = trained.infer(features)
        self.assertEqual(estimate.status, "ok", estimate)
        mean, stddev = estimate["k"]
        self.assertLess(abs(mean - 95), 4 * stddev)
        simulated = experiment.simulate({"k": 95.0, "d": 1.2}, noise=True)
        self.assertEqual(trained.infer(experiment.extract(simulated)[0]).status, "ok")
        with self.assertRaisesRegex(twinmap.MeasurementError, "one whole recording of each"):
            trained.read_trials({"free": self.measure("free")})
        with self.assertRaisesRegex(twinmap.ExperimentError, "describes the trials free, step"):
            trained.infer(self.measure("free"))

    def test_an_unknown_trial_is_named(self):
        with self.assertRaisesRegex(twinmap.ExperimentError, "swing"):
            twinmap.infer_together(self.path, {"swing": self.measure("free")})

    def test_a_missing_term_is_named_and_accepted(self):
        poor = twinmap.Experiment.from_yaml(describe("0 * x", FREE))
        true = describe("-20000 * x^3", FREE)
        recordings = [self.measure_text(true, seed) for seed in (1, 2)]
        page = self.folder / "lacks.html"
        diagnosis = poor.diagnose(recordings, page=page)
        self.assertIn("What cart lacks", page.read_text())
        self.assertIn("cubic", diagnosis.terms[0])
        self.assertTrue(diagnosis.complete)
        self.assertIn(diagnosis.terms[0], set(diagnosis.to_frame()["term"]))
        self.assertIn(diagnosis.terms[0], diagnosis.details["steps"][0]["candidates"][0]["term"])
        corrected = twinmap.Experiment.from_yaml(diagnosis.corrected)
        self.assertEqual(corrected.infer(recordings[0]).status, "ok")
        self.assertEqual(list(diagnosis.before().index), ["k", "d"])

    def test_blind_spots_come_before_any_measurement(self):
        spots = twinmap.Experiment.from_yaml(describe("0 * x", FREE)).find_blind_spots()
        self.assertGreater(len(spots), 5)
        self.assertLessEqual({"unit", "noticed_from", "k", "d"}, set(spots.columns))
        self.assertTrue(pd.to_numeric(spots["noticed_from"]).dropna().gt(0).all())


if __name__ == "__main__":
    unittest.main()
