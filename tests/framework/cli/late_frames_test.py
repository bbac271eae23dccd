"""Recordings whose frames came late or not at all, of inputs and outputs. The oracle is scipy's exact solution."""
import json
import unittest

import numpy as np
import scipy.signal

from support import FolderTestCase, call

STEP = 0.02
MACHINES = {  # system matrix and input of a state (coordinate, speed), truth, and how an experiment says it
    "cart": (
        [[0, 1], [-100, -0.75]],
        [[0], [0.5]],
        {"m": 2.0, "d": 1.5, "k": 200.0},
        "{m: {bounds: [1, 4], unit: kg}, d: {bounds: [0.5, 5], unit: N s/m}, k: {bounds: [100, 400], unit: N/m}}",
        """
  bodies: {cart: {mass: m, joint: {type: slider, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: k}]
  dampers: [{coordinate: x, damping: d}]
  force_laws: [{coordinate: x, force: u}]
""",
        "N",
    ),
    "flywheel": (
        [[0, 1], [-30, -1.2]],
        [[0], [20]],
        {"J": 0.05, "c": 0.06, "s": 1.5},
        "{J: {bounds: [0.02, 0.1], unit: kg m2}, c: {bounds: [0.01, 0.3], unit: N m s/rad}, "
        "s: {bounds: [0.5, 4], unit: N m/rad}}",
        """
  bodies: {wheel: {mass: 1, inertia: J, joint: {type: pin, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: s}]
  dampers: [{coordinate: x, damping: c}]
  force_laws: [{coordinate: x, force: u}]
""",
        "N m",
    ),
}


def make_input(generator, held):
    """Its values every 0.1 ms over 8 s: levels held for 60 to 200 ms, or straight between samples of a band of sines."""
    fine = np.arange(0, 8.2, 1e-4)
    if not held:
        phases, amplitudes = generator.uniform(0, 6.28, 12), generator.normal(size=12)
        knots = np.arange(0, 8.3, STEP)
        waves = [a * np.sin(6.28 * 0.3 * (i + 1) * knots + p) for i, (a, p) in enumerate(zip(amplitudes, phases))]
        return fine, np.interp(fine, knots, sum(waves))
    edges = np.cumsum(generator.integers(3, 11, 200) * 200)
    return fine, generator.normal(size=201)[np.searchsorted(edges, np.arange(len(fine)), side="right")]


def record(machine, held, seed, noise):
    """Rows t, u, x of a recorder that is late in some of them by up to 0.6 of a step, and loses others."""
    matrix, column = MACHINES[machine][:2]
    generator = np.random.default_rng(seed)
    fine, u = make_input(generator, held)
    _, states, _ = scipy.signal.lsim((matrix, column, np.eye(2), np.zeros((2, 1))), u, fine, interp=not held)
    ticks = np.arange(0, 8.1, STEP)
    late = np.where(generator.random(len(ticks)) < 0.03, generator.uniform(0, 0.6, len(ticks)) * STEP, 0)
    late[0] = 0
    kept = (generator.random(len(ticks)) > 0.03) | (ticks < 0.05) | (ticks > 8.0)
    at = np.round((ticks + late)[kept] / 1e-4).astype(int)
    return fine[at], u[at], states[at, 0] + noise * generator.normal(size=len(at))


def write_experiment(machine, held, noise, measured=""):
    _, _, _, parameters, system, unit = MACHINES[machine]
    return f"""
name: late
parameters: {parameters}
system:{system}
excitation:
  u: {{unit: {unit}, tables: [{{measured: {{file: m.csv, column: u, time: t{measured}}}, interpolation: {'hold' if held else 'linear'}}}]}}
outputs: {{x: {{coordinate: x}}}}
simulation: {{duration: 8}}
features: [{{samples: {{outputs: [x], start: 0.02, interval: 0.02, count: 399}}}}]
noise: {{stddev: {{x: {noise}}}}}
inverse_map: none
"""


