"""Models that come as FMUs, by the command: TWINMAP_TEST_FMUS holds the FMUs of tests/framework/models/fmu/fmus."""
import os
import signal
import subprocess
import unittest
from pathlib import Path

from support import (
    EXPERIMENTS,
    TWINMAP,
    OwnFolderTestCase,
    await_processes,
    call,
    read_columns,
    read_csv,
    read_datasets,
)

FMUS = Path(os.environ["TWINMAP_TEST_FMUS"])
FAULTY = """
name: faulty
model: {{fmu: {{file: {file}{more}}}}}
parameters:
  fault: {{bounds: [{lower}, {upper}], relative_to: range}}
  x: {{bounds: [0.9, 1.1]}}
outputs:
  x: {{variable: x}}
simulation: {{duration: 1, max_wall_time: 0.5, allowed_failures: 1}}
features:
  - samples: {{outputs: [x], start: 0.1, interval: 0.1, count: 10}}
noise: {{stddev: {{x: 1e-3}}}}
design: {{train: {{samples: 20}}, test: {{samples: 20}}}}
"""
TWO_BEAM = """
constants:
  y_start: {{value: {y}, unit: m, variable: y_start}}
  theta_start: {{value: {theta}, unit: rad, variable: theta_start}}
model: {{fmu: {{file: {file}, kind: {kind}}}}}
outputs:
  y: {{variable: y, unit: m}}
  theta: {{variable: theta, unit: rad}}
"""


