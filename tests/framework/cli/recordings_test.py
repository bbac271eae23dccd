"""Recordings by several recorders: clocks, files, triggers. The oracle is scipy's exact solution of a linear oscillator."""
import json
import unittest

import numpy as np
import scipy.signal

from support import EXPERIMENTS, FolderTestCase, call

MASS, NOISE = 2.0, 5e-5
TRUE = {"k": 200.0, "d": 1.5, "late": 0.02}
FREQUENCIES = np.array([0.5, 1, 1.5, 2, 2.5, 3])
EXPERIMENT = """
name: recorders
parameters:
  k: {bounds: [150, 250], unit: N/m}
  d: {bounds: [0.5, 3], unit: N s/m}
  late: {bounds: [-0.05, 0.05], unit: s}
system:
  bodies: {cart: {mass: 2, joint: {type: slider, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: k}]
  dampers: [{coordinate: x, damping: d}]
  force_laws: [{coordinate: x, force: F}]
excitation:
  F: {unit: N, tables: [{measured: {file: force.csv, column: F, time: t, delay: DELAY}, interpolation: cubic}]}
outputs: {x: {coordinate: x}, v: {speed: x}}
simulation: {duration: 8}
features: [{samples: {outputs: [x, v], start: 0.1, interval: 0.02, count: 390}}]
noise: {stddev: {x: 5e-5, v: 5e-4}}
"""


def calc_force(t):
    """A multisine from t = 0 on, which begins without a jump."""
    return np.where(t < 0, 0.0, np.sin(2 * np.pi * np.outer(t, FREQUENCIES)).sum(axis=1))


