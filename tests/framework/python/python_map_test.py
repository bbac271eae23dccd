"""Maps in Python: predict like scikit-learn, infer like the command."""
import ctypes
import json
import os
import threading
import unittest

import h5py
import numpy as np
import pandas as pd

import twinmap
from package_support import FolderTestCase, run_once
from support import call

TRUE = {"d_y": 0.95, "d_theta": 2.1e-4, "k_y": 8.5, "k_theta": 0.034}
PAYLOAD = """
name: payload
parameters: {k: {bounds: [80, 120], unit: N/m}}
inputs: {payload: {bounds: [0, 1], unit: kg}}
system:
  bodies: {cart: {mass: 2 + payload, joint: {type: slider, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: k}]
  dampers: [{coordinate: x, damping: 1}]
initial: {coordinates: {x: 0.1}}
outputs: {x: {coordinate: x}}
simulation: {duration: 2}
features: [{samples: {outputs: [x], start: 0.02, interval: 0.02, count: 100}}]
noise: {stddev: {x: 1e-3}}
design: {train: {samples: 60}, test: {samples: 60}}
evaluation: {limit: false}
"""


class TwoBeams(FolderTestCase):
    @classmethod
    def setUpClass(cls):
        cls.experiment, cls.results = run_once()
        cls.map = twinmap.Map.load(cls.results.folder)
        cls.measurement = cls.experiment.simulate(TRUE, noise=True)
        with h5py.File(cls.results.folder / "samples.h5") as file:  # (n, outputs, times)
            responses = file["test/responses"][:]
        cls.features = cls.experiment.extract(responses.reshape(len(responses), -1))


class Predicting(TwoBeams):
    def test_mean_and_standard_deviation_of_each_row(self):
        mean, stddev = self.map.predict(self.features, return_std=True)
        self.assertEqual(mean.shape, (len(self.features), 4))
        self.assertEqual(stddev.shape, mean.shape)
        np.testing.assert_array_equal(self.map.predict(self.features), mean)
        for row in range(5):
            answer = self.map.infer(self.features[row], refine=False)
            np.testing.assert_array_equal(mean[row], answer.mean)
            np.testing.assert_array_equal(stddev[row], answer.stddev)

    def test_forms_and_threads_make_no_difference(self):
        rows = np.tile(self.features, (20, 1))
        expected = self.map.predict(rows)
        for other in [np.asfortranarray(rows), rows.tolist(), pd.DataFrame(rows)]:
            np.testing.assert_array_equal(self.map.predict(other), expected)
        np.testing.assert_array_equal(self.map.predict(rows, threads=3), expected)
        self.assertEqual(self.map.predict(rows[:0]).shape, (0, 4))
        with self.assertRaisesRegex(ValueError, r"X: must be an array of shape \(n, 200\)"):
            self.map.predict(rows[:, :7])

    def test_does_as_the_library_does(self):
        library = ctypes.CDLL(os.environ["TWINMAP_LIBRARY"])
        handle = ctypes.c_void_p()
        self.assertEqual(library.twinmap_open(os.fsencode(self.results.folder), ctypes.byref(handle)), 0)
        mean, stddev = np.empty((2, len(self.features), 4))
        pointers = [array.ctypes.data_as(ctypes.POINTER(ctypes.c_double)) for array in (self.features, mean, stddev)]
        self.assertEqual(
            library.twinmap_predict(handle, pointers[0], None, ctypes.c_size_t(len(mean)), 1, *pointers[1:]), 0
        )
        library.twinmap_close(handle)
        for by_python, by_library in zip(self.map.predict(self.features, return_std=True), (mean, stddev)):
            np.testing.assert_array_equal(by_python, by_library)


