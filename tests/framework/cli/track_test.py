"""One twin over time: twinmap track."""
import json
import shutil
import signal
import subprocess
import unittest

from support import EXPERIMENTS, TWINMAP, WEIGHED_MACHINE, WEIGHED_TRIALS, FolderTestCase, call, read_csv

CART = EXPERIMENTS / "duffing/cart.yaml"
RING = EXPERIMENTS.parent / "bench/framework/tracking/ring.yaml"
TRACKING = """
tracking:
  drift: {k: {random_walk: {stddev: 0.02, over: 1}}}
  limits: {k: {min: 85}}
"""
SWING = """
name: swing
parameters: {k: {bounds: [80, 120], unit: N/m}}
nuisance: {x0: {bounds: [-0.1, 0.1], unit: m}, v0: {bounds: [-1, 1], unit: m/s}}
system:
  bodies: {cart: {mass: 1.2, joint: {type: slider, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: k}]
  dampers: [{coordinate: x, damping: 0.5}]
initial: {coordinates: {x: x0}, speeds: {x: v0}}
outputs: {x: {coordinate: x}}
simulation: {duration: 1}
features: [{samples: {outputs: [x], start: 0.02, interval: 0.02, count: 49}}]
noise: {stddev: {x: 1e-4}}
"""
TRUTH = ["parameters.k=95", "parameters.m=1.2"]


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

    def test_the_same_older_than_the_lag_without_a_time_is_refused(self):
        self.track("j.h5", *self.files[:3], "--lag", "2")
        again = self.track("j.h5", self.files[0], "--lag", "2")
        self.assertEqual(again.returncode, 1)
        self.assertIn("was counted before the last 2 measurements, and states no time", again.stderr)
        self.assertEqual(json.loads(self.track("j.h5", self.files[1], "--lag", "2").stdout)["track"]["measurements"], 3)

    def test_what_was_counted_is_answered_without_inferring_it_again(self):
        first = json.loads(self.track("h.h5", self.files[0]).stdout)
        again = json.loads(self.track("h.h5", self.files[0]).stdout)
        self.assertEqual((again["source"], again["status"]), (first["source"], first["status"]))
        self.assertNotIn("parameters", again)  # of the measurement: it was not simulated
        self.assertEqual(again["track"]["parameters"], first["track"]["parameters"])

    def test_a_folder_is_tracked_once(self):
        inbox = self.folder / "inbox"
        inbox.mkdir()
        shutil.copy(self.files[0], inbox)
        shutil.copy(self.tracking, inbox / "notes.md")
        self.assertEqual(len(self.track("c.h5", "--folder", inbox).stdout.splitlines()), 1)
        shutil.copy(self.files[1], inbox)
        self.assertEqual(len(self.track("c.h5", "--folder", inbox).stdout.splitlines()), 1)

    def test_a_folder_is_followed_in_the_order_of_times_until_a_signal(self):
        timed = self.folder / "timed.yaml"
        timed.write_text(
            TRACKING.replace("tracking:", "tracking:\n  time: {column: date}").replace("over: 1", "over: 1 d")
        )
        inbox = self.folder / "dated"
        inbox.mkdir()

        def put(name, day):
            header, *rows = self.files[0].read_text().splitlines()
            rows = [f"{row},2026-11-{day}T10:00:00Z" for row in rows]
            (inbox / name).write_text("\n".join([header + ",date", *rows]) + "\n")

        put("a.csv", 27)
        put("b.csv", 26)
        (inbox / "c.csv").write_text("t\n")
        follow = [TWINMAP, "track", CART, "--folder", inbox, "--follow", "--state", self.folder / "i.h5"]
        with subprocess.Popen(
            [*follow, "--tracking", timed], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        ) as process:
            answers = [json.loads(process.stdout.readline()) for _ in range(3)]
            put("d.csv", 28)
            answers.append(json.loads(process.stdout.readline()))
            process.send_signal(signal.SIGTERM)
            self.assertEqual(process.stdout.read(), "")
            said = process.stderr.read()
        names = [answer["source"].rsplit("/")[-1] for answer in answers]
        self.assertEqual(sorted(names[:3]), ["a.csv", "b.csv", "c.csv"])
        self.assertLess(names.index("b.csv"), names.index("a.csv"))
        self.assertEqual(names[3], "d.csv")
        self.assertEqual(answers[names.index("c.csv")]["status"], "error")
        self.assertEqual(answers[3]["track"]["measurements"], 3)
        self.assertIn("1 of 4 measurements could not be used", said)

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


