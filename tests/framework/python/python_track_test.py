"""A twin in time in Python: the answers of the command, and tables of what is believed."""
import datetime
import json
import unittest

import numpy as np
import pandas as pd

import twinmap
from package_support import SOURCE, FolderTestCase
from support import call

CART = SOURCE / "experiments/duffing/cart.yaml"
TRACKING = {"drift": {"k": {"random_walk": {"stddev": 0.02, "over": 1}}}, "limits": {"k": {"min": 85}}}
TIMED = {"time": {"column": "date"}, "drift": {"k": {"random_walk": {"stddev": 0.02, "over": "1 d"}}}}


class Tracks(FolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.experiment = twinmap.Experiment.from_file(CART)
        # the spring loses 5 N/m before the fifth measurement
        cls.measurements = [
            cls.experiment.simulate({"k": 95 if i < 5 else 90}, noise=True, seed=i).to_frame() for i in range(1, 7)
        ]

    def test_answers_are_those_of_the_command(self):
        section = self.folder / "tracking.yaml"
        section.write_text(json.dumps({"tracking": TRACKING}))
        files = [self.folder / f"m{i}.csv" for i in range(2)]
        for file, measurement in zip(files, self.measurements):
            measurement.to_csv(file, index=False)
        printed = call("track", CART, *files, "--state", self.folder / "a.h5", "--tracking", section)
        self.assertEqual(printed.returncode, 0, printed.stderr)
        with twinmap.Track(CART, self.folder / "b.h5", tracking=section) as track:
            answers = [track.update(file) for file in files]
        self.assertEqual(answers, [json.loads(line) for line in printed.stdout.splitlines()])
        with twinmap.Track(self.experiment, self.folder / "c.h5", tracking=TRACKING) as track:
            for answer, measurement in zip(answers, self.measurements):
                mapping = {name: measurement[name].to_numpy() for name in measurement}
                self.assertEqual(track.update(mapping)["track"]["parameters"], answer["track"]["parameters"])
                self.assertFalse(track.update(measurement)["track"]["counted"])  # the same numbers

    def test_a_change_stands_in_its_tables(self):
        with twinmap.Track(self.experiment, self.folder / "a.h5", tracking=TRACKING) as track:
            answers = [track.update(measurement) for measurement in self.measurements]
            self.assertEqual(len(answers[-1]["track"]["alarms"]), 1)
            (alarm,) = track.alarms.to_dict("records")
            self.assertEqual((alarm["parameter"], alarm["time"], alarm["unit"]), ("k", 5, "N/m"))
            self.assertLess(abs(alarm["size"] + 5), 5 * alarm["stddev"])
            self.assertLess(abs(track.parameters.loc["k", "mean"] - 90), 5 * track.parameters.loc["k", "stddev"])
            sds = np.sqrt(np.diag(track.covariance))
            np.testing.assert_allclose(sds, track.parameters["stddev"].to_numpy(), rtol=1e-9)
            (limit,) = track.forecast.to_dict("records")
            self.assertEqual((limit["parameter"], limit["side"], limit["limit"]), ("k", "min", 85))
            self.assertEqual(track.state["measurements"], 6)
            history = track.history()
            self.assertEqual(len(history), 6 * 3)
            of_k = history[history["parameter"] == "k"].set_index("time")
            self.assertLess(abs(of_k.loc[4, "smoothed_mean"] - 95), 5 * of_k.loc[4, "smoothed_sd"])
            track.write_page(self.folder / "page.html")
            self.assertIn("<svg", (self.folder / "page.html").read_text())
            self.assertIn("6 measurements, 1 alarms", repr(track))

    def test_times_come_by_argument_or_column(self):
        noon = datetime.datetime(2026, 11, 26, 12, tzinfo=datetime.timezone.utc)
        with twinmap.Track(self.experiment, self.folder / "a.h5") as track:
            self.assertEqual(track.update(self.measurements[0], at=noon)["track"]["at"], noon.timestamp())
            self.assertTrue(track.update(self.measurements[1], at="2026-11-25T12:00:00Z")["track"]["late"])
            with self.assertRaisesRegex(twinmap.MeasurementError, "at: 'noon' must be a date"):
                track.update(self.measurements[2], at="noon")
        with twinmap.Track(self.experiment, self.folder / "b.h5", tracking=TIMED) as track:
            dated = self.measurements[0].assign(date=pd.Timestamp("2026-11-26T00:00:00"))
            self.assertEqual(track.update(dated)["track"]["at"], noon.timestamp() - 12 * 3600)
            mapping = {name: dated[name].to_numpy() for name in dated}
            self.assertFalse(track.update(mapping)["track"]["late"])

    def test_a_state_is_gone_on_with_by_one_at_a_time(self):
        track = twinmap.Track(self.experiment, self.folder / "a.h5")
        track.update(self.measurements[0])
        with self.assertRaisesRegex(RuntimeError, "is in use"):
            twinmap.Track(self.experiment, self.folder / "a.h5")
        track.close()
        with self.assertRaisesRegex(RuntimeError, "closed"):
            track.update(self.measurements[1])
        with twinmap.Track(self.experiment, self.folder / "a.h5") as again:
            self.assertEqual(again.update(self.measurements[1])["track"]["measurements"], 2)

    def test_what_cannot_be_used_changes_nothing(self):
        with twinmap.Track(self.experiment, self.folder / "a.h5", tracking=TRACKING) as track:
            with self.assertRaisesRegex(twinmap.MeasurementError, "x"):
                track.update({"t": [0.0, 1.0], "y": [0.0, 1.0]})
            with self.assertRaisesRegex(ValueError, "as many samples"):
                track.update({"t": [0.0, 1.0], "x": [0.0]})
            self.assertEqual(track.state["measurements"], 0)
        with self.assertRaisesRegex(twinmap.ExperimentError, "outside the bounds of 'k'"):
            twinmap.Track(self.experiment, self.folder / "b.h5", tracking={"limits": {"k": {"min": 75}}})


if __name__ == "__main__":
    unittest.main()