class Inferring(TwoBeams):
    def test_finds_the_parameters(self):
        answer = self.map.infer(self.measurement.to_frame())
        self.assertEqual(answer.statuses, ["ok"])
        for name, true in TRUE.items():
            mean, stddev = answer[name]
            self.assertLess(abs(mean - true), 4 * stddev, name)
        np.testing.assert_allclose(np.sqrt(np.diag(answer.covariance)), answer.stddev, rtol=1e-9)
        np.testing.assert_array_equal(answer.covariance, answer.covariance.T)
        np.testing.assert_allclose(answer.interval.mean(axis=1), answer.mean)
        np.testing.assert_allclose(np.ptp(answer.interval, axis=1), 3.919928 * answer.stddev, rtol=1e-6)
        self.assertEqual(list(answer.to_frame().columns), ["unit", "mean", "stddev", "lower", "upper"])
        with self.assertRaisesRegex(KeyError, "d_y, d_theta"):
            answer["k_x"]

    def test_samples_the_posterior_where_it_is_asked_for(self):
        frame = self.measurement.to_frame()
        self.assertIsNone(self.map.infer(frame).posterior)
        answer = self.map.infer(frame, refine=False, posterior=1000, posterior_from="surrogate")
        self.assertEqual((answer.method, answer.posterior.source), ("gp", "surrogate"))
        posterior = answer.posterior
        self.assertTrue(posterior.reliable)
        self.assertGreater(posterior.effective_sample_size, 100)
        self.assertLess(posterior.pareto_shape, 0.7)
        names = list(TRUE)
        self.assertEqual([list(posterior.draws.columns), list(posterior.quantiles.columns)], [names, names])
        self.assertEqual(posterior.draws.shape, (len(posterior.weights), 4))
        self.assertAlmostEqual(posterior.weights.sum(), 1)
        np.testing.assert_array_equal(posterior.interval, posterior.quantiles.loc[[0.025, 0.975]].to_numpy().T)
        told = answer.details["posterior"]["parameters"]
        np.testing.assert_array_equal(posterior.mean, [told[name]["mean"] for name in names])
        np.testing.assert_array_equal(posterior.stddev, [told[name]["sd"] for name in names])
        self.assertTrue((np.abs(posterior.mean - list(TRUE.values())) < 5 * posterior.stddev).all())
        with self.assertRaisesRegex(twinmap.ExperimentError, "at least 200 draws, not 10"):
            self.map.infer(frame, posterior=10)
        with self.assertRaisesRegex(ValueError, "'simulator' or 'surrogate', not 'map'"):
            self.map.infer(frame, posterior_from="map")

    def test_an_experiment_and_its_run_sample_the_same_posterior_on_the_simulator(self):
        frame = self.measurement.to_frame()
        by_run = self.map.infer(frame, refine=False, posterior_from="simulator")
        alone = twinmap.Experiment.from_yaml(self.map.to_yaml()).infer(frame)
        for answer in (by_run, alone):
            self.assertEqual((answer.status, answer.method, answer.posterior.source), ("ok", "posterior", "simulator"))
            self.assertTrue((np.abs(answer.mean - list(TRUE.values())) < 5 * answer.stddev).all())
            self.assertEqual(answer.components, [])
            self.assertEqual(answer.details["parameters"], answer.details["posterior"]["parameters"])
            np.testing.assert_allclose(np.sqrt(np.diag(answer.covariance)), answer.stddev)
        self.assertTrue((np.abs(by_run.mean - alone.mean) < 0.3 * alone.stddev).all())
        self.assertIn("sampled on the simulator", repr(alone))

    def test_profiles_are_given_where_they_are_asked_for(self):
        frame = self.measurement.to_frame()
        self.assertEqual(self.map.infer(frame).profiles, {})
        for answer in (
            self.map.infer(frame, profiles=True),
            twinmap.Experiment.from_yaml(self.map.to_yaml()).infer(frame, profiles=True),
        ):
            self.assertEqual(list(answer.profiles), list(TRUE))
            for name, profile in answer.profiles.items():
                self.assertEqual(list(profile.columns), [*TRUE, "log_likelihood_ratio"])
                self.assertTrue((np.diff(profile[name]) > 0).all())
                ratios = profile.log_likelihood_ratio
                self.assertLess(max(ratios.iloc[0], ratios.iloc[-1]), -2)
                self.assertLess(ratios.abs().min(), 0.3)
        with self.assertRaisesRegex(ValueError, "leave posterior_from out"):
            self.map.infer(frame, profiles=True, posterior_from="surrogate")

    def test_of_an_experiment_without_a_possible_simulation_nothing_is_believed(self):
        experiment = twinmap.Experiment.from_yaml(self.map.to_yaml())
        with self.assertRaisesRegex(twinmap.ExperimentError, "noise.stddev"):
            experiment.override("noise.stddev.y=0", "transform=[z_score]").infer(self.measurement.to_frame())

    def test_shows_itself(self):
        answer = self.map.infer(self.measurement.to_frame())
        self.assertRegex(repr(answer), r"^measurement: ok \(chi-square ")
        self.assertIn("<table", answer._repr_html_())
        self.assertIn("k_theta", repr(self.map))

    def test_is_the_commands_answer(self):
        path = self.folder / "m.csv"
        self.measurement.to_frame().to_csv(path, index=False)
        for refine, options in [(None, []), (False, ["--no-refine"]), (True, ["--refine"])]:
            expected = json.loads(call("infer", self.results.folder, path, "--json", *options).stdout)
            answer = self.map.infer(path, refine=refine)
            self.assertEqual(answer.details, expected)
            self.assertEqual(answer.method, expected["method"])
            self.assertEqual(answer.trust["p_value"], expected["trust"]["p_value"])

    def test_measurements_may_come_in_many_forms(self):
        frame = self.measurement.to_frame()
        expected = self.map.infer(frame, refine=False)
        path = self.folder / "m.csv"
        frame.to_csv(path, index=False)
        millimetres = frame.assign(**{"y [mm]": 1e3 * frame.y, "comment": "x"}).drop(columns="y")
        for form in [
            path,
            str(path),
            frame.set_index("t"),
            frame.to_dict("list"),
            millimetres,
            {name: frame[name].to_numpy() for name in frame},
            self.experiment.extract(self.measurement)[0],
        ]:
            answer = self.map.infer(form, refine=False)
            np.testing.assert_allclose(answer.mean, expected.mean, rtol=1e-9)
        later = frame.assign(t=frame.t + 10)
        np.testing.assert_allclose(self.map.infer(later, start=10, refine=False).mean, expected.mean, rtol=1e-6)

    def test_says_what_is_wrong_with_a_measurement(self):
        frame = self.measurement.to_frame()
        for wrong, text in [
            (frame.drop(columns="theta"), "no column 'theta'"),
            (frame.assign(y=np.nan), "has no number in any row"),
            (frame.assign(y=np.inf), "finite"),
            ({"t": [[0.0]], "y": [1.0], "theta": [1.0]}, "one dimension"),
            (np.zeros(3), "200 finite numbers"),
            ("missing.csv", "missing.csv"),
        ]:
            with self.assertRaisesRegex(twinmap.MeasurementError, text):
                self.map.infer(wrong)
        with self.assertRaisesRegex(twinmap.ExperimentError, "not an input"):
            self.map.infer(frame, known={"payload": 1})
        with self.assertRaisesRegex(RuntimeError, "does not exist"):
            twinmap.Map.load("missing")

    def test_samples_that_are_missing_are_left_out(self):
        frame = self.measurement.to_frame()
        frame.loc[10:11, "y"] = np.nan
        estimate = self.map.infer(frame[:50])
        self.assertEqual((estimate.status, estimate.method), ("ok", "posterior"))
        self.assertEqual(len(estimate.details["left_out"]), 2)
        with self.assertRaisesRegex(twinmap.MeasurementError, "finite"):
            self.map.infer(frame, refine=False)

    def test_a_wrong_model_is_noticed(self):
        heavier = self.experiment.override("constants.m1.value=4").simulate(TRUE, noise=True)
        self.assertEqual(self.map.infer(heavier.to_frame()).status, "model_mismatch")

    def test_four_threads_get_the_same(self):
        frame = self.measurement.to_frame()
        expected, found = self.map.infer(frame), []

        def work():
            for _ in range(20):
                found.append(self.map.infer(frame).mean)
                found.append(self.map.predict(self.features[:1])[0])
                twinmap.Map.load(self.results.folder)

        threads = [threading.Thread(target=work) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(found), 160)
        first = self.map.predict(self.features[:1])[0]
        for mean in found:
            self.assertTrue((mean == expected.mean).all() or (mean == first).all())


