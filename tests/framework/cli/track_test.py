"""One twin over time: twinmap track."""
import json
import shutil
import subprocess
import unittest

from support import EXPERIMENTS, TWINMAP, FolderTestCase, call, read_csv

CART = EXPERIMENTS / "duffing/cart.yaml"
TRACKING = """
tracking:
  drift: {k: {random_walk: {stddev: 0.02, over: 1}}}
  limits: {k: {min: 85}}
"""


class Track(FolderTestCase):
    """A cart whose spring loses 5 N/m before the fifth of six measurements."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.tracking = cls.folder / "tracking.yaml"
        cls.tracking.write_text(TRACKING)
        cls.files = []
        for i in range(1, 7):
            file = cls.folder / f"m{i}.csv"
            point = f"parameters.k={95 if i < 5 else 90}"
            result = call("simulate", CART, "--noise", "--csv", file, point, f"seed={i}")
            assert result.returncode == 0, result.stderr
            cls.files.append(file)

    def track(self, state, *arguments):
        return call("track", CART, *arguments, "--state", self.folder / state, "--tracking", self.tracking)

    def test_a_change_is_announced_and_the_history_smoothed(self):
        table = self.folder / "track.csv"
        result = self.track("a.h5", *self.files, "--history", table, "--page", self.folder / "page.html")
        self.assertEqual(result.returncode, 0, result.stderr)
        answers = [json.loads(line) for line in result.stdout.splitlines()]
        self.assertEqual([len(one["track"]["alarms"]) for one in answers[:5]], [0] * 5)
        alarm = answers[5]["track"]["alarms"][0]
        self.assertEqual((alarm["parameter"], alarm["time"]), ("k", 5))
        self.assertLess(abs(alarm["size"] + 5), 5 * alarm["sd"])
        rows = [row for row in read_csv(table) if row["parameter"] == "k"]
        self.assertEqual(len(rows), 6)
        self.assertLess(abs(float(rows[3]["smoothed_mean"]) - 95), 5 * float(rows[3]["smoothed_sd"]))
        self.assertIn("<svg", (self.folder / "page.html").read_text())

    def test_the_same_again_is_not_counted(self):
        first = self.track("b.h5", self.files[0], "--at", "2026-11-26T10:00:00Z")
        again = self.track("b.h5", self.files[0], "--at", "2026-11-26T10:00:00Z")
        self.assertEqual(json.loads(first.stdout)["track"]["at"], 1795687200)
        self.assertTrue(json.loads(first.stdout)["track"]["counted"])
        self.assertFalse(json.loads(again.stdout)["track"]["counted"])
        self.assertEqual(json.loads(again.stdout)["track"]["measurements"], 1)

    def test_the_same_file_without_a_time_is_not_counted_again(self):
        self.track("f.h5", self.files[0], self.files[1])
        again = json.loads(self.track("f.h5", self.files[0]).stdout)["track"]
        self.assertEqual((again["counted"], again["at"], again["measurements"]), (False, 1, 2))

    def test_a_folder_is_tracked_once(self):
        inbox = self.folder / "inbox"
        inbox.mkdir()
        shutil.copy(self.files[0], inbox)
        self.assertEqual(len(self.track("c.h5", "--folder", inbox).stdout.splitlines()), 1)
        shutil.copy(self.files[1], inbox)
        self.assertEqual(len(self.track("c.h5", "--folder", inbox).stdout.splitlines()), 1)

    def test_one_process_at_a_time_and_no_answer_is_lost_where_it_is_killed(self):
        follow = [TWINMAP, "track", CART, "--follow", "--state", self.folder / "g.h5", "--tracking", self.tracking]
        with subprocess.Popen(follow, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as first:
            for file in self.files[:2]:
                first.stdin.write(file.read_text() + "\n")
                first.stdin.flush()
            answered = [json.loads(first.stdout.readline())["track"]["measurements"] for _ in range(2)]
            second = self.track("g.h5", self.files[2])
            first.kill()
        self.assertEqual(answered, [1, 2])
        self.assertNotEqual(second.returncode, 0)
        self.assertIn(
            f"g.h5: is in use by process {first.pid}; wait until it has ended, or give another --state", second.stderr
        )
        with open(self.folder / "g.jsonl", "a") as history:
            history.write('{"half of a line')  # of a measurement that was not answered
        self.assertEqual(json.loads(self.track("g.h5", self.files[2]).stdout)["track"]["measurements"], 3)

    def test_a_state_of_another_section_is_refused(self):
        self.track("d.h5", self.files[0])
        result = call("track", CART, self.files[1], "--state", self.folder / "d.h5")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("another section 'tracking'", result.stderr)

    def test_a_limit_outside_the_bounds_is_an_error_with_its_place(self):
        wrong = self.folder / "wrong.yaml"
        wrong.write_text(TRACKING.replace("85", "75"))
        result = call("track", CART, self.files[0], "--state", self.folder / "e.h5", "--tracking", wrong)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("wrong.yaml:4", result.stderr)
        self.assertIn("outside the bounds of 'k'", result.stderr)
        self.assertFalse((self.folder / "e.h5").exists())


if __name__ == "__main__":
    unittest.main()
