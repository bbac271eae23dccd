"""Models that are programs, by the command."""
import os
import signal
import subprocess
import time
import unittest
from pathlib import Path

from support import (
    EXPERIMENTS,
    TWINMAP,
    OwnFolderTestCase,
    await_processes,
    call,
    find_processes,
    read_columns,
    read_datasets,
)

PLANT = EXPERIMENTS / "python_plant" / "python_plant.yaml"
FAULTY = Path(os.environ["TWINMAP_SOURCE_DIR"]) / "tests/framework/models/external/programs/faulty.py"
QUICK = ["evaluation.limit=false", "refine=never"]
TEXT = """
name: faulty
model:
  program: {{command: [python3, faulty.py], timeout: {timeout}, environment: {{MARK: {mark}}}}}
parameters:
  a: {{bounds: [1, 2]}}
  mode: {{bounds: {mode}, relative_to: range}}
outputs:
  x: {{variable: x}}
simulation: {{duration: 1, allowed_failures: 1}}
features:
  - samples: {{outputs: [x], start: 0.1, interval: 0.1, count: 10}}
noise: {{stddev: {{x: 1e-3}}}}
design: {{train: {{samples: 40}}, test: {{samples: 20}}}}
"""


class ProgramTest(OwnFolderTestCase):
    def setUp(self):
        super().setUp()
        self.mark = f"mark-{os.getpid()}-{id(self)}"
        (self.folder / "faulty.py").write_bytes(FAULTY.read_bytes())

    def write_faulty(self, mode, timeout=1):
        file = self.folder / "faulty.yaml"
        file.write_text(TEXT.format(mode=mode, timeout=timeout, mark=self.mark))
        return file

    def find_workers(self):
        return find_processes(f"MARK={self.mark}")

    def check_nothing_is_left(self):
        self.assertEqual(await_processes(f"MARK={self.mark}", lambda found: not found), [])

    def test_the_plant_in_python_follows_the_built_in_model(self):
        point = ["parameters.k_y=7", "parameters.d_theta=1.8e-4"]
        exact = read_columns(call("simulate", EXPERIMENTS / "two_beam" / "best.yaml", *point).stdout)
        result = call("simulate", PLANT, *point)
        self.assertEqual(result.returncode, 0, result.stderr)
        found = read_columns(result.stdout)
        for output in ("y", "theta"):
            width = max(exact[output]) - min(exact[output])
            error = max(abs(a - b) for a, b in zip(found[output], exact[output]))
            self.assertLess(error, 2e-5 * width)

    def test_check_plan_run_and_verify_know_programs(self):
        small = ["design.train.samples=30", "design.test.samples=20", *QUICK]
        out = self.folder / "run"
        for arguments in (
            ["check", PLANT],
            ["plan", PLANT, *small, "--out", out],
            ["run", PLANT, *small, "--out", out, "--quiet"],
            ["report", out],
            ["verify", out],
        ):
            result = call(*arguments)
            self.assertEqual(result.returncode, 0, f"{arguments}: {result.stdout}{result.stderr}")
        self.assertIn("# solver: program /usr/bin/python3 plant.py", call("check", PLANT).stdout)

    def test_a_run_killed_in_the_middle_and_again_gives_the_same_bits_and_names_failures(self):
        # int(mode) is 1, a crash, for a fifth of the samples, not at the centre; none hangs, so that on a busy
        # machine none may be called late
        file = self.write_faulty("[-2.4, 1.9]", timeout=60)
        whole, broken = self.folder / "whole", self.folder / "broken"
        result = call("run", file, *QUICK, "--threads", 1, "--out", whole, "--quiet")
        self.assertEqual(result.returncode, 0, result.stderr)
        child = subprocess.Popen(
            [TWINMAP, "run", str(file), *QUICK, "--threads", "2", "--out", str(broken), "--quiet"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        while child.poll() is None and not self.find_workers():
            time.sleep(0.01)
        time.sleep(0.3)
        child.send_signal(signal.SIGKILL)
        child.wait()
        self.check_nothing_is_left()
        result = call("run", file, *QUICK, "--threads", 2, "--out", broken, "--quiet")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(read_datasets(whole / "samples.h5"), read_datasets(broken / "samples.h5"))
        self.assertIn("crashed: Aborted; it said: the plant is on fire", (whole / "failures.csv").read_text())
        self.check_nothing_is_left()

    def test_a_hanging_program_ends_with_twinmap(self):
        child = subprocess.Popen(
            [TWINMAP, "simulate", str(self.write_faulty("[2.9, 3.3]", 1000))],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self.assertTrue(await_processes(f"MARK={self.mark}", bool))
        child.send_signal(signal.SIGKILL)
        child.wait()
        self.check_nothing_is_left()

    def test_wrong_input_is_an_error_with_its_reason(self):
        text = self.write_faulty("[0, 0.5]").read_text()
        cases = [
            ("[python3, faulty.py]", "[no-such-program]", "cannot be started: No such file"),
            ("[python3, faulty.py]", "[]", "must name a program in 'command'"),
            ("[python3, faulty.py]", "['true']", "ended with exit code 0"),
            ("timeout: 1", "depends_on: [none.csv]", "is not a file that it could depend on"),
            ("timeout: 1", "working_folder: nowhere", "is not a folder"),
        ]
        for old, new, message in cases:
            file = self.folder / "wrong.yaml"
            file.write_text(text.replace(old, new))
            result = call("check", file)
            self.assertEqual(result.returncode, 2, new + result.stdout + result.stderr)
            self.assertIn(message, result.stderr)

    def test_a_parameter_without_effect_is_a_warning_at_the_start(self):
        result = call("run", self.write_faulty("[0, 0.5]"), *QUICK, "--out", self.folder / "run")
        self.assertIn("mode has no effect on any output", result.stdout + result.stderr)