class KnownInputs(FolderTestCase):
    def test_known_inputs_come_with_the_measurement(self):
        experiment = twinmap.Experiment.from_yaml(PAYLOAD)
        map_ = experiment.run(self.folder / "run").map
        responses = experiment.simulate({"k": [90, 110], "payload": [0.25, 0.75]}, noise=True)
        answer = map_.infer(responses.to_frame(1), known={"payload": 0.75}, refine=False)
        self.assertLess(abs(answer.mean[0] - 110), 4 * answer.stddev[0])
        features = experiment.extract(responses)
        mean, stddev = map_.predict(features, return_std=True, inputs={"payload": [0.25, 0.75]})
        np.testing.assert_allclose(mean[1], answer.mean, rtol=1e-9)
        self.assertLess(abs(mean[0, 0] - 90), 4 * stddev[0, 0])
        same = map_.predict(np.tile(features[1], (3, 1)), inputs=[[0.75]])
        np.testing.assert_allclose(same, np.tile(mean[1], (3, 1)), rtol=1e-12)
        for known, text in [
            (None, "'payload' is not given"),
            ({"payload": 3}, "within the bounds"),
            ({"load": 0.5}, "not an input"),
        ]:
            with self.assertRaisesRegex(twinmap.ExperimentError, text):
                map_.infer(responses.to_frame(1), known=known)