class Recorders(FolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        fine = np.arange(0, 9, 1e-4)
        system = ([[0, 1], [-TRUE["k"] / MASS, -TRUE["d"] / MASS]], [[0], [1 / MASS]], np.eye(2), [[0], [0]])
        _, states, _ = scipy.signal.lsim(system, calc_force(fine), fine)
        generator = np.random.default_rng(4)
        cls.t = fine[::200]
        cls.x = states[::200, 0] + NOISE * generator.normal(size=len(cls.t))
        cls.v = states[::200, 1] + 10 * NOISE * generator.normal(size=len(cls.t))
        cls.v_at = lambda self, t: np.interp(t, fine, states[:, 1]) + 10 * NOISE * generator.normal(size=len(t))
        clock = np.arange(-100, 1000) * 0.01
        cls.write("force.csv", {"t": clock, "F": calc_force(clock - TRUE["late"])})
        cls.write("m.csv", {"t": cls.t, "x": cls.x, "v": cls.v})

    @classmethod
    def write(cls, name, columns):
        rows = [",".join(f"{cell:.17g}" for cell in row) for row in zip(*columns.values())]
        (cls.folder / name).write_text(",".join(columns) + "\n" + "\n".join(rows) + "\n")

    def infer(self, experiment, measurement, *options):
        path = self.folder / "experiment.yaml"
        path.write_text(experiment)
        result = call("infer", path, self.folder / measurement, "--json", *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def assert_right(self, found, names):
        self.assertEqual(found["statuses"], ["ok"])
        for name in names:
            estimate = found["parameters"][name]
            self.assertLess(abs(estimate["mean"] - TRUE[name]), 4 * estimate["sd"], name)

    def test_a_delay_that_nobody_knows_is_found(self):
        found = self.infer(EXPERIMENT.replace("DELAY", "late"), "m.csv")
        self.assert_right(found, TRUE)
        self.assertLess(found["parameters"]["late"]["sd"], 1e-4)

    def test_a_file_and_a_clock_of_its_own(self):
        stamps = [f"2026-11-26T10:00:{5 + t:010.7f}Z" for t in self.t]
        lines = [f"{stamp};{v:.17g}" for stamp, v in zip(stamps, self.v)]
        (self.folder / "speed.csv").write_text("stamp;speed [m/s]\n" + "\n".join(lines) + "\n")
        self.write("x.csv", {"ms": 1e3 * (self.t + 3), "x": self.x, "F": calc_force(self.t)})
        measurement = (
            "measurement: {time: 'ms [ms]', start: {when: F > 0.01, time: -0.02}, "
            "columns: {v: {column: speed, file: speed.csv, time: stamp, delay: 1795687202}}}\n"
        )
        known = EXPERIMENT.replace("  late: {bounds: [-0.05, 0.05], unit: s}\n", "").replace("DELAY", "0.02")
        found = self.infer(known + measurement, "x.csv")
        self.assertAlmostEqual(found["start"], 3.0)
        self.assert_right(found, ["k", "d"])
        self.assertEqual(found.get("left_out", []), [])

    def test_all_commands_take_features_at_the_times_of_a_recording(self):
        """A sensor with a file, a clock and a rate of its own: slower than the features ask for."""
        rows = slice(3, None, 3)
        self.write("slow.csv", {"clock": self.t[rows] + 0.003 + 7, "v": self.v_at(self.t[rows] + 0.003)})
        known = EXPERIMENT.replace("  late: {bounds: [-0.05, 0.05], unit: s}\n", "").replace("DELAY", "0.02")
        known += "measurement: {columns: {v: {column: v, file: slow.csv, time: clock, delay: 7}}}\n"
        for sensor in ("", ", sensor: {delay: 0}", ", sensor: {delay: lag}"):
            nuisance = "nuisance: {lag: {bounds: [-0.01, 0.01], unit: s}}\n" if "lag" in sensor else ""
            experiment = known.replace("v: {speed: x}", f"v: {{speed: x{sensor}}}") + nuisance
            experiment = experiment.replace("duration: 8", "duration: 8.1")
            found = self.infer(experiment, "m.csv")
            self.assert_right(found, ["k", "d"])
            self.assertNotIn("v", " ".join(found.get("left_out", [])))
            result = call("diagnose", self.folder / "experiment.yaml", self.folder / "m.csv", "--json")
            self.assertEqual(result.returncode, 0, result.stderr)
            degrees = json.loads(result.stdout)["before"]["degrees"]
            self.assertAlmostEqual(degrees, found["trust"]["degrees"], delta=1.5)

    def test_a_sensor_that_no_feature_uses_needs_no_column(self):
        known = EXPERIMENT.replace("  late: {bounds: [-0.05, 0.05], unit: s}\n", "").replace("DELAY", "0.02")
        self.write("x_alone.csv", {"t": self.t, "x": self.x})
        self.assert_right(self.infer(known.replace("outputs: [x, v]", "outputs: [x]"), "x_alone.csv"), ["k", "d"])

    def test_a_table_without_a_header_has_columns_by_number(self):
        known = EXPERIMENT.replace("  late: {bounds: [-0.05, 0.05], unit: s}\n", "").replace("DELAY", "0.02")
        rows = [f"{t:.17g} {x:.17g} {v:.17g}" for t, x, v in zip(self.t, self.x, self.v)]
        (self.folder / "numbers.txt").write_text("\n".join(rows) + "\n")
        found = self.infer(known + "measurement: {time: 1, columns: {x: 2, v: 3}}\n", "numbers.txt")
        self.assert_right(found, ["k", "d"])

    def window(self, start="0"):
        """Three seconds from an unknown state, the force in a file of its own whose clock is late by 0.02 s."""
        known = EXPERIMENT.replace("  late: {bounds: [-0.05, 0.05], unit: s}\n", "").replace("DELAY", "0.02")
        initial = (
            "nuisance: {x0: {bounds: [-0.1, 0.1], unit: m}, v0: {bounds: [-1, 1], unit: m/s}}\n"
            "initial: {coordinates: {x: x0}, speeds: {x: v0}}\n"
        )
        short = known.replace("duration: 8", "duration: 3").replace("count: 390", "count: 145")
        return short + initial + f"measurement: {{start: {start}}}\n"

    def test_an_excitation_in_its_own_file_follows_the_start(self):
        from_trigger = self.window("{when: x > 0.005}")
        for experiment, start in ((self.window(), 4), (self.window(), 1.6), (self.window("{when: first}"), 4)):
            self.assert_right(self.infer(experiment, "m.csv", "--start", start), ["k", "d"])
        self.write("both.csv", {"t": self.t, "x": self.x, "v": self.v, "F": calc_force(self.t - TRUE["late"])})
        self.assert_right(self.infer(from_trigger, "both.csv"), ["k", "d"])

    def test_an_excitation_in_its_own_file_follows_segments_and_predictions(self):
        self.assert_right(self.infer(self.window(), "m.csv", "--start", 2, "--segments", 1), ["k", "d"])
        path, recording = self.folder / "experiment.yaml", self.folder / "m.csv"
        result = call("validate", path, recording, "--start", 4, "--against", recording, "--against-start", 1, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertLess(json.loads(result.stdout)["predictions"][0]["rms"], 1.2)

    def test_all_commands_take_several_recordings_at_their_own_times(self):
        """The speed at a third of the rate, between the times of the features, by a clock of its own."""
        rows = slice(3, None, 3)
        self.write("sparse.csv", {"clock": self.t[rows] + 0.003 + 7, "v": self.v_at(self.t[rows] + 0.003)})
        own = "columns: {v: {column: v, file: sparse.csv, time: clock, delay: 7}}, start"
        for sensor in ("", ", sensor: {delay: 0}", ", sensor: {delay: lag}"):
            lag = "lag: {bounds: [-0.01, 0.01], unit: s}, " if "lag" in sensor else ""
            experiment = (
                self.window().replace("v: {speed: x}", f"v: {{speed: x{sensor}}}").replace("start: 0}", f"{own}: 0}}")
            )
            experiment = experiment.replace("nuisance: {", "nuisance: {" + lag).replace("duration: 3", "duration: 3.1")
            joint = self.infer(experiment, "m.csv", "--joint", "--start", 1, "--start", 4)
            for one in [joint, *joint["trials"]]:
                self.assert_right(one, ["k", "d"])
            degrees = sum(one["trust"]["degrees"] for one in joint["trials"]) + 2  # k and d count once
            path, recording = self.folder / "experiment.yaml", self.folder / "m.csv"
            (self.folder / "other.yaml").write_text(experiment.replace("name: recorders", "name: other"))
            windows = ("--start", 1, "--start", 4, "--json")
            diagnosis = self.call("diagnose", path, recording, *windows)
            self.assertAlmostEqual(diagnosis["before"]["degrees"], degrees, delta=1.5)
            selected = self.call("select", path, self.folder / "other.yaml", recording, *windows)
            self.assertAlmostEqual(selected["structures"][0]["degrees"], degrees, delta=1.5)
            predicted = self.call(
                "validate", path, recording, "--start", 4, "--against", recording, "--against-start", 1, "--json"
            )
            self.assertLess(predicted["predictions"][0]["rms"], 1.2)

    def call(self, *arguments):
        result = call(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def test_an_excitation_that_cannot_follow_a_trigger_is_named(self):
        path = self.folder / "experiment.yaml"
        path.write_text(self.window("{when: x > 5}"))
        result = call("infer", path, self.folder / "m.csv", "--start", 4)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("force.csv: the excitation in it cannot follow the start", result.stderr)


class Modes(FolderTestCase):
    """The oracle is numpy's eigenvalues of the chain of three masses."""

    EXPERIMENT = EXPERIMENTS / "three_mass_chain/modes.yaml"
    TRUE = {"k1": 930.0, "k2": 1080.0, "k3": 1010.0, "d": 9.5}

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        springs = np.array([[1, 0, 0], [-1, 1, 0], [0, -1, 1]])  # elongations by displacements
        stiffness = springs.T @ np.diag([cls.TRUE[name] for name in ("k1", "k2", "k3")]) @ springs
        damping = cls.TRUE["d"] * springs.T @ springs
        inverse = np.diag(1 / np.array([2, 1, 0.5]))
        matrix = np.block([[np.zeros((3, 3)), np.eye(3)], [-inverse @ stiffness, -inverse @ damping]])
        roots = np.array(sorted((root for root in np.linalg.eigvals(matrix) if root.imag > 0), key=abs))
        generator = np.random.default_rng(2)
        cls.frequency_sd, cls.damping_sd = np.array([0.002, 0.02, 0.05]), np.array([2e-4, 2e-3, 1e-3])
        cls.frequency = abs(roots) / (2 * np.pi) + cls.frequency_sd * generator.normal(size=3)
        cls.damping = -roots.real / abs(roots) + cls.damping_sd * generator.normal(size=3)

    def infer(self, header, *columns):
        path = self.folder / "modes.csv"
        rows = [",".join(map(str, row)) for row in zip(*columns)]
        path.write_text(header + "\n" + "\n".join(rows) + "\n")
        result = call("infer", self.EXPERIMENT, path, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def test_a_table_with_its_own_standard_deviations(self):
        found = self.infer(
            "frequency [Hz],frequency_sd,damping_ratio,damping_ratio_sd",
            self.frequency,
            self.frequency_sd,
            self.damping,
            self.damping_sd,
        )
        self.assertEqual(found["statuses"], ["ok"])
        for name, true in self.TRUE.items():
            estimate = found["parameters"][name]
            self.assertLess(abs(estimate["mean"] - true), 4 * estimate["sd"], name)
        # d is 2 w z m of the lowest mode, all but alone: its relative error is that of the ratio
        ratio_error = self.damping_sd[0] / self.damping[0]
        self.assertLess(found["parameters"]["d"]["sd"] / self.TRUE["d"], 1.2 * ratio_error)

    def test_modes_that_are_missing_are_left_out(self):
        found = self.infer("mode,frequency,damping_ratio", [3, 1], self.frequency[[2, 0]], ["", self.damping[0]])
        self.assertIn("1 of 3 frequencies of modes", found["left_out"])

    def test_a_column_of_another_name_is_an_error(self):
        """What is left out whole: 'natural_frequency', 'zeta'."""
        for header, lacks in (("natural_frequency,damping_ratio", "frequency"), ("frequency,zeta", "damping_ratio")):
            with self.subTest(header):
                path = self.folder / "named.csv"
                rows = [f"{f},{d}" for f, d in zip(self.frequency, self.damping)]
                path.write_text(header + "\n" + "\n".join(rows) + "\n")
                result = call("infer", self.EXPERIMENT, path)
                self.assertNotEqual(result.returncode, 0)
                self.assertIn(f"no numbers in a column '{lacks}'", result.stderr)

    def test_modes_beside_responses_are_read_as_simulate_writes_them(self):
        """With the name of the file for itself, and with that which the experiment gives."""
        chain = EXPERIMENTS / "three_mass_chain/frequency_response.yaml"
        beside = [
            "noise.modes={frequency: 0.001, damping_ratio: 1e-4}",
            "features=[{modes: {count: 3}}, {samples: {outputs: [mass1], start: 0, interval: 0.1, count: 100}}]",
        ]
        for name, more in (("m.modes.csv", []), ("identified.csv", ["measurement={modes: identified.csv}"])):
            with self.subTest(name):
                file = self.folder / "beside.yaml"
                file.write_text(call("check", "--full", chain, *beside, *more).stdout)
                result = call("simulate", file, "--noise", "--csv", self.folder / "m.csv", "parameters.k1=930")
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertTrue((self.folder / name).exists())
                result = call("infer", file, self.folder / "m.csv", "--json")
                self.assertEqual(result.returncode, 0, result.stderr)
                found = json.loads(result.stdout)
                self.assertEqual((found["status"], found.get("left_out")), ("ok", None))
                self.assertLess(abs(found["parameters"]["k1"]["mean"] - 930), 4 * found["parameters"]["k1"]["sd"])
                (self.folder / name).unlink()


class FrequencyResponses(FolderTestCase):
    """The oracle is numpy's solution of the chain's equations at each frequency."""

    EXPERIMENT = EXPERIMENTS / "three_mass_chain/frequency_response.yaml"
    TRUE = {"k1": 930.0, "k2": 1080.0, "k3": 1010.0, "m2": 0.95, "d2": 9.5}

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.frequencies = np.array([0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 5.5, 6, 7, 8, 9, 10])
        springs = np.array([[1, 0, 0], [-1, 1, 0], [0, -1, 1]])  # elongations by displacements
        mass = np.diag([2, cls.TRUE["m2"], 0.5])
        stiffness = springs.T @ np.diag([cls.TRUE[name] for name in ("k1", "k2", "k3")]) @ springs
        damping = springs.T @ np.diag([10, cls.TRUE["d2"], 10]) @ springs
        generator = np.random.default_rng(3)
        responses = []
        for omega in 2 * np.pi * cls.frequencies:
            responses.append(np.linalg.solve(stiffness + 1j * omega * damping - omega**2 * mass, [0, 0, 1])[[0, 2]])
        cls.sd = 2e-6
        noise = generator.normal(size=(2, len(responses), 2))
        cls.responses = np.array(responses) + cls.sd * (noise[0] + 1j * noise[1])

    def infer(self, columns, *arguments):
        path = self.folder / "frf.csv"
        rows = [",".join("" if np.isnan(x) else f"{x:.17g}" for x in row) for row in zip(*columns.values())]
        path.write_text(",".join(columns) + "\n" + "\n".join(rows) + "\n")
        result = call("infer", self.EXPERIMENT, path, "--json", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def make_columns(self):
        columns = {"frequency [Hz]": self.frequencies}
        for i, name in enumerate(("mass1", "mass3")):
            columns |= {f"{name}_real": self.responses[:, i].real, f"{name}_imaginary": self.responses[:, i].imag}
            columns[f"{name}_sd"] = np.full(len(self.frequencies), self.sd)
        return columns

    def assert_right(self, found):
        self.assertEqual(found["statuses"], ["ok"])
        for name, true in self.TRUE.items():
            estimate = found["parameters"][name]
            self.assertLess(abs(estimate["mean"] - true), 4 * estimate["sd"], name)
            self.assertLess(estimate["sd"], 0.01 * true, name)

    def test_a_table_of_real_and_imaginary_parts(self):
        self.assert_right(self.infer(self.make_columns()))

    def test_a_table_of_magnitudes_and_phases(self):
        columns = self.make_columns()
        for i, name in enumerate(("mass1", "mass3")):
            del columns[f"{name}_real"], columns[f"{name}_imaginary"]
            columns[f"{name}_magnitude [mm/N]"] = 1e3 * abs(self.responses[:, i])
            columns[f"{name}_phase [deg]"] = np.degrees(np.angle(self.responses[:, i]))
        self.assert_right(self.infer(columns))

    def test_lines_that_are_missing_are_left_out(self):
        columns = self.make_columns()
        columns["mass1_real"] = np.where(self.frequencies == 3, np.nan, columns["mass1_real"])
        found = self.infer({name: values[1:] for name, values in columns.items()})
        self.assertEqual(found["left_out"], ["2 of 16 lines of mass1/F", "1 of 16 lines of mass3/F"])
        self.assert_right(found)


if __name__ == "__main__":
    unittest.main()
