"""The updated model next to a measurement: twinmap replay."""
import csv
import filecmp
import json
import re
import unittest

import h5py
import numpy as np
import yaml

from support import RunTestCase, call, read_csv, write_csv

TRUE = {"d_y": 0.95, "d_theta": 2.1e-4, "k_y": 8.5, "k_theta": 0.034}
POINT = [f"parameters.{name}={value}" for name, value in TRUE.items()]
FILES = ["replay.csv", "residuals.csv", "fit.csv", "inference.json", "report.html"]


def read_numbers(path):
    """Columns by name, without units; cells that are no number are left as they are."""
    with open(path, newline="") as file:
        header, *rows = list(csv.reader(file))
    names = [name.split(" [")[0] for name in header]
    columns = dict(zip(names, zip(*rows)))
    return {
        name: np.array(cells if name == "output" else [float(cell) for cell in cells])
        for name, cells in columns.items()
    }


class ReplayCase(RunTestCase):
    def replay(self, name, *arguments):
        """The folder of results."""
        folder = self.folder / "replays" / name
        result = call("replay", self.run_folder, *arguments, "--out", folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.stdout, self.stderr = result.stdout, result.stderr
        return folder

    def read_fit(self, folder):
        return {
            row["output"]: {name: float(cell) for name, cell in row.items() if name != "output"}
            for row in read_csv(folder / "fit.csv")
        }

    def read_replay(self, folder):
        """Columns of each output."""
        table = read_numbers(folder / "replay.csv")
        return {
            output: {name: column[table["output"] == output] for name, column in table.items()}
            for output in dict.fromkeys(table["output"])
        }


class Replay(ReplayCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.measurement = cls.simulate("m.csv", *POINT)

    def simulate_clean(self, parameters):
        path = self.folder / "clean.csv"
        result = call("simulate", self.FILE, "--csv", path, *(f"parameters.{n}={v!r}" for n, v in parameters.items()))
        self.assertEqual(result.returncode, 0, result.stderr)
        return read_numbers(path)

    def expect_model(self, folder, column, parameters):
        clean = self.simulate_clean(parameters)
        for output, replayed in self.read_replay(folder).items():
            np.testing.assert_allclose(replayed[column], clean[output], rtol=1e-9, atol=1e-12)

    def test_the_updated_model_leaves_noise_alone(self):
        fit = self.read_fit(self.replay("fit", self.measurement))
        self.assertEqual(list(fit), ["y", "theta"])
        for output in fit.values():
            self.assertAlmostEqual(output["rms_residual_sd"], 1, delta=0.25)  # +-3 of its sd, 100 residuals
            self.assertLess(output["largest_residual_sd"], 5)
            self.assertGreater(output["nominal_nrmse_pct"], 2 * output["nrmse_pct"])
        self.assertLess(fit["y"]["nrmse_pct"], 1)

    def test_prints_the_status_and_the_fit(self):
        folder = self.replay("print", self.measurement)
        self.assertTrue(self.stdout.startswith(f"{self.measurement}: ok (chi-square "), self.stdout)
        self.assertRegex(self.stdout, r"\| y +\|")
        self.assertIn(f"Report: {folder}/report.html", self.stderr)

    def test_files_agree(self):
        folder = self.replay("files", self.measurement)
        self.assertEqual(sorted(path.name for path in folder.iterdir()), sorted(FILES))
        measured, residuals = read_numbers(self.measurement), read_numbers(folder / "residuals.csv")
        fit = self.read_fit(folder)
        for output, columns in self.read_replay(folder).items():
            np.testing.assert_array_equal(columns["time"], residuals["t"])
            np.testing.assert_array_equal(columns["measured"], measured[output])
            np.testing.assert_array_equal(columns["measured"] - columns["updated"], residuals[output])
            for model, prefix in (("updated", ""), ("nominal", "nominal_")):
                residual = columns["measured"] - columns[model]
                nrmse = 100 * np.sqrt(np.mean(residual**2)) / columns["measured"].std()
                in_sd = residual / columns["noise_stddev"]
                self.assertAlmostEqual(fit[output][prefix + "nrmse_pct"] / nrmse, 1, 9)
                self.assertAlmostEqual(fit[output][prefix + "rms_residual_sd"] / np.sqrt(np.mean(in_sd**2)), 1, 9)
                self.assertAlmostEqual(fit[output][prefix + "largest_residual_sd"] / np.abs(in_sd).max(), 1, 9)
        inferred = call("infer", self.run_folder, self.measurement, "--json").stdout
        self.assertEqual((folder / "inference.json").read_text(), inferred)

    def test_models_are_those_of_simulate(self):
        folder = self.replay("models", self.measurement)
        inferred = json.loads((folder / "inference.json").read_text())["parameters"]
        self.expect_model(folder, "updated", {name: estimate["mean"] for name, estimate in inferred.items()})
        self.expect_model(folder, "nominal", {})

    def test_the_band_is_the_uncertainty_of_the_parameters(self):
        """Against the linear propagation of the covariance D R D."""
        folder = self.replay("band", self.measurement, "--draws", 400)
        inferred = json.loads((folder / "inference.json").read_text())["parameters"]
        mean = {name: estimate["mean"] for name, estimate in inferred.items()}
        stddev = np.array([estimate["sd"] for estimate in inferred.values()])
        with h5py.File(self.run_folder / "maps.h5") as file:
            covariance = file["map/residual_correlation"][:] * np.outer(stddev, stddev)
        moved = [
            [self.simulate_clean({**mean, name: mean[name] + sign * inferred[name]["sd"]}) for sign in (1, -1)]
            for name in mean
        ]
        for output, columns in self.read_replay(folder).items():
            slopes = np.array([(up[output] - down[output]) / (2 * sd) for (up, down), sd in zip(moved, stddev)])
            expected = np.sqrt(np.einsum("pt,pq,qt->t", slopes, covariance, slopes))
            half_width = (columns["upper"] - columns["lower"]) / (2 * 1.959964)
            late = columns["time"] > 0.5  # before the pulse ends hardly anything depends on the parameters
            self.assertAlmostEqual(np.median(half_width[late] / expected[late]), 1, delta=0.15)
            inside = (columns["lower"] <= columns["updated"]) & (columns["updated"] <= columns["upper"])
            self.assertGreater(inside[late].mean(), 0.99)

    def test_infers_from_another_measurement(self):
        other = self.simulate("other.csv", *POINT, "seed=7")
        folder = self.replay("from", self.measurement, "--from", other)
        inferred = call("infer", self.run_folder, other, "--json").stdout
        self.assertEqual((folder / "inference.json").read_text(), inferred)
        self.assertTrue(self.stdout.startswith(f"{other}: "), self.stdout)
        for output, columns in self.read_replay(folder).items():
            np.testing.assert_array_equal(columns["measured"], read_numbers(self.measurement)[output])
        for output in self.read_fit(folder).values():
            self.assertLess(output["rms_residual_sd"], 2)

    def test_infers_from_another_window_of_the_file(self):
        first, second = read_numbers(self.measurement), read_numbers(self.simulate("later.csv", "parameters.k_y=12"))
        path = self.folder / "two.csv"
        write_csv(path, first.keys(), [np.concatenate([first[n], second[n] + (10 if n == "t" else 0)]) for n in first])
        fit = self.read_fit(self.replay("second", path, "--start", 10))
        self.assertAlmostEqual(fit["y"]["rms_residual_sd"], 1, delta=0.25)
        fit = self.read_fit(self.replay("crossed", path, "--start", 10, "--from-start", 0))
        self.assertGreater(fit["y"]["rms_residual_sd"], 100)  # another spring
        inferred = json.loads((self.folder / "replays/crossed/inference.json").read_text())
        self.assertEqual(inferred["start"], 0)

    def test_replays_what_was_refined(self):
        folder = self.replay("refined", self.measurement, "--refine")
        refined = json.loads((folder / "inference.json").read_text())["refined"]
        self.assertTrue(refined["converged"])
        self.expect_model(folder, "updated", {name: p["mean"] for name, p in refined["parameters"].items()})

    def test_results_do_not_depend_on_threads(self):
        folders = [
            self.replay(f"t{threads}", self.measurement, "--threads", threads, "--refine") for threads in (1, 2, 5)
        ]
        for folder in folders[1:]:
            self.assertEqual(filecmp.cmpfiles(folders[0], folder, FILES, shallow=False)[1:], ([], []))

    def test_the_page_holds_its_data_and_needs_nothing_else(self):
        folder = self.replay("page", self.measurement)
        page = (folder / "report.html").read_text()
        data = json.loads(re.search(r'id="page-data">(.*?)</script>', page, re.DOTALL).group(1))
        figures = {figure["name"]: figure for figure in data["figures"]}
        self.assertEqual(list(figures), ["replay-0", "spectrum-0", "replay-1", "spectrum-1", "intervals"])
        for name, columns in zip(("replay-0", "replay-1"), self.read_replay(folder).values()):
            figure = figures[name]
            self.assertEqual(len(figure["panels"]), 2)
            table = data["tables"][figure["table"]]
            for name in ("measured", "nominal", "updated", "lower", "upper"):
                np.testing.assert_allclose(table[name], columns[name], rtol=1e-6)
        self.assertIn(f"{self.measurement}: ok (chi-square ", page)
        self.assertLess(page.index('<figure id="mechanism"><svg'), page.index("<section"))
        self.assertIn(f"twinmap view {self.run_folder} {self.measurement}", page)
        for name in TRUE:
            self.assertIn(f">{name}</td>", page)
        markup = re.sub(r"<script.*?</script>", "", page, flags=re.DOTALL)
        self.assertEqual(re.findall(r'<(?:script|link|img)[^>]*(?:src|href)="(?!data:)', markup), [])

    def test_default_folder_is_in_the_run(self):
        result = call("replay", self.run_folder / "maps.h5", self.measurement, "--draws", 2)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue((self.run_folder / "replay/m/report.html").exists())

    def test_measurements_that_cannot_be_used_are_1(self):
        columns = read_numbers(self.measurement)
        short, lame = self.folder / "short.csv", self.folder / "lame.csv"
        write_csv(short, columns.keys(), [column[:50] for column in columns.values()])
        write_csv(lame, ["t", "y"], [columns["t"], columns["y"]])
        for arguments, message in (
            ([short], "short.csv"),
            ([lame], "has no column 'theta'"),
            (["/no/such.csv"], "does not exist"),
            ([self.measurement, "--from", lame], "has no column 'theta'"),
        ):
            out = self.folder / "none"
            result = call("replay", self.run_folder, *arguments, "--out", out)
            self.assertEqual(result.returncode, 1, result)
            self.assertIn(message, result.stderr)
            self.assertFalse(out.exists())

    def test_wrong_usage_is_2(self):
        for arguments in (["--set", "load=1"], ["--draws", 1], ["--threads", 0], ["--start", "now"]):
            result = call("replay", self.run_folder, self.measurement, *arguments, "--out", self.folder / "none")
            self.assertEqual(result.returncode, 2, result)


CART = {
    "name": "cart",
    "parameters": {"k": {"bounds": [80, 120], "unit": "N/m"}, "d": {"bounds": [1, 3], "unit": "N s/m"}},
    "nuisance": {"x_0": {"bounds": [-0.02, 0.02], "unit": "m"}, "bias": {"bounds": [-0.01, 0.01], "unit": "m"}},
    "inputs": {"load": {"bounds": [0, 1], "unit": "kg"}},
    "system": {
        "bodies": {"cart": {"mass": "1 + load", "joint": {"type": "slider", "coordinates": ["x"]}}},
        "springs": [{"coordinate": "x", "stiffness": "k"}],
        "dampers": [{"coordinate": "x", "damping": "d"}],
        "force_laws": [{"coordinate": "x", "force": "F"}],
    },
    "excitation": {"F": {"unit": "N", "tables": [{"measured": {"file": "input.csv", "column": "F", "time": "t"}}]}},
    "initial": {"coordinates": {"x": "x_0"}},
    "outputs": {"x": {"coordinate": "x", "offset": "bias"}},
    "simulation": {"duration": 2},
    "features": [{"samples": {"outputs": ["x"], "start": 0, "interval": 0.02, "count": 101}}],
    "noise": {"stddev": {"x": 2e-4}},
    "design": {"train": {"samples": 100}, "test": {"samples": 40}},
    "evaluation": {"limit": False},
}


class MeasuredExcitation(ReplayCase):
    """A cart with an unknown initial state and offset, a known load, and a measured force."""

    ARGUMENTS = []

    @classmethod
    def write_files(cls):
        cls.FILE = cls.folder / "cart.yaml"
        cls.FILE.write_text(yaml.safe_dump(CART, sort_keys=False))
        cls.write_input("input.csv", 1)
        cls.write_input("other.csv", 2)

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.usual = cls.measure("usual.csv", "input.csv", "nuisance.x_0=0.01", "nuisance.bias=0.004")
        cls.unusual = cls.measure("unusual.csv", "other.csv", "nuisance.x_0=-0.012", "nuisance.bias=-0.006", "seed=5")

    @classmethod
    def write_input(cls, name, seed):
        times = np.round(np.arange(0, 2.0001, 0.02), 6)
        random = np.random.default_rng(seed)
        phases = random.uniform(0, 2 * np.pi, 8)
        force = sum(np.sin(2 * np.pi * (0.5 + 0.5 * i) * times + phase) for i, phase in enumerate(phases))
        write_csv(cls.folder / name, ["t", "F"], [times, force])

    @classmethod
    def measure(cls, name, force, *arguments):
        path = cls.simulate(
            name,
            "parameters.k=92",
            "parameters.d=1.6",
            "inputs.load=0.4",
            f"excitation.F.tables[0].measured.file={cls.folder / force}",
            *arguments,
        )
        measured, inputs = read_numbers(path), read_numbers(cls.folder / force)
        write_csv(path, ["t", "x", "F"], [measured["t"], measured["x"], inputs["F"]])
        return path

    def test_initial_state_and_offset_are_those_of_the_measurement(self):
        fit = self.read_fit(self.replay("usual", self.usual, "--set", "load=0.4", "--refine"))["x"]
        self.assertAlmostEqual(fit["rms_residual_sd"], 1, delta=0.25)
        self.assertGreater(fit["nominal_rms_residual_sd"], 3)

    def test_another_window_is_simulated_with_its_own_input_and_nuisance(self):
        folder = self.replay("unusual", self.unusual, "--from", self.usual, "--set", "load=0.4", "--refine")
        fit = self.read_fit(folder)["x"]
        self.assertLess(fit["rms_residual_sd"], 2)
        # An offset that was not fitted would be 30 to 50 sd of noise.
        columns = self.read_replay(folder)["x"]
        self.assertLess(abs(np.mean(columns["measured"] - columns["nominal"])) / 2e-4, 10)

    def test_a_map_infers_from_the_excitation_that_it_knows(self):
        self.assertEqual(call("infer", self.run_folder, self.usual, "--set", "load=0.4").returncode, 0)
        for arguments in [
            ("infer", self.run_folder, self.unusual),
            ("replay", self.run_folder, self.unusual, "--out", self.folder / "none"),
        ]:
            result = call(*arguments, "--set", "load=0.4")
            self.assertEqual(result.returncode, 1, result)
            self.assertIn(
                "unusual.csv: column 'F' is not the excitation 'F' that the map was trained on", result.stderr
            )
            self.assertIn("--start", result.stderr)

    def test_without_its_excitation_a_measurement_is_inferred_from(self):
        columns = read_numbers(self.unusual)
        path = self.folder / "untold.csv"
        write_csv(path, ["t", "x"], [columns["t"], columns["x"]])
        inferred = json.loads(call("infer", self.run_folder, path, "--set", "load=0.4", "--json").stdout)
        self.assertIn("model_mismatch", inferred["statuses"])

    def test_the_known_load_matters_and_is_required(self):
        fit = self.read_fit(self.replay("load", self.usual, "--set", "load=0.9"))["x"]
        self.assertGreater(fit["rms_residual_sd"], 3)
        result = call("replay", self.run_folder, self.usual, "--out", self.folder / "none")
        self.assertEqual(result.returncode, 2, result)
        self.assertIn("--set load=VALUE", result.stderr)

    def test_the_input_is_in_the_file_or_in_its_own(self):
        columns = read_numbers(self.usual)
        path = self.folder / "no_input.csv"
        write_csv(path, ["t", "x"], [columns["t"], columns["x"]])
        fit = self.read_fit(self.replay("own", path, "--set", "load=0.4", "--refine"))["x"]
        self.assertAlmostEqual(fit["rms_residual_sd"], 1, delta=0.25)
        own, aside = self.folder / "input.csv", self.folder / "aside.csv"
        own.rename(aside)
        self.addCleanup(aside.rename, own)
        result = call("replay", self.run_folder, path, "--set", "load=0.4", "--out", self.folder / "none")
        self.assertEqual(result.returncode, 1, result)
        self.assertIn("input.csv: does not exist", result.stderr)