class FmuTest(OwnFolderTestCase):
    def setUp(self):
        super().setUp()
        self.tmp = self.folder / "tmp"
        self.tmp.mkdir()
        self.environment = dict(os.environ, TMPDIR=str(self.tmp))
        self.mark = f"TMPDIR={self.tmp}"

    def call(self, *arguments):
        return call(*arguments, env=self.environment)

    def write(self, text):
        file = self.folder / "experiment.yaml"
        file.write_text(text)
        return file

    def write_faulty(self, lower, upper, version=2, more=""):
        return self.write(FAULTY.format(file=FMUS / f"faulty_{version}.fmu", lower=lower, upper=upper, more=more))

    def write_two_beam(self, name, kind):
        lines = (EXPERIMENTS / "two_beam" / "table1.yaml").read_text().splitlines()
        kept, skipping = [], False
        for line in lines:
            if line and not line[0].isspace():
                skipping = line.split(":")[0] in ("constants", "system", "initial", "outputs")
            if not skipping:
                kept.append(line)
        start = read_columns(
            call(
                "simulate",
                EXPERIMENTS / "two_beam" / "table1.yaml",
                "features=[{samples: {outputs: [y, theta], start: 0, interval: 0.1, count: 2}}]",
            ).stdout
        )
        # values that need no more digits than the table has: the error is 1e-6 of the range
        return self.write(
            "\n".join(kept)
            + TWO_BEAM.format(file=FMUS / f"{name}.fmu", kind=kind, y=start["y"][0], theta=start["theta"][0])
        )

    def check_nothing_is_left(self):
        self.assertEqual(await_processes(self.mark, lambda found: not found and not list(self.tmp.iterdir())), [])
        self.assertEqual(list(self.tmp.iterdir()), [])

    def test_variables_lists_what_can_be_named(self):
        result = self.call("variables", FMUS / "two_beam_2.fmu")
        self.assertEqual(result.returncode, 0, result.stderr)
        row = next(line for line in result.stdout.splitlines() if line.startswith("d_y"))
        self.assertEqual(
            row.split(None, 7),
            ["d_y", "parameter", "fixed", "Float64", "N.s/m", "1", "parameter", "damper of the slide"],
        )
        self.check_nothing_is_left()

    def test_all_ways_follow_the_built_in_model(self):
        point = ["parameters.k_y=7", "parameters.d_theta=1.8e-4"]
        exact = read_columns(call("simulate", EXPERIMENTS / "two_beam" / "table1.yaml", *point).stdout)
        for name in ("two_beam_2", "two_beam_3"):
            for kind in ("co_simulation", "model_exchange"):
                result = self.call("simulate", self.write_two_beam(name, kind), *point)
                self.assertEqual(result.returncode, 0, result.stderr)
                found = read_columns(result.stdout)
                for output in ("y", "theta"):
                    width = max(exact[output]) - min(exact[output])
                    error = max(abs(a - b) for a, b in zip(found[output], exact[output]))
                    self.assertLess(error, 2e-5 * width, (name, kind, output))
        self.check_nothing_is_left()

    def test_each_fault_is_a_failed_sample_with_its_reason(self):
        reasons = {
            1: "crashed: Aborted",
            2: "does not answer within its time",
            3: "not finite",
            4: "the spring is torn (Error)",
            5: "nothing works any more (Fatal)",
            6: "ended with exit code 3",
        }
        for version in (2, 3):
            for fault, reason in reasons.items():
                result = self.call("simulate", self.write_faulty(fault - 0.1, fault + 0.1, version))
                self.assertEqual(result.returncode, 1, result.stdout)
                self.assertIn(reason, result.stderr, (version, fault))
        self.check_nothing_is_left()

    def test_what_an_fmu_prints_disturbs_nobody(self):
        result = self.call("simulate", self.write_faulty(6.9, 7.1))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertAlmostEqual(read_columns(result.stdout)["x"][-1], 0.36787944, 6)

    def test_a_run_survives_crashes_and_gives_the_same_bits_with_any_number_of_threads(self):
        file = self.write_faulty(-1.4, 1.4)  # rounded by the FMU: a third of the samples crash, but not the centre
        samples = {}
        for threads in (1, 2):
            out = self.folder / f"run{threads}"
            result = self.call(
                "run", file, "--threads", threads, "--out", out, "--quiet", "evaluation.limit=false", "refine=never"
            )
            self.assertEqual(result.returncode, 0, result.stderr)
            samples[threads] = read_datasets(out / "samples.h5")
        self.assertEqual(samples[1], samples[2])
        self.assertTrue(any("crashed" in data for data in samples[1].values()))
        self.check_nothing_is_left()

    def test_nothing_is_left_when_twinmap_is_killed_while_the_fmu_hangs(self):
        file = self.write_faulty(1.9, 2.1)
        child = subprocess.Popen(
            [TWINMAP, "simulate", str(file), "simulation.max_wall_time=1000"],
            env=self.environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        expected = 3  # twinmap, the guard, the worker
        self.assertGreaterEqual(len(await_processes(self.mark, lambda found: len(found) >= expected)), expected)
        child.send_signal(signal.SIGKILL)
        child.wait()
        self.check_nothing_is_left()

    def test_wrong_names_kinds_and_units_are_errors_with_their_place(self):
        text = self.write_faulty(0, 1).read_text()
        cases = [
            ("variable: x}", "variable: z}", "has no variable 'z'"),
            ("  x: {bounds", "  y: {bounds", "has no variable 'y'"),
            ("variable: x}", "variable: x, unit: parsec2}", "parsec2"),
            ("faulty_2.fmu", "two_beam.fmu", "is not a file"),
            ("faulty_2.fmu", "not_a_zip.fmu", "not a ZIP archive"),
        ]
        for old, new, message in cases:
            result = self.call("check", self.write(text.replace(old, new)))
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn(message, result.stderr)
        self.check_nothing_is_left()

    def test_the_example_is_built_and_runs(self):
        subprocess.run([EXPERIMENTS / "fmu" / "build-fmu"], check=True, capture_output=True)
        out = self.folder / "run"
        result = self.call("run", EXPERIMENTS / "fmu" / "oscillator.yaml", "--out", out, "--quiet")
        self.assertEqual(result.returncode, 0, result.stderr)
        metrics = {row["parameter"]: row for row in read_csv(out / "metrics.csv")}
        self.assertEqual(set(metrics), {"c", "d", "mu"})
        self.assertLess(float(metrics["c"]["sd_pct"]), 0.1)
        result = self.call("verify", out, "--samples", "3")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.check_nothing_is_left()
