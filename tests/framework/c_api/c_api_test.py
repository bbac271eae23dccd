"""libtwinmap against the command: the same answers, to the last bit."""
import json
import os
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "cli"))
from support import MIRROR, TWINMAP, RunTestCase, call  # noqa: E402

PROGRAM = os.environ["TWINMAP_C_PROGRAM"]
NEVER, AS_EXPERIMENT, ALWAYS = "0", "1", "2"  # twinmap_refine


def use(*arguments):
    return subprocess.run(
        [PROGRAM, *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=600,
        env={**os.environ, "TWINMAP_WORKER": TWINMAP},
    )


def read_answers(lines):
    return [json.loads(line) for line in lines.splitlines()]


class Library(RunTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.measurement = cls.simulate("m.csv", "parameters.k_y=8")
        cls.heavier = cls.simulate("heavier.csv", "constants.m1.value=4")

    def test_keeps_the_promises_of_its_header(self):
        result = use("check", self.run_folder / "maps.h5", self.measurement)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_answers_as_the_command_does(self):
        for refine, options in [(NEVER, ["--no-refine"]), (AS_EXPERIMENT, []), (ALWAYS, ["--refine"])]:
            files = [self.measurement, self.heavier]
            expected = call("infer", self.run_folder, *files, "--json", *options).stdout
            result = use("json", self.run_folder, refine, *files)
            self.assertEqual(read_answers(result.stdout), read_answers(expected), result.stderr)
        self.assertEqual([json.loads(line)["status"] for line in expected.splitlines()], ["ok", "model_mismatch"])

    def test_tells_what_is_wrong_and_goes_on(self):
        wrong = self.folder / "wrong.csv"
        wrong.write_text("t,y\n0,1\n")
        lines = use("json", self.run_folder, NEVER, wrong, self.measurement).stdout.splitlines()
        self.assertRegex(lines[0], r"^error: .*wrong\.csv.*'theta'")
        self.assertEqual(json.loads(lines[1])["status"], "ok")

    def test_infers_by_an_experiment_alone(self):
        experiment, measurement = self.folder / "mirror.yaml", self.folder / "mirror.csv"
        experiment.write_text(MIRROR)
        result = call("simulate", experiment, "--noise", "--csv", measurement, "parameters.e=0.05", "parameters.k=4")
        self.assertEqual(result.returncode, 0, result.stderr)
        result = use("posterior", experiment, measurement)
        self.assertEqual(result.returncode, 0, result.stderr)
        expected = call("infer", experiment, measurement, "--json").stdout
        self.assertEqual(use("json", experiment, AS_EXPERIMENT, measurement).stdout, expected)

    def test_may_be_used_by_several_threads(self):
        result = use("threads", self.run_folder, self.measurement)
        self.assertEqual(result.returncode, 0, result.stderr)
