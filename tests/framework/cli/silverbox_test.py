"""The Silverbox benchmark, measured by others: its data are not part of the project (docs/tutorials/a-real-recording.md)."""
import csv
import json
import os
import shutil
import unittest
from pathlib import Path

import numpy as np
import yaml

from support import EXPERIMENTS, FolderTestCase, call, read_csv, write_csv

NAME = "Schroeder80mV.csv"
PLACES = [
    os.environ.get("TWINMAP_SILVERBOX", ""),
    EXPERIMENTS / "silverbox" / NAME,
    EXPERIMENTS.parents[1] / "shared/data/silverbox" / NAME,
]
DATA = next((Path(place) for place in PLACES if place and Path(place).is_file()), None)
RATE = 610.3515625
FIRST, PERIOD = 10584, 1024  # the first whole period of the multisine
STARTS = [(FIRST + PERIOD * k) / RATE for k in range(10)]
NOISE = 1e-3


def read_signals():
    with open(DATA, newline="") as file:
        rows = list(csv.reader(file))
    return np.array([[float(row[2]), float(row[3])] for row in rows[1:] if len(row) > 3]).T


@unittest.skipIf(
    DATA is None,
    f"{NAME} of the Silverbox benchmark is not here: docs/tutorials/a-real-recording.md says how to get it; "
    "TWINMAP_SILVERBOX may say where it is",
)
class Silverbox(FolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        shutil.copy(EXPERIMENTS / "silverbox/silverbox.yaml", cls.folder)
        (cls.folder / NAME).symlink_to(DATA.resolve())
        cls.run_folder = cls.train("silverbox.yaml")

    @classmethod
    def train(cls, name):
        out = cls.folder / Path(name).stem
        result = call("run", cls.folder / name, "evaluation.limit=false", "--out", out, "--quiet")
        if result.returncode != 0:
            raise RuntimeError(result.stderr)
        return out

    def infer(self, run, file, starts):
        arguments = [argument for start in starts for argument in ("--start", f"{start:.7f}")]
        result = call("infer", run, file, "--json", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return [json.loads(line) for line in result.stdout.splitlines()]

    def test_the_windows_agree_and_are_trusted(self):
        inferred = self.infer(self.run_folder, DATA, STARTS)
        self.assertEqual([window["status"] for window in inferred], ["ok"] * 10)
        for name, spread, value, about in [
            ("m", 0.005, 5.3e-6, 0.04),
            ("d", 0.04, 2.2e-4, 0.1),
            ("a", 0.02, 0.97, 0.05),
            ("b", 0.15, 3.8, 0.2),
        ]:
            means = np.array([window["parameters"][name]["mean"] for window in inferred])
            self.assertLess(np.ptp(means) / means.mean(), spread, name)
            self.assertLess(abs(means.mean() / value - 1), about, name)

    def test_another_excitation_is_refused(self):
        result = call("infer", self.run_folder, DATA, "--start", "100")
        self.assertEqual(result.returncode, 1, result)
        self.assertIn("column 'V1' is not the excitation 'u' that the map was trained on", result.stderr)

    def test_the_model_of_one_window_simulates_others(self):
        for start in (STARTS[3], STARTS[8]):
            out = self.folder / f"replay_{start:.0f}"
            result = call(
                "replay",
                self.run_folder,
                DATA,
                "--start",
                f"{start:.7f}",
                "--from-start",
                f"{STARTS[1]:.7f}",
                "--out",
                out,
            )
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertLess(float(read_csv(out / "fit.csv")[0]["nrmse_pct"]), 2.5)

    def test_without_the_cubic_term_it_is_a_mismatch(self):
        experiment = yaml.safe_load((self.folder / "silverbox.yaml").read_text())
        del experiment["parameters"]["b"]
        experiment["system"]["force_laws"][0]["force"] = "u - u_offset"
        (self.folder / "linear.yaml").write_text(yaml.safe_dump(experiment, sort_keys=False))
        for window in self.infer(self.train("linear.yaml"), DATA, STARTS[:3]):
            self.assertIn("model_mismatch", window["statuses"])

    def test_a_spike_and_a_drift_are_mismatches(self):
        u, y = read_signals()
        n = np.arange(len(y))
        window = slice(FIRST, FIRST + PERIOD)
        spike = y + 10 * NOISE * (n == FIRST + 600)
        drift = y.copy()
        drift[window] += np.linspace(0, 10 * NOISE, PERIOD)
        for name, disturbed in [("spike", spike), ("drift", drift)]:
            path = self.folder / f"{name}.csv"
            write_csv(path, ["V1", "V2"], [u, disturbed])
            self.assertIn("model_mismatch", self.infer(self.run_folder, path, STARTS[:1])[0]["statuses"], name)