class LateFrames(FolderTestCase):
    def write(self, columns):
        rows = [",".join(f"{cell:.9g}" for cell in row) for row in zip(*columns)]
        (self.folder / "m.csv").write_text("t,u,x\n" + "\n".join(rows) + "\n")

    def infer(self, experiment, *options):
        path = self.folder / "experiment.yaml"
        path.write_text(experiment)
        return call("infer", path, self.folder / "m.csv", "--json", *options)

    def test_the_truth_is_within_the_standard_deviations(self):
        for machine, (_, _, truth, *_) in MACHINES.items():
            for held in (True, False):
                noise = 2e-4 if machine == "cart" else 2e-2
                self.write(record(machine, held, 3, noise))
                result = self.infer(write_experiment(machine, held, noise))
                self.assertEqual(result.returncode, 0, result.stderr)
                found = json.loads(result.stdout)
                self.assertEqual(found["statuses"], ["ok"], (machine, held))
                self.assertIn("late or lost", "".join(found["remarks"]))
                for name, value in truth.items():
                    estimate = found["parameters"][name]
                    self.assertLess(abs(estimate["mean"] - value), 4 * estimate["sd"], (machine, held, name))

    def test_a_gap_is_refused_beyond_what_is_stated(self):
        t, u, x = record("cart", False, 4, 2e-4)
        keep = (t < 3) | (t > 3.1)
        self.write((t[keep], u[keep], x[keep]))
        self.assertEqual(self.infer(write_experiment("cart", False, 2e-4)).returncode, 0)
        result = self.infer(write_experiment("cart", False, 2e-4, ", max_gap: 0.06"))
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("longer than max_gap, 0.06 s", result.stderr)

    def test_the_noise_of_an_excitation_is_in_the_standard_deviations(self):
        t, u, x = record("flywheel", False, 5, 2e-3)
        level = 0.03 * np.std(u)
        self.write((t, u + level * np.random.default_rng(6).normal(size=len(u)), x))
        silent = json.loads(self.infer(write_experiment("flywheel", False, 2e-3)).stdout)
        stated = json.loads(self.infer(write_experiment("flywheel", False, 2e-3, f", noise: {level:.6g}")).stdout)
        self.assertEqual(stated["statuses"], ["ok"])
        for name, value in MACHINES["flywheel"][2].items():
            estimate = stated["parameters"][name]
            self.assertLess(abs(estimate["mean"] - value), 4 * estimate["sd"], name)
            self.assertGreater(estimate["sd"], silent["parameters"][name]["sd"], name)

    def record_noisily(self, share):
        """Two recordings of the cart, whose excitation has noise of a share of its rms."""
        files = []
        for seed in (8, 9):
            t, u, x = record("cart", False, seed, 2e-4)
            level = share * np.std(u)
            self.write((t, u + level * np.random.default_rng(seed).normal(size=len(u)), x))
            files.append((self.folder / "m.csv").rename(self.folder / f"m{seed}.csv"))
        (self.folder / "m.csv").write_text(files[0].read_text())
        return level, files

    def call(self, *arguments):
        result = call(*arguments, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def test_the_noise_of_an_excitation_counts_in_all_recordings(self):
        level, files = self.record_noisily(0.03)
        path = self.folder / "experiment.yaml"
        path.write_text(write_experiment("cart", False, 2e-4))
        silent = self.call("infer", path, *files, "--joint")
        self.assertIn("model_mismatch", silent["statuses"])
        self.assertIn("noise of u of about", str([one["remarks"] for one in silent["trials"]]))
        path.write_text(write_experiment("cart", False, 2e-4, f", noise: {level:.6g}"))
        stated = self.call("infer", path, *files, "--joint")
        self.assertEqual(stated["statuses"], ["ok"])
        for name, value in MACHINES["cart"][2].items():
            estimate = stated["parameters"][name]
            self.assertLess(abs(estimate["mean"] - value), 4 * estimate["sd"], name)
            for one, other in zip(stated["trials"], silent["trials"]):
                of_noise = np.sqrt(other["parameters"][name]["sd"] ** 2 - silent["parameters"][name]["scatter"] ** 2)
                self.assertGreater(one["parameters"][name]["sd"], of_noise, name)
        before = self.call("diagnose", path, *files)["before"]
        self.assertLess(before["chi_square"], before["degrees"] + 4 * np.sqrt(2 * before["degrees"]))
        predicted = self.call("validate", path, files[0], "--against", files[1])["predictions"][0]
        self.assertTrue(predicted["passed"])
        self.assertLess(predicted["rms"], 1.3)

    def test_empty_cells_and_stamps_that_repeat_are_no_obstacle(self):
        t, u, x = record("cart", True, 7, 2e-4)
        rows = [f"{a:.9g},{b:.9g},{c:.9g}" for a, b, c in zip(t, u, x)]
        rows[100] = rows[100].replace(f",{u[100]:.9g},", ",,")
        rows.insert(50, rows[50])
        (self.folder / "m.csv").write_text("t,u,x\n" + "\n".join(rows) + "\n")
        found = json.loads(self.infer(write_experiment("cart", True, 2e-4)).stdout)
        self.assertEqual(found["statuses"], ["ok"])


if __name__ == "__main__":
    unittest.main()
