"""Several recordings of one machine inferred together: trials, windows, repeats, priors."""
import itertools
import json
import unittest

import numpy as np

from support import EXPERIMENTS, WEIGHED_MACHINE, FolderTestCase, call

OSCILLATOR = """
name: oscillator
seed: 4
parameters:
  k: {bounds: [50, 150], unit: N/m}
  d: {bounds: [0.2, 3], unit: N s/m}
nuisance:
  x0: {bounds: [-0.1, 0.1], unit: m}
  v0: {bounds: [-1, 1], unit: m/s}
system:
  bodies: {cart: {mass: 1, joint: {type: slider, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: k}]
  dampers: [{coordinate: x, damping: d}]
initial: {coordinates: {x: x0}, speeds: {x: v0}}
outputs: {x: {coordinate: x}}
simulation: {duration: 1.5}
features: [{samples: {outputs: [x], start: 0.02, interval: 0.02, count: 70}}]
noise: {stddev: {x: 1e-3}}
"""

WEIGHED = (
    WEIGHED_MACHINE
    + """\
trials:
  free: {initial: {coordinates: {x: 0.05}}}
  step: {excitation: {F: {unit: N, pulses: [{amplitude: 4, start: 0, end: 9}]}}}
"""
)


def free_decay(k, d, x0, v0, times):
    """x'' = -k x - d x' of a mass of 1 kg, in closed form."""
    decay, frequency = d / 2, np.sqrt(k - d * d / 4)
    return np.exp(-decay * times) * (
        x0 * np.cos(frequency * times) + (v0 + decay * x0) / frequency * np.sin(frequency * times)
    )


