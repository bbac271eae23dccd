"""Excitations are designed within their limits, and go on where they were interrupted."""
import csv
import math
import os
import shutil
import signal
import subprocess
import time
import unittest

from support import EXPERIMENTS, TWINMAP, FolderTestCase, call, read_csv

FILE = EXPERIMENTS / "two_beam/design.yaml"
SMALL = [
    "design.excitation.budget=120",
    "design.excitation.average_over=8",
    "design.excitation.free={'M.pulses[0].amplitude': [0, 0.075], 'M.multisines[0].amplitudes': {each: [0, 0.01]}}",
]


def read_signal(path):
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return dict(zip(rows[0], zip(*(map(float, row) for row in rows[1:]))))


class Design(FolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.design = cls.folder / "design"
        cls.result = call("design", "excitation", FILE, *SMALL, "--out", cls.design)
        assert cls.result.returncode == 0, cls.result.stderr

    def test_the_parameter_of_the_criterion_gains(self):
        limits = {row["parameter"]: row for row in read_csv(self.design / "limits.csv")}
        self.assertEqual(set(limits), {"d_y", "d_theta", "k_y", "k_theta"})
        self.assertLess(float(limits["d_theta"]["mean_after"]), 0.8 * float(limits["d_theta"]["mean_before"]))
        self.assertIn("d_theta", self.result.stdout)

    def test_limits_are_kept_by_what_the_signal_generator_gets(self):
        moment = read_signal(self.design / "signal.csv")["M [N m]"]
        self.assertLessEqual(max(map(abs, moment)), 0.075)
        self.assertLessEqual(math.sqrt(sum(m * m for m in moment) / len(moment)), 0.00755)  # sampled, not integrated
        self.assertIn("margin", self.result.stdout)

    def test_the_designed_experiment_is_complete(self):
        measured = self.folder / "designed.csv"
        result = call("simulate", self.design / "designed.yaml", "--csv", measured, "parameters.k_y=5.1")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertLessEqual(max(abs(float(row["y"])) for row in read_csv(measured)), 0.052)

    def test_the_page_and_the_path_are_there(self):
        self.assertIn("</html>", (self.design / "design.html").read_text())
        rows = read_csv(self.design / "design.csv")
        averaged = [row for row in rows if row["points"] == "averaged"]
        self.assertLessEqual(len(averaged), 200)
        self.assertTrue(any(row["points"] == "nominal" for row in rows))
        self.assertEqual(averaged[0]["excitation.M.pulses[0].amplitude"], "0.075")

    def test_what_was_tried_is_not_computed_again(self):
        copy = self.folder / "copy"
        shutil.copytree(self.design, copy)
        result = call("design", "excitation", FILE, *SMALL, "--out", copy)
        self.assertEqual(result.stdout, self.result.stdout)
        for name in ("design.csv", "designed.yaml", "signal.csv"):
            self.assertEqual((copy / name).read_bytes(), (self.design / name).read_bytes(), name)

    def test_an_interrupted_design_keeps_its_best_and_goes_on(self):
        folder = self.folder / "interrupted"
        command = [TWINMAP, "design", "excitation", FILE, *SMALL, "--out", folder]
        process = subprocess.Popen(command, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        while not (folder / "design.csv").exists() and process.poll() is None:
            time.sleep(0.02)
        os.kill(process.pid, signal.SIGINT)
        self.assertEqual(process.wait(timeout=300), 130)
        self.assertTrue((folder / "designed.yaml").exists())
        result = call("design", "excitation", FILE, *SMALL, "--out", folder)
        self.assertEqual(result.stdout, self.result.stdout)
        self.assertEqual((folder / "designed.yaml").read_bytes(), (self.design / "designed.yaml").read_bytes())

    def test_a_limit_that_cannot_be_kept_is_named_with_the_least_violation(self):
        result = call(
            "design",
            "excitation",
            FILE,
            *SMALL,
            "design.excitation.limits=[{output: y, max_abs: 0.001}]",
            "--out",
            self.folder / "infeasible",
        )
        self.assertEqual(result.returncode, 2)
        self.assertIn("design.excitation.limits[0]", result.stderr)
        self.assertIn("largest |y|", result.stderr)
        self.assertIn("% above", result.stderr)

    def test_what_is_wrong_is_named(self):
        for override, words in (
            ("design.excitation.free={'M.pulses[7].start': [0, 1]}", "is not a value of the excitation"),
            ("design.excitation.criterion={parameter: k_z}", "is not a parameter"),
            ("design.excitation.limits=[{signal: N, rms: 1}]", "is not a signal"),
            ("design.excitation.limits=[{output: y, rms: 1}]", "of a signal only"),
            ("parameters.k_y.prior={normal: {mean: 10, stddev: 1}}", "has a prior, which designs do not know yet"),
        ):
            result = call("design", "excitation", FILE, override, "--out", self.folder / "wrong")
            self.assertEqual(result.returncode, 2, override)
            self.assertIn(words, result.stderr)
