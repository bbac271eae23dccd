"""What a command says while it takes long, and when it is interrupted."""
import re
import signal
import subprocess
import time
import unittest

from support import EXPERIMENTS, MIRROR, TWINMAP, OwnFolderTestCase, call

PROGRAM = """
import json, math, sys, time
times = json.loads(sys.stdin.readline())["times"]
print(json.dumps({"twinmap": 1}), flush=True)
for line in sys.stdin:
    request = json.loads(line)
    answers = []
    for sample in request.get("samples", [request]):
        time.sleep(SECONDS)
        p = sample["parameters"]
        answers.append({"outputs": {"x": [math.exp(-p["d"] * t) * math.cos(p["w"] * t) for t in times]}})
    print(json.dumps({"samples": answers} if "samples" in request else answers[0]), flush=True)
"""
EXPERIMENT = """
name: slow
model: {program: {command: [python3, slow.py]}}
parameters: {w: {bounds: [2, 6], unit: rad/s}, d: {bounds: [0.1, 1], unit: 1/s}}
outputs: {x: {variable: x}}
simulation: {duration: 3}
features: [{samples: {outputs: [x], start: 0.1, interval: 0.1, count: 29}}]
noise: {stddev: {x: 1e-2}}
"""
LINE = re.compile(r"^twinmap: (\w+ .*), (\d+):(\d\d)$")


class ProgressTest(OwnFolderTestCase):
    def write_slow(self, seconds):
        (self.folder / "slow.py").write_text(PROGRAM.replace("SECONDS", str(seconds)))
        file = self.folder / "slow.yaml"
        file.write_text(EXPERIMENT)
        measured = self.folder / "m.csv"
        self.assertEqual(call("simulate", file, "--noise", "--csv", measured).returncode, 0)
        return file, measured

    def start(self, *arguments):
        return subprocess.Popen(
            [TWINMAP, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )

    def listen(self, process, seconds):
        """(time, match) of each line of progress until so long has passed or the command has ended."""
        heard, start = [], time.monotonic()
        while time.monotonic() - start < seconds:
            line = process.stderr.readline()
            if not line:
                break
            if found := LINE.match(line):
                heard.append((time.monotonic() - start, found))
        return heard

    def test_a_search_is_never_silent_for_more_than_five_seconds(self):
        file, measured = self.write_slow(0.05)
        process = self.start("infer", file, measured)
        heard = self.listen(process, 13)
        process.kill()
        process.communicate()
        times = [0.0] + [at for at, _ in heard]
        self.assertGreater(len(heard), 2)
        for before, after in zip(times, times[1:]):
            self.assertLess(after - before, 5.5)
        for _, found in heard:
            self.assertIn("m.csv", found[1])
        self.assertIn("search for the best fit", heard[-1][1][1])
        self.assertRegex(heard[-1][1][1], r"\d+ of \d+, .*\d+ simulations")

    def test_an_interrupt_prints_what_is_known(self):
        for command in ("infer", "select"):
            with self.subTest(command):
                file, measured = self.write_slow(0.02)
                files = [file, file, measured] if command == "select" else [file, measured]
                process = self.start(command, *files)
                while "at best" not in process.stderr.readline() and process.poll() is None:
                    pass
                process.send_signal(signal.SIGINT)
                out, errors = process.communicate(timeout=20)
                self.assertEqual(process.returncode, 128 + signal.SIGINT)
                self.assertEqual(out, "")
                self.assertRegex(errors, r"interrupted after \d+:\d\d: .*m\.csv.*chi-square [\d.e+]+ of \d+ at best")
                self.assertRegex(errors, r"best so far, .*: w = [\d.]+, d = [\d.]+")

    def test_a_quick_command_says_nothing_of_progress(self):
        cart = EXPERIMENTS / "duffing/cart.yaml"
        measured = self.folder / "m.csv"
        self.assertEqual(call("simulate", cart, "--noise", "--csv", measured).returncode, 0)
        start = time.monotonic()
        result = call("infer", cart, measured)
        if time.monotonic() - start < 1.9:
            self.assertEqual(result.stderr, "")

    def test_a_stage_of_a_run_is_named_before_it_ends(self):
        file, _ = self.write_slow(0.05)  # s a simulation: 60 points take more than two intervals of the log's lines
        small = ["design.train.samples=60", "design.test.samples=60", "inverse_map=surrogate"]
        process = self.start("run", file, *small, "--out", self.folder / "run", "--threads", 1)
        _, errors = process.communicate(timeout=300)
        self.assertEqual(process.returncode, 0, errors)
        lines = errors.splitlines()
        named = [
            i for i, line in enumerate(lines) if re.match(r"twinmap: finite differences at 60 points, \d+:\d\d$", line)
        ]
        ended = [i for i, line in enumerate(lines) if line.startswith("twinmap: finite differences at 60 points: ")]
        self.assertTrue(named and ended and named[0] < ended[-1], errors)

    def test_threads_do_not_matter_for_what_comes_out(self):
        cart = EXPERIMENTS / "duffing/cart.yaml"
        mirror = self.folder / "mirror.yaml"
        mirror.write_text(MIRROR)
        for file in (cart, mirror):
            files = []
            for seed in (1, 2):
                files.append(self.folder / f"m{seed}.csv")
                done = call("simulate", file, "--noise", "--csv", files[-1], f"seed={seed}")
                self.assertEqual(done.returncode, 0, done.stderr)
            one, two = files
            for command in (
                ["infer", file, one, "--json"],
                ["diagnose", file, one, "--json"],
                ["validate", file, one, "--against", two, "--json"],
                ["select", file, file, one, "--json"],
            ):
                with self.subTest(command[0], file=file.name):
                    found = {call(*command, "--threads", threads).stdout for threads in (1, 2)}
                    self.assertEqual(len(found), 1)
                    self.assertNotEqual(found, {""})


if __name__ == "__main__":
    unittest.main()