class Joint(FolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.experiment = cls.folder / "oscillator.yaml"
        cls.experiment.write_text(OSCILLATOR)
        cls.random = np.random.default_rng(8)
        cls.a = cls.record("a.csv", 100, 1.0, 0.05, 0.3)
        cls.b = cls.record("b.csv", 100, 1.0, -0.04, 0.5)
        cls.other = cls.record("other.csv", 103, 1.0, 0.06, -0.2)
        cls.long = cls.record("long.csv", 100, 0.3, 0.08, 0.0, duration=8)

    @classmethod
    def record(cls, name, k, d, x0, v0, duration=1.5):
        path = cls.folder / name
        times = np.arange(0, duration + 0.005, 0.01)
        values = free_decay(k, d, x0, v0, times) + 1e-3 * cls.random.standard_normal(times.size)
        path.write_text("t,x\n" + "".join(f"{t:.2f},{x!r}\n" for t, x in zip(times, values.tolist())))
        return path

    def infer(self, *arguments):
        result = call("infer", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def test_agreeing_recordings_know_more_together(self):
        found = json.loads(self.infer(self.experiment, self.a, self.b, "--joint", "--json"))
        self.assertTrue(found["agreement"]["agrees"])
        for name, true in (("k", 100), ("d", 1.0)):
            joint = found["parameters"][name]
            alone = [trial["parameters"][name] for trial in found["trials"]]
            self.assertLess(abs(joint["mean"] - true), 4 * joint["sd"])
            precision = sum(one["sd"] ** -2 for one in alone)  # nearly linear in the initial states
            self.assertAlmostEqual(joint["sd"] / precision**-0.5, 1, delta=0.1)

    def test_contradicting_recordings_are_named_with_the_parameter(self):
        found = json.loads(self.infer(self.experiment, self.a, self.other, "--joint", "--json"))
        self.assertIn("trials_disagree", found["statuses"])
        worst = found["agreement"]["contradictions"][0]
        self.assertEqual(worst["parameter"], "k")
        self.assertGreater(worst["distance"], 4)
        self.assertGreater(found["parameters"]["k"]["sd"], 1)  # the scatter of 100 and 103
        table = self.infer(self.experiment, self.a, self.other, "--joint")
        self.assertIn("recordings disagree (p < 0.0005)", table)
        self.assertRegex(table, r"a.csv contradicts .*other.csv in k by [0-9.]+ sd")
        self.assertIn(f"twinmap diagnose {self.experiment} {self.a} {self.other}\n", table)

    def test_windows_of_a_record_are_recordings(self):
        found = json.loads(self.infer(self.experiment, self.long, "--windows", "1.5", "--json"))
        self.assertEqual(len(found["trials"]), 5)
        self.assertTrue(found["agreement"]["agrees"])
        self.assertLess(abs(found["parameters"]["k"]["mean"] - 100), 4 * found["parameters"]["k"]["sd"])

    def test_windows_that_are_inferred_one_by_one_say_whether_they_agree(self):
        first, second = (path.read_text().splitlines()[1:] for path in (self.a, self.other))
        later = [f"{float(line.split(',')[0]) + 2:.2f},{line.split(',')[1]}" for line in second]
        both = self.folder / "both.csv"
        both.write_text("\n".join(["t,x", *first, *later]) + "\n")
        windows = [
            json.loads(line)
            for line in self.infer(self.experiment, both, "--start", 0, "--start", 2, "--json").splitlines()
        ]
        for one, other in (windows, windows[::-1]):
            self.assertEqual(one["statuses"], ["trials_disagree"])
            k = one["parameters"]["k"]
            self.assertTrue(k["lower"] < other["parameters"]["k"]["mean"] < k["upper"])
        table = self.infer(self.experiment, both, "--start", 0, "--start", 2)
        for start in (0, 2):
            self.assertIn(f"{both} from {start} s: trials_disagree", table)
        self.assertIn("k scatters by", table)
        self.assertIn(f"twinmap diagnose {self.experiment} {both} --start 0 --start 2\n", table)
        agreeing = self.infer(self.experiment, self.long, "--start", 0, "--start", 2, "--json").splitlines()
        self.assertEqual([json.loads(line)["status"] for line in agreeing], ["ok", "ok"])

    def test_the_estimate_is_a_prior_of_the_next_one(self):
        (self.folder / "first.json").write_text(self.infer(self.experiment, self.a, "--json"))
        second = self.folder / "second.yaml"
        second.write_text(OSCILLATOR + "priors: [{from: first.json}]\n")
        together = json.loads(self.infer(self.experiment, self.a, self.b, "--joint", "--json"))["parameters"]
        updated = json.loads(self.infer(second, self.b, "--json"))["parameters"]
        for name in ("k", "d"):
            self.assertAlmostEqual(updated[name]["mean"], together[name]["mean"], delta=0.3 * together[name]["sd"])
            self.assertAlmostEqual(updated[name]["sd"] / together[name]["sd"], 1, delta=0.1)

    def test_trials_tell_together_what_none_tells_alone(self):
        weighed = self.folder / "weighed.yaml"
        weighed.write_text(WEIGHED)
        recordings = []
        for trial in ("free", "step"):
            path = self.folder / f"{trial}.csv"
            point = ["parameters.k=90", "parameters.m=1.1", f"trial={trial}"]
            result = call("simulate", weighed, "--noise", "--csv", path, *point)
            self.assertEqual(result.returncode, 0, result.stderr)
            recordings += ["--trial", f"{trial}={path}"]
        found = json.loads(self.infer(weighed, *recordings, "--json"))
        self.assertEqual([one["label"] for one in found["trials"]], ["free", "step"])
        free, step = (one["parameters"] for one in found["trials"])
        joint = found["parameters"]
        for name, true in (("k", 90), ("m", 1.1)):
            self.assertLess(abs(joint[name]["mean"] - true), 4 * joint[name]["sd"])
            self.assertLess(joint[name]["sd"], 1.05 * min(free[name]["sd"], step[name]["sd"]))
        self.assertGreater(free["k"]["sd"], 5 * joint["k"]["sd"])

    def test_one_trial_alone_is_inferred_as_its_own_file_would_be(self):
        weighed, step, recording = (self.folder / name for name in ("one.yaml", "step.yaml", "one.csv"))
        weighed.write_text(WEIGHED)
        own = "excitation: {F: {unit: N, pulses: [{amplitude: 4, start: 0, end: 9}]}}\n"
        step.write_text(WEIGHED[: WEIGHED.index("excitation:")] + own)
        result = call("simulate", weighed, "--noise", "--csv", recording, "trial=step")
        self.assertEqual(result.returncode, 0, result.stderr)
        alone = json.loads(self.infer(weighed, "--trial", f"step={recording}", "--json"))
        expected = json.loads(self.infer(step, recording, "--json"))
        self.assertEqual(alone.keys(), expected.keys())
        for name, one in expected["parameters"].items():
            self.assertAlmostEqual(alone["parameters"][name]["mean"], one["mean"], delta=1e-6 * one["sd"])
        rows = self.infer(weighed, "--trial", f"step={recording}", "--csv").splitlines()
        self.assertEqual(rows, self.infer(step, recording, "--csv").splitlines())

    def test_a_run_is_inferred_jointly_by_its_experiment(self):
        run = self.folder / "run"
        experiment = self.folder / "of_run.yaml"
        experiment.write_text(OSCILLATOR + "inverse_map: none\ndesign: {test: {method: uniform, samples: 4}}\n")
        result = call("run", experiment, "--out", run)
        self.assertEqual(result.returncode, 0, result.stderr)
        found = json.loads(self.infer(run, self.a, self.b, "--joint", "--json"))
        expected = json.loads(self.infer(self.experiment, self.a, self.b, "--joint", "--json"))
        self.assertEqual(found["parameters"].keys(), expected["parameters"].keys())
        self.assertGreater(found["effective_sample_size"], 100.0)
        for name, one in expected["parameters"].items():
            self.assertAlmostEqual(found["parameters"][name]["mean"], one["mean"], delta=1e-3 * one["sd"])

    def test_segments_of_an_unstable_machine(self):
        # the recording was made with c = 1.457e-5, g0 = 1.45e-3, d = 0.15 and a controller that the file does not have
        levitation = EXPERIMENTS / "mechanisms" / "magnetic_levitation.yaml"
        arguments = [levitation, levitation.with_suffix(".csv"), "--segments", "0.1"]
        found = json.loads(self.infer(*arguments, "--json"))
        self.assertEqual(found["statuses"], ["ok"])
        self.assertEqual(found["segments"], {"count": 20, "length": 0.1, "states": 2})
        self.assertAlmostEqual(found["trust"]["degrees"], 2000 - 20 * 2 - 3, delta=1)
        for name, true in (("c", 1.457e-5), ("g0", 1.45e-3), ("d", 0.15)):
            self.assertLess(abs(found["parameters"][name]["mean"] - true), 4 * found["parameters"][name]["sd"])
        beginning = self.folder / "beginning.csv"  # the other forms of what is printed, of three segments
        with levitation.with_suffix(".csv").open() as whole:
            beginning.write_text("".join(itertools.islice(whole, 302)))
        begun = [levitation, beginning, "--segments", "0.1"]
        table = self.infer(*begun)
        self.assertIn("3 segments of 0.1 s, each with its own initial state (2 numbers, eliminated)", table)
        rows = self.infer(*begun, "--csv").splitlines()
        self.assertEqual(len(rows), 4)
        short = call("infer", *arguments[:3], "0.002")
        self.assertIn("2 samples of 1 outputs, which do not determine its 2 initial states", short.stderr)
        both = call("infer", *arguments, "--joint")
        self.assertIn("leave --joint, --trial and --windows out", both.stderr)

    def test_errors_say_what_to_do(self):
        one = call("infer", self.experiment, self.a, "--joint")
        self.assertIn("give several files, starts or windows", one.stderr)
        unknown = call("infer", self.experiment, self.a, "--trial", f"kick={self.b}")
        self.assertIn("'kick' is not a trial of the experiment", unknown.stderr)
        self.assertNotEqual(unknown.returncode, 0)


if __name__ == "__main__":
    unittest.main()