class TrackWindows(FolderTestCase):
    """Windows of one recording of a swing that dies away."""

    def test_windows_are_measurements_of_their_own(self):
        file, recording, state = (self.folder / name for name in ("swing.yaml", "swing.csv", "a.h5"))
        file.write_text(SWING)
        values = ["parameters.k=95", "nuisance.x0=0.08", "nuisance.v0=0"]
        longer = ["simulation.duration=4", "features[0].samples.count=199"]
        result = call("simulate", file, "--noise", "--csv", recording, *values, *longer)
        self.assertEqual(result.returncode, 0, result.stderr)
        for counted in (True, False):  # the second time nothing is new
            result = call("track", file, recording, "--windows", "1", "--state", state)
            self.assertEqual(result.returncode, 0, result.stderr)
            answers = [json.loads(line)["track"] for line in result.stdout.splitlines()]
            self.assertEqual([answer["at"] for answer in answers], [0, 1, 2, 3])
            self.assertEqual([answer["counted"] for answer in answers], [counted] * 4)
        self.assertLess(abs(answers[3]["parameters"]["k"]["mean"] - 95), 5 * answers[3]["parameters"]["k"]["sd"])
        records = [json.loads(line) for line in state.with_suffix(".jsonl").read_text().splitlines()]
        amplitudes = [dict(record["covariates"])["the amplitude of x"] for record in records]
        self.assertEqual(amplitudes, sorted(amplitudes, reverse=True))  # of each window, not of the recording
        self.assertLess(amplitudes[3], amplitudes[0] - 0.3)
        result = call("track", file, "--folder", self.folder, "--windows", "1", "--state", state)
        self.assertIn("--windows is of files", result.stderr)


class TrackedModel(FolderTestCase):
    """A mass whose spring hardens, which the model lacks: released far at first, then near."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.files = []
        for i, start in enumerate([0.055, 0.052, 0.054, 0.053, 0.025, 0.022, 0.024, 0.023]):
            cls.files.append(cls.folder / f"m{i + 1}.csv")
            machine = ["constants.hardening=9000", "parameters.k=200", "parameters.d=0.6", f"nuisance.x0={start}"]
            result = call("simulate", RING, "--noise", "--csv", cls.files[i], *machine, f"seed={i}")
            assert result.returncode == 0, result.stderr
        cls.tracking = cls.folder / "tracking.yaml"
        cls.tracking.write_text("tracking:\n  time: {}\n")

    def track(self, state, *files):
        result = call("track", RING, *files, "--state", self.folder / state, "--tracking", self.tracking)
        self.assertEqual(result.returncode, 0, result.stderr)
        alarms = [json.loads(line)["track"]["alarms"] for line in result.stdout.splitlines()]
        return [alarm for one in alarms for alarm in one]

    def test_a_term_that_the_model_lacks_is_a_rival_of_a_change(self):
        page = self.folder / "page.html"
        alarms = self.track("a.h5", *self.files, "--page", page)
        self.assertTrue(alarms)
        verdict = alarms[-1]["drift_or_model"]
        diagnosis = verdict["diagnosis"]
        self.assertGreater(alarms[-1]["time"], 4)
        self.assertIn("cubic_spring.x", [diagnosis["term"], *diagnosis["or"]])
        self.assertTrue(diagnosis["explains"])
        self.assertGreater(diagnosis["log_evidence_over_change"], -3)
        self.assertIn(diagnosis["term"], verdict["rivals"])
        self.assertIn(f"the model lacks {diagnosis['term']}", verdict["test"])
        self.assertIn(diagnosis["says"], page.read_text())

    def test_recordings_are_read_again_as_long_as_they_are_at_hand(self):
        for state, is_at_hand in (("b.h5", True), ("c.h5", False)):
            with self.subTest(state=state):
                inbox = self.folder / state.replace(".h5", "")
                inbox.mkdir()
                alarms = []
                for file in self.files:
                    here = inbox / file.name
                    shutil.copy(file, here)
                    alarms += self.track(state, here)
                    if not is_at_hand:
                        here.unlink()
                diagnosis = alarms[-1]["drift_or_model"]["diagnosis"]
                self.assertEqual("term" in diagnosis, is_at_hand)
                if not is_at_hand:
                    self.assertIn("no recording from before it is at hand any more", diagnosis["says"])


class TrackTrials(FolderTestCase):
    """Recordings of two experiments with one machine, one after another."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.file = cls.folder / "weighed.yaml"
        cls.file.write_text(WEIGHED_MACHINE + WEIGHED_TRIALS)
        for trial in ("free", "step"):
            recording = cls.folder / f"{trial}.csv"
            result = call("simulate", cls.file, f"trial={trial}", "--noise", "--csv", recording, *TRUTH)
            assert result.returncode == 0, result.stderr

    def track(self, state, *arguments):
        return call("track", self.file, "--state", self.folder / state, *arguments)

    def test_each_trial_says_its_own_of_the_machine(self):
        beliefs = []
        for trial in ("free", "step"):
            result = self.track("a.h5", self.folder / f"{trial}.csv", "--trial", trial)
            self.assertEqual(result.returncode, 0, result.stderr)
            beliefs.append(json.loads(result.stdout)["track"]["parameters"])
        for name, truth in (("k", 95), ("m", 1.2)):
            self.assertLess(abs(beliefs[1][name]["mean"] - truth), 5 * beliefs[1][name]["sd"])
            self.assertLess(beliefs[1][name]["sd"], 0.7 * beliefs[0][name]["sd"])  # a release alone says k / m

    def test_a_trial_is_to_be_named(self):
        for arguments, says in (([], "one of the trials free, step"), (["--trial", "fre"], "free")):
            result = self.track("b.h5", self.folder / "free.csv", *arguments)
            self.assertNotEqual(result.returncode, 0)
            self.assertIn(says, result.stderr)
        result = call("track", CART, self.folder / "free.csv", "--trial", "x", "--state", self.folder / "b.h5")
        self.assertIn("has no trials", result.stderr)


if __name__ == "__main__":
    unittest.main()
