"""twinmap track that is killed at any moment: nothing that was answered is lost, nothing is counted twice."""
import json
import os
import random
import subprocess
import time
import unittest

from support import EXPERIMENTS, TWINMAP, FolderTestCase, call, run_once

CART = EXPERIMENTS / "duffing/cart.yaml"
KILLS = 1000 if os.environ.get("TWINMAP_ALL_CASES") else 24
MEASUREMENTS = 8
QUICK = ["refine=never", "design.train.samples=60", "design.test.samples=60", "evaluation.limit=false"]


class Crash(FolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.run_folder, _ = run_once(CART, *QUICK)
        cls.texts = []
        for seed in range(MEASUREMENTS):
            file = cls.folder / f"m{seed}.csv"
            result = call("simulate", CART, "--noise", "--csv", file, "parameters.k=95", f"seed={seed + 1}")
            assert result.returncode == 0, result.stderr
            cls.texts.append(file.read_text())

    def track(self, state, first, wait=None):
        """Answers to the measurements from one on; wait: s, until it is killed, from when it has begun to answer."""
        process = subprocess.Popen(
            [TWINMAP, "track", self.run_folder, "--follow", "--state", state],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        try:
            process.stdin.write("\n".join(self.texts[first:]) + "\n")
            process.stdin.close()
        except BrokenPipeError:
            self.fail(process.stderr.read())
        lines = [process.stdout.readline()]
        if wait is not None:
            time.sleep(wait)
            process.kill()
        lines += process.stdout.readlines()
        said = process.stderr.read()
        process.stdout.close()
        process.stderr.close()
        process.wait()
        self.assertEqual(said, "")
        return [json.loads(line) for line in lines if line.endswith("\n")]  # half a line does not count

    def live(self, state, generator, longest):
        """Tracks all, killed again and again: the answers, and how often it was killed."""
        answers, kills = [], 0
        while len(answers) < MEASUREMENTS:
            wait = generator.uniform(0, longest) if kills < MEASUREMENTS else None
            new = self.track(state, len(answers), wait)
            for answer in new:
                answers.append(answer)
                self.assertEqual(answer["track"]["measurements"], len(answers))
            kills += wait is not None
        return answers, kills

    def test_killed_at_any_moment_it_has_what_it_answered_and_counts_nothing_twice(self):
        begin = time.monotonic()
        whole = self.track(self.folder / "whole.h5", 0)
        longest = 0.7 * (time.monotonic() - begin)
        generator, kills, lives = random.Random(1), 0, 0
        while kills < KILLS:
            state = self.folder / f"life{lives}.h5"
            answers, killed = self.live(state, generator, longest)
            kills += killed
            lives += 1
            with self.subTest(life=lives):
                self.assertEqual(answers[-1]["track"]["measurements"], MEASUREMENTS)
                self.assertEqual(answers[-1]["track"]["parameters"], whole[-1]["track"]["parameters"])
                self.assertEqual(answers[-1]["track"]["covariance"], whole[-1]["track"]["covariance"])
                lines = state.with_suffix(".jsonl").read_text().splitlines()
                digests = [json.loads(line)["digest"] for line in lines]
                self.assertEqual(len(digests), MEASUREMENTS)
                self.assertEqual(len(set(digests)), MEASUREMENTS)
        print(f"{kills} kills in {lives} lives")


class Bits(FolderTestCase):
    """The same belief for any number of threads and any order within the lag."""

    def test_threads_and_order_make_no_difference(self):
        run_folder, _ = run_once(CART, *QUICK)
        files = []
        for seed in range(6):
            file = self.folder / f"m{seed}.csv"
            result = call("simulate", CART, "--noise", "--csv", file, "parameters.k=95", f"seed={seed + 1}")
            self.assertEqual(result.returncode, 0, result.stderr)
            header, *rows = file.read_text().splitlines()
            stamped = [header + ",date", *(f"{row},{1000 * seed}" for row in rows)]
            file.write_text("\n".join(stamped) + "\n")
            files.append(file)
        section = self.folder / "tracking.yaml"
        section.write_text("tracking: {time: {column: date}, drift: {k: {random_walk: unknown}}}\n")
        beliefs = []
        for source, order, threads in (
            (run_folder, files, 1),
            (run_folder, [files[i] for i in (2, 0, 1, 5, 3, 4)], 2),
            (CART, files[:3], 1),
            (CART, [files[i] for i in (1, 2, 0)], 2),
        ):
            state = self.folder / f"state{len(beliefs)}.h5"
            arguments = ["--state", state, "--tracking", section, "--threads", threads]
            result = call("track", source, *order, *arguments)
            self.assertEqual(result.returncode, 0, result.stderr)
            last = json.loads(result.stdout.splitlines()[-1])["track"]
            beliefs.append({key: last[key] for key in ("measurements", "time", "parameters", "covariance")})
        self.assertEqual(beliefs[0], beliefs[1])
        self.assertEqual(beliefs[2], beliefs[3])


if __name__ == "__main__":
    unittest.main()
