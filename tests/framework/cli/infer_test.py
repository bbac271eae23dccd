"""From measurements to parameters: twinmap infer."""
import csv
import io
import json
import subprocess
import unittest

import h5py
import numpy as np
import scipy.io
import yaml
from scipy.interpolate import CubicSpline

from case_turns import take_turn
from support import TWINMAP, RunTestCase, call, read_csv, write_csv

TRUE = {"d_y": 0.95, "d_theta": 2.1e-4, "k_y": 8.5, "k_theta": 0.034}
POINT = [f"parameters.{name}={value}" for name, value in TRUE.items()]


def read_columns(path):
    rows = read_csv(path)
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


class InferCase(RunTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.measurement = cls.simulate("m.csv", *POINT)
        cls.columns = read_columns(cls.measurement)

    def infer(self, *arguments, **options):
        result = call("infer", self.run_folder, *arguments, **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def infer_json(self, *arguments):
        return json.loads(self.infer("--json", *arguments))

    def write(self, name, **columns):
        path = self.folder / name
        columns = {**self.columns, **columns}
        write_csv(path, columns.keys(), columns.values())
        return path


class Infer(InferCase):
    def test_finds_the_parameters_with_their_standard_deviation(self):
        inferred = self.infer_json(self.measurement)
        self.assertEqual(inferred["status"], "ok")
        for name, true in TRUE.items():
            estimate = inferred["parameters"][name]
            self.assertLess(abs(estimate["mean"] - true), 4 * estimate["sd"], name)
            self.assertAlmostEqual(
                estimate["upper"] - estimate["lower"], 3.92 * estimate["sd"], delta=1e-3 * estimate["sd"]
            )

    def test_simple_faults_of_a_measurement_are_named(self):
        y, theta = self.columns["y"], self.columns["theta"]
        for name, columns, said in (
            ("deg.csv", {"theta": np.rad2deg(theta)}, "theta is 57.3 times too large, as deg in the place of rad"),
            ("mm.csv", {"y": 1000 * y}, "y is 1000 times too large, as mm in the place of m"),
            ("sign.csv", {"theta": -theta}, "theta is of the other sign"),
            ("offset.csv", {"y": y + 0.5}, "y has an offset of 0.5"),
            ("swapped.csv", {"y": theta, "theta": y}, "the columns of y and theta are swapped"),
        ):
            with self.subTest(name):
                path = self.write(name, **columns)
                text = self.infer(path)
                self.assertIn(f"model_mismatch: the model does not explain the measurement: {said}", text)
                self.assertNotIn("larger than the data would permit", text)
                self.assertIn(said, self.infer_json(path)["fault"])
        self.assertIsNone(self.infer_json(self.measurement)["fault"])

    def test_a_simulated_p_value_claims_no_more_than_its_simulations_show(self):
        text = self.infer(self.write("far.csv", y=self.columns["y"] + 0.01), "--no-refine")
        self.assertRegex(text, r"model_mismatch.* \(chi-square .*, p < 0\.0\d+\)")

    def test_finds_what_its_power_says_it_finds(self):
        rows = read_csv(self.run_folder / "trust_power.csv")
        power = {row["name"]: float(row["smallest_change"]) for row in rows if row["smallest_change"]}
        self.assertEqual({row["name"] for row in rows}, {"m1", "m2", "y_COM", "z_COM", "I", "g", "y", "theta"})
        self.assertIn("m1", power)
        heavier = self.simulate("heavier.csv", f"constants.m1.value={3.3 * (1 + 3 * power['m1'])}", *POINT)
        self.assertEqual(self.infer_json(heavier)["status"], "model_mismatch")
        moved = self.write("moved.csv", y=self.columns["y"] + 3 * power["y"])
        self.assertEqual(self.infer_json(moved, "--no-refine")["status"], "model_mismatch")
        self.assertEqual(self.infer_json(moved)["status"], "sensor_offset")

    def test_infers_the_clean_test_responses_of_the_run(self):
        with h5py.File(self.run_folder / "samples.h5") as file:
            times, names = file["times"][:], [name.decode() for name in file["parameters/name"]]
            turn = take_turn(range(20))
            responses, points = file["test/responses"][turn], file["test/parameters"][turn]
        files = [self.folder / f"test_{i}.csv" for i in turn]
        for path, (y, theta) in zip(files, responses):
            write_csv(path, ["t", "y", "theta"], [times, y, theta])
        lines = self.infer("--json", *files).splitlines()
        self.assertEqual(len(lines), len(turn))
        for line, point in zip(lines, points):
            for name, true in zip(names, point):
                estimate = json.loads(line)["parameters"][name]
                self.assertLess(abs(estimate["mean"] - true), 4 * estimate["sd"], name)

    def test_table_csv_and_json_agree(self):
        inferred = self.infer_json(self.measurement)
        rows = list(csv.DictReader(io.StringIO(self.infer("--csv", self.measurement))))
        self.assertEqual([row["parameter"] for row in rows], list(TRUE))
        for row in rows:
            self.assertEqual(float(row["mean"]), inferred["parameters"][row["parameter"]]["mean"])
            self.assertEqual(row["status"], "ok")
        table = self.infer(self.measurement)
        self.assertIn("m.csv: ok", table)
        self.assertIn("k_theta", table)
        self.assertIn("N m/rad", table)

    def test_the_maps_file_alone_suffices(self):
        alone = self.folder / "elsewhere.h5"
        alone.write_bytes((self.run_folder / "maps.h5").read_bytes())
        result = call("infer", alone, self.measurement, "--json")
        self.assertEqual(json.loads(result.stdout), self.infer_json(self.measurement))

    def test_refine_agrees_with_the_map(self):
        refined = self.infer_json(self.measurement, "--refine")["refined"]
        self.assertTrue(refined["converged"])
        self.assertLess(refined["distance"], 5.0)
        for name, true in TRUE.items():
            estimate = refined["parameters"][name]
            self.assertLess(abs(estimate["mean"] - true), 4 * estimate["sd"], name)
        self.assertIn("refined in", self.infer(self.measurement, "--refine"))

    def test_the_answer_is_the_refined_one_where_it_is_accepted(self):
        inferred = self.infer_json(self.measurement)
        self.assertEqual(inferred["method"], "refined")
        self.assertEqual(inferred["refined"]["status"], "accepted")
        self.assertEqual(inferred["parameters"], inferred["refined"]["parameters"])
        by_map = self.infer_json(self.measurement, "--no-refine")
        self.assertEqual(by_map["method"], "gp")
        self.assertNotIn("refined", by_map)
        self.assertEqual(by_map["parameters"], inferred["inverse_map"]["parameters"])

    def test_what_is_not_accepted_leaves_the_posterior_and_says_what_is_wrong(self):
        wrong = dict(self.columns)
        wrong["y"] = np.roll(wrong["y"], 7)
        path = self.folder / "wrong.csv"
        write_csv(path, ["t", "y", "theta"], [wrong[name] for name in ("t", "y", "theta")])
        inferred = self.infer_json(path)
        self.assertEqual((inferred["status"], inferred["method"]), ("model_mismatch", "posterior"))
        self.assertEqual(inferred["parameters"], inferred["posterior"]["parameters"])
        self.assertNotIn("parameters", inferred["refined"])
        self.assertIn("sampled on the simulator", self.infer(path))
        row = next(csv.DictReader(io.StringIO(self.infer("--csv", path))))
        self.assertEqual((row["refined_mean"], row["refined_sd"]), ("", ""))

    def test_follows_a_stream(self):
        text = self.measurement.read_text()
        lines = self.infer("--follow", input=text + text + "\n").splitlines()
        self.assertEqual(len(lines), 2)
        expected = self.infer_json(self.measurement)["parameters"]
        for line in lines:
            self.assertEqual(json.loads(line)["parameters"], expected)

    def test_a_stream_answers_each_measurement_at_once(self):
        with subprocess.Popen(
            [TWINMAP, "infer", str(self.run_folder), "--follow"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        ) as process:
            for _ in range(3):
                process.stdin.write(self.measurement.read_text() + "\n")
                process.stdin.flush()
                self.assertEqual(json.loads(process.stdout.readline())["status"], "ok")
            process.stdin.close()
            self.assertEqual(process.wait(), 0)

    def test_resamples_a_finer_measurement_that_starts_later(self):
        fine = np.arange(0, 5.0005, 0.01)
        times = np.concatenate([[0.0], self.columns["t"]])
        finer = {name: CubicSpline(times, np.concatenate([[0.0], self.columns[name]]))(fine) for name in ("y", "theta")}
        path = self.folder / "fine.csv"
        write_csv(path, ["t", "y", "theta"], [fine + 2.5, finer["y"], finer["theta"]])
        inferred = self.infer_json(path, "--start", "2.5")
        expected = self.infer_json(self.measurement)
        for name in TRUE:
            estimate = expected["parameters"][name]
            self.assertAlmostEqual(inferred["parameters"][name]["mean"], estimate["mean"], delta=0.5 * estimate["sd"])


class Formats(InferCase):
    def expect_same(self, path):
        self.assertEqual(self.infer_json(path)["parameters"], self.infer_json(self.measurement)["parameters"])

    def test_matlab_files(self):
        scipy.io.savemat(self.folder / "m5.mat", self.columns)
        self.expect_same(self.folder / "m5.mat")

    def test_hdf5_files(self):
        with h5py.File(self.folder / "m.h5", "w") as file:
            for name, values in self.columns.items():
                file[name] = values
        self.expect_same(self.folder / "m.h5")


class Columns(RunTestCase):
    """A machine whose file has other names and units."""

    @classmethod
    def write_files(cls):
        experiment = yaml.safe_load(RunTestCase.FILE.read_text())
        experiment["measurement"] = {"time": "clock [ms]", "columns": {"y": "enc1 [mm]", "theta": "enc2 [degree]"}}
        cls.FILE = cls.folder / "machine.yaml"
        cls.FILE.write_text(yaml.safe_dump(experiment, sort_keys=False))

    def test_are_mapped_and_converted(self):
        columns = read_columns(self.simulate("m.csv", *POINT))
        path = self.folder / "machine.csv"
        write_csv(
            path,
            ["clock", "enc1", "enc2", "remark"],
            [1e3 * columns["t"], 1e3 * columns["y"], np.degrees(columns["theta"]), ["fine"] * len(columns["t"])],
        )
        inferred = json.loads(call("infer", self.run_folder, path, "--json").stdout)
        self.assertEqual(inferred["status"], "ok")
        for name, true in TRUE.items():
            estimate = inferred["parameters"][name]
            self.assertLess(abs(estimate["mean"] - true), 4 * estimate["sd"], name)


class BadMeasurements(InferCase):
    """Each gives a clear error, the others are still inferred, and the exit code says so."""

    def expect_error(self, path, *texts):
        result = call("infer", self.run_folder, path, self.measurement, "--json")
        self.assertEqual(result.returncode, 1, result.stderr)
        lines = [json.loads(line) for line in result.stdout.splitlines()]
        self.assertEqual([line["status"] for line in lines], ["error", "ok"])
        for text in texts:
            self.assertIn(text, lines[0]["error"])
            self.assertIn(text, result.stderr)

    def damage(self, name, line, text):
        path = self.folder / name
        lines = self.measurement.read_text().splitlines()
        lines[line] = text
        path.write_text("\n".join(lines) + "\n")
        return path

    def test_text_in_a_number(self):
        self.expect_error(self.damage("text.csv", 7, "0.35,0.1,broken"), "text.csv:8", "theta", "broken")

    def test_missing_column(self):
        path = self.folder / "missing.csv"
        path.write_text(self.measurement.read_text().replace("theta", "thetta", 1))
        self.expect_error(path, "missing.csv", "theta", "thetta")

    def test_constant(self):
        self.expect_error(self.write("constant.csv", y=np.full_like(self.columns["y"], 0.1)), "constant.csv", "y")

    def test_wrong_encoding(self):
        path = self.folder / "utf16.csv"
        path.write_text(self.measurement.read_text(), encoding="utf-16")
        self.expect_error(path, "utf16.csv", "UTF-16")

    def test_wrong_unit(self):
        path = self.folder / "unit.csv"
        path.write_text(self.measurement.read_text().replace("theta", "theta [kg]", 1))
        self.expect_error(path, "unit.csv", "theta", "kg")

    def test_a_file_that_is_not_there(self):
        self.expect_error(self.folder / "nowhere.csv", "nowhere.csv")

    def test_a_sparse_file_of_a_gigabyte(self):
        path = self.folder / "large.csv"
        with open(path, "wb") as file:
            file.write(b"t,y,theta\n")
            file.truncate(1 << 30)
        self.expect_error(path, "large.csv")

    def test_in_a_stream(self):
        text = self.measurement.read_text()
        bad = text.replace("theta", "theta", 1).splitlines()
        bad[3] = "0.15,x,0"
        result = call("infer", self.run_folder, "--follow", input="\n".join(bad) + "\n\n" + text)
        self.assertEqual(result.returncode, 1)
        self.assertEqual([json.loads(line)["status"] for line in result.stdout.splitlines()], ["error", "ok"])


class Incomplete(InferCase):
    """Samples that are missing are left out; the estimate is the posterior on the simulator."""

    def write_text(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def write_rows(self, name, rows):
        path = self.folder / name
        write_csv(path, self.columns.keys(), [values[rows] for values in self.columns.values()])
        return path

    def expect(self, path, *left_out):
        inferred = self.infer_json(path)
        self.assertEqual((inferred["status"], inferred["method"]), ("ok", "posterior"))
        self.assertEqual(inferred["left_out"], list(left_out))
        for name, true in TRUE.items():
            estimate = inferred["parameters"][name]
            self.assertLess(abs(estimate["mean"] - true), 4 * estimate["sd"], name)

    def test_cells(self):
        lines = self.measurement.read_text().splitlines()
        for line, cells in ((5, ",nan,{}"), (9, ",{},")):
            t, y, theta = lines[line].split(",")
            lines[line] = t + cells.format(theta if "nan" in cells else y)
        path = self.write_text("cells.csv", "\n".join(lines) + "\n")
        self.expect(path, "1 of 100 samples of y", "1 of 100 samples of theta")

    def test_a_gap(self):
        path = self.write_rows("gap.csv", np.r_[0:40, 43 : len(self.columns["t"])])
        gap = ", the longest gap 3 at 2.05 s to 2.15 s"
        self.expect(path, f"3 of 100 samples of y{gap}", f"3 of 100 samples of theta{gap}")

    def test_half_of_the_rate(self):
        sparse = "; its samples are 0.1 s apart, too far to be interpolated"
        remarks = [f"50 of 100 samples of {name}{sparse}" for name in ("y", "theta")]
        self.expect(self.write_rows("slow.csv", np.s_[1::2]), *remarks)

    def test_an_end_that_is_too_early(self):
        gap = ", the longest gap 51 at 2.5 s to 5 s"
        path = self.write_rows("short.csv", np.s_[:49])
        self.expect(path, f"51 of 100 samples of y{gap}", f"51 of 100 samples of theta{gap}")

    def test_the_estimator_alone_needs_them_all(self):
        path = self.write_text("nan.csv", self.measurement.read_text().replace("\n0.2,", "\n0.2,nan,", 1))
        result = call("infer", self.run_folder, path, "--no-refine")
        self.assertEqual(result.returncode, 1)
        self.assertIn("nan.csv:", result.stderr)


class Trust(InferCase):
    NOISE = {"y": 5e-5, "theta": 0.015}

    def status(self, name, **columns):
        return self.infer_json(self.write(name, **columns))["statuses"]

    def test_a_spike_a_drift_and_a_stuck_sensor_are_found(self):
        y, theta = self.columns["y"], self.columns["theta"]
        spike = theta + 10 * self.NOISE["theta"] * (np.arange(len(y)) == 40)
        drift = y + np.linspace(0, 10 * self.NOISE["y"], len(y))
        stuck = np.where(np.arange(len(y)) > 60, y[60], y)
        self.assertEqual(self.status("spike.csv", theta=spike), ["outliers"])
        self.assertIn("model_mismatch", self.status("drift.csv", y=drift))
        self.assertIn("model_mismatch", self.status("stuck.csv", y=stuck))

    def test_another_machine_is_a_mismatch(self):
        other = self.simulate("other.csv", *POINT, "constants.m1.value=3.465")
        inferred = self.infer_json(other)
        self.assertEqual(inferred["status"], "model_mismatch")
        self.assertLess(inferred["trust"]["p_value"], 0.01)
        self.assertIn("no parameter values within the bounds fit", self.infer(other))


class WrongUsage(InferCase):
    def expect(self, *arguments, code, text):
        result = call("infer", *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertIn(text, result.stderr)

    def test_is_explained(self):
        self.expect(self.run_folder, code=2, text="--follow")
        self.expect(self.run_folder, self.measurement, "--follow", code=2, text="give no files")
        self.expect(self.folder / "nothing", self.measurement, code=1, text="does not exist")
        self.expect(self.run_folder, self.measurement, "--set", "k=1", code=2, text="is not an input")
        self.expect(self.run_folder, self.measurement, "--set", "k", code=2, text="NAME=NUMBER")
        self.expect(self.measurement, self.measurement, code=2, text="m.csv: is a recording")


class Roles(RunTestCase):
    """A cart with an unknown offset and a payload that is known."""

    EXPERIMENT = """
name: roles
parameters:
  k: {bounds: [80, 120], unit: N/m}
nuisance:
  offset: {bounds: [-0.01, 0.01], unit: m}
inputs:
  payload: {bounds: [0, 1], unit: kg}
system:
  bodies:
    cart: {mass: 1.2 + payload, joint: {type: slider, coordinates: [x]}}
  springs: [{coordinate: x, stiffness: k}]
  dampers: [{coordinate: x, damping: 1.5}]
  force_laws: [{coordinate: x, force: F}]
excitation:
  F: {unit: N, pulses: [{amplitude: 2, start: 0.1, end: 0.4}]}
outputs:
  x: {coordinate: x, offset: offset}
simulation: {duration: 2}
features:
  - samples: {outputs: [x], start: 0.05, interval: 0.05, count: 40}
noise: {stddev: {x: 1e-4}}
design: {train: {samples: 120}, test: {samples: 60}}
"""
    ARGUMENTS = ["evaluation.limit=false"]

    @classmethod
    def write_files(cls):
        cls.FILE = cls.folder / "roles.yaml"
        cls.FILE.write_text(cls.EXPERIMENT)

    def test_known_inputs_are_given_with_the_measurement(self):
        path = self.simulate("m.csv", "parameters.k=93", "nuisance.offset=0.004", "inputs.payload=0.7")
        result = call("infer", self.run_folder, path, "--set", "payload=0.7", "--refine", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        inferred = json.loads(result.stdout)
        self.assertEqual(inferred["status"], "ok")
        for estimate in (inferred["parameters"]["k"], inferred["refined"]["parameters"]["k"]):
            self.assertLess(abs(estimate["mean"] - 93), 4 * estimate["sd"])
            self.assertLess(estimate["sd"], 1.0)

    def test_the_wrong_payload_gives_another_stiffness_or_a_mismatch(self):
        path = self.simulate("m.csv", "parameters.k=93", "nuisance.offset=0.004", "inputs.payload=0.7")
        result = json.loads(call("infer", self.run_folder, path, "--set", "payload=0.2", "--json").stdout)
        self.assertIn("model_mismatch", result["statuses"])

    def test_a_missing_input_is_asked_for(self):
        path = self.simulate("m.csv", "inputs.payload=0.7")
        for arguments, text in [([], "--set payload=VALUE"), (["--set", "payload=3"], "bounds [0, 1]")]:
            result = call("infer", self.run_folder, path, *arguments)
            self.assertEqual(result.returncode, 2)
            self.assertIn(text, result.stderr)
