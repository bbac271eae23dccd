"""Experiments in Python: read, changed, simulated, run, interrupted."""
import _thread
import json
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import zipfile
from pathlib import Path

import numpy as np
import pandas as pd

import twinmap
from package_support import BEST, QUICK, SOURCE, TABLE_1, FolderTestCase
from support import call, read_columns  # the command's

LINEAR = """
name: oscillator
parameters: {k: {bounds: [80, 120], unit: N/m}}
system:
  bodies: {cart: {mass: 2, joint: {type: slider, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: k}]
initial: {coordinates: {x: 0.1}}
outputs: {x: {coordinate: x}}
simulation: {duration: 2}
features: [{samples: {outputs: [x], start: 0.02, interval: 0.02, count: 100}}]
noise: {stddev: {x: 1e-3}}
"""

SLOW = {"simulation.engine": "simbody"}  # some ms a sample, so that there is progress to be told


class Reading(unittest.TestCase):
    def test_tells_what_the_experiment_is_made_of(self):
        experiment = twinmap.Experiment.from_file(TABLE_1)
        self.assertEqual(experiment.name, "two_beam_table1")
        self.assertEqual([q.name for q in experiment.parameters], ["d_y", "d_theta", "k_y", "k_theta"])
        self.assertEqual((experiment.parameters[2].lower, experiment.parameters[2].upper), (5, 15))
        self.assertEqual(experiment.parameters[2].unit, "N/m")
        self.assertEqual([q.name for q in experiment.outputs], ["y", "theta"])
        self.assertEqual(len(experiment.features), 200)
        np.testing.assert_allclose(experiment.times, 0.05 * np.arange(1, 101), atol=1e-12)
        self.assertEqual(
            experiment.to_yaml(),
            "".join(line for line in call("check", TABLE_1).stdout.splitlines(True) if not line.startswith("#")),
        )
        self.assertIn("k_theta", experiment._repr_html_())

    def test_override_takes_texts_mappings_and_keywords(self):
        experiment = twinmap.Experiment.from_file(TABLE_1)
        other = experiment.override(
            "noise.scale=2", {"design.train.samples": 100, "parameters.k_y.bounds": np.array([6.0, 9.0])}, seed=7
        )
        self.assertEqual(other.seed, 7)
        self.assertEqual(other.parameters[2].upper, 9)
        self.assertIn("samples: 100", other.to_yaml())
        self.assertEqual(other.override(noise__scale=3).override("seed=8").seed, 8)
        self.assertEqual(experiment.seed, 1)

    def test_an_error_has_its_place_and_rule(self):
        with self.assertRaises(twinmap.ExperimentError) as caught:
            twinmap.Experiment.from_yaml(LINEAR.replace("stiffness: k", "stiffness: kk"), "cart.yaml")
        error = caught.exception
        self.assertEqual(
            (error.file, error.line, error.key, error.value), ("cart.yaml", 6, "system.springs[0].stiffness", "kk")
        )
        self.assertIn("unknown name", error.rule)
        self.assertTrue(str(error).startswith(f"cart.yaml:6:{error.column}: system.springs[0].stiffness: 'kk' "))
        with self.assertRaises(twinmap.ExperimentError) as caught:
            twinmap.Experiment.from_file(TABLE_1).override("seed=-1")
        self.assertEqual(
            (caught.exception.file, caught.exception.line, caught.exception.key), ("command line", None, "seed")
        )
        with self.assertRaises(ValueError):  # an ExperimentError is one
            twinmap.Experiment.from_file("missing.yaml")


class Simulating(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.experiment = twinmap.Experiment.from_yaml(LINEAR)

    def test_response_of_an_undamped_oscillator(self):
        responses = self.experiment.simulate([[80.0], [100.0]])
        for stiffness, row in zip([80, 100], responses["x"]):
            np.testing.assert_allclose(row, 0.1 * np.cos(np.sqrt(stiffness / 2) * responses.times), atol=1e-6)
        self.assertTrue(responses.ok.all())
        np.testing.assert_array_equal(self.experiment.extract(responses), responses["x"])

    def test_does_as_the_command_does(self):
        text = call("simulate", TABLE_1, "parameters.k_y=7.5", "--noise").stdout
        frame = twinmap.Experiment.from_file(TABLE_1).simulate({"k_y": 7.5}, noise=True).to_frame()
        for name, column in read_columns(text).items():
            np.testing.assert_array_equal(frame[name.split(" ")[0]], column)

    def test_points_may_come_in_many_forms(self):
        experiment = twinmap.Experiment.from_file(TABLE_1)
        points = np.array([[1.0, 2e-4, 6.0, 0.03], [1.0, 2e-4, 7.0, 0.03]])
        expected = experiment.simulate(points).rows
        frame = pd.DataFrame(points, columns=["d_y", "d_theta", "k_y", "k_theta"])
        for form in [
            points.tolist(),
            np.asfortranarray(points),
            frame,
            frame[["k_y", "k_theta", "d_theta", "d_y"]],
            {"k_y": [6, 7], "k_theta": 0.03, "d_theta": 2e-4},
        ]:
            np.testing.assert_array_equal(experiment.simulate(form).rows, expected)
        with self.assertRaisesRegex(twinmap.ExperimentError, "'k_x' is none of"):
            experiment.simulate({"k_x": 1})
        with self.assertRaisesRegex(ValueError, r"shape \(n, 4\)"):
            experiment.simulate([[1, 2, 3]])

    def test_arrays_are_views_of_one_that_is_not_copied(self):
        responses = twinmap.Experiment.from_file(TABLE_1).simulate({"k_y": [6, 7, 8]})
        self.assertFalse(responses.rows.flags.owndata)  # the memory is that of the simulator
        self.assertTrue(responses.rows.flags.c_contiguous and responses.rows.flags.writeable)
        for name in responses.outputs:
            self.assertTrue(np.shares_memory(responses[name], responses.rows))
        with self.assertRaisesRegex(KeyError, "y, theta"):
            responses["z"]

    def test_a_sample_that_fails_is_nan_and_says_why(self):
        heavy = twinmap.Experiment.from_yaml(LINEAR.replace("mass: 2", "mass: k - 90"))
        responses = heavy.simulate([[100.0], [85.0]])
        self.assertEqual(responses.ok.tolist(), [True, False])
        self.assertTrue(np.isnan(responses.rows[1]).all())
        self.assertIn("mass", responses.reasons[1])

    def test_results_do_not_depend_on_the_threads(self):
        points = np.linspace(80, 120, 50)[:, np.newaxis]
        np.testing.assert_array_equal(
            self.experiment.simulate(points, threads=1).rows, self.experiment.simulate(points, threads=3).rows
        )
        with self.assertRaisesRegex(ValueError, "threads"):
            self.experiment.simulate(points, threads=0)

    def test_other_threads_of_python_go_on_meanwhile(self):
        points = np.linspace(80, 120, 60000)[:, np.newaxis]
        counted, ended = [0], threading.Event()

        def count():
            while not ended.is_set():
                counted[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count, daemon=True)
        thread.start()
        start = time.monotonic()
        self.experiment.simulate(points, threads=1)
        elapsed, during = time.monotonic() - start, counted[0]
        ended.set()
        thread.join()
        self.assertGreater(elapsed, 0.05)
        self.assertGreater(during, 0.2 * elapsed / 0.0012)

    def test_models_that_are_fmus(self):
        """Simulated by processes of Python, which has no twinmap command."""
        source = SOURCE / "experiments/fmu"
        with tempfile.TemporaryDirectory(prefix="twinmap_test_") as folder:
            library = Path(folder) / "oscillator.so"
            subprocess.run(
                [
                    "cc",
                    "-shared",
                    "-fPIC",
                    "-O2",
                    f"-I{SOURCE}/framework/models/fmu/headers",
                    source / "oscillator.c",
                    "-o",
                    library,
                    "-lm",
                ],
                check=True,
            )
            with zipfile.ZipFile(Path(folder) / "oscillator.fmu", "w") as archive:
                archive.write(source / "modelDescription.xml", "modelDescription.xml")
                archive.write(library, "binaries/linux64/oscillator.so")
            file = shutil.copy(source / "oscillator.yaml", folder)
            responses = twinmap.Experiment.from_file(file).simulate({}, threads=2)
            expected = read_columns(call("simulate", file).stdout)
        name = responses.outputs[0]
        np.testing.assert_array_equal(
            responses[name][0], next(v for k, v in expected.items() if k.split(" ")[0] == name)
        )

    def test_models_that_are_programs(self):
        plant = twinmap.Experiment.from_file(SOURCE / "experiments/python_plant/python_plant.yaml")
        twin = twinmap.Experiment.from_file(TABLE_1)
        point = {"k_y": 8.0, "k_theta": 0.03}
        np.testing.assert_allclose(plant.simulate(point)["y"], twin.simulate(point)["y"], atol=1e-6)


class Running(FolderTestCase):
    def test_leaves_what_the_command_leaves(self):
        experiment = twinmap.Experiment.from_file(BEST).override(QUICK)
        results = experiment.run(self.folder / "python")
        call(
            "run",
            BEST,
            *(f"{key}={json.dumps(value)}" for key, value in QUICK.items()),
            "--out",
            self.folder / "command",
        )
        names = {file.name for file in (self.folder / "command").glob("*")}
        self.assertEqual(names, {file.name for file in results.folder.glob("*")})
        for name in names - {"provenance.json", "run.log", "report.html", "lock", "figures", "chunks"}:
            self.assertEqual((results.folder / name).read_bytes(), (self.folder / "command" / name).read_bytes(), name)
        self.assertIn("twinmap run", results.provenance["command"])

    def test_tells_its_progress(self):
        calls = []
        experiment = twinmap.Experiment.from_file(TABLE_1).override(QUICK, SLOW)
        experiment.run(
            self.folder / "run",
            progress=lambda progress: calls.append(
                (progress.stage, progress.done, progress.total, threading.current_thread() is threading.main_thread())
            ),
        )
        self.assertTrue(calls)
        self.assertTrue(all(0 <= done <= total and main for _, done, total, main in calls), calls)

    def test_an_error_in_the_progress_function_ends_the_run(self):
        def fail(progress):
            raise LookupError(progress.stage)

        experiment = twinmap.Experiment.from_file(TABLE_1).override(QUICK, SLOW)
        with self.assertRaises(LookupError):
            experiment.run(self.folder / "run", progress=fail)
        with self.assertRaisesRegex(TypeError, "progress"):
            experiment.run(self.folder / "run", progress="loud")

    def test_a_folder_of_another_experiment_is_refused(self):
        experiment = twinmap.Experiment.from_file(TABLE_1).override(QUICK)
        experiment.run(self.folder / "run")
        with self.assertRaisesRegex(twinmap.ExperimentError, "another experiment(.|\n)*seed"):
            experiment.override("seed=2").run(self.folder / "run")

    def test_a_run_that_fails_says_why(self):
        with self.assertRaisesRegex(RuntimeError, "failed"):
            twinmap.Experiment.from_file(TABLE_1).override(QUICK, {"simulation.max_steps": 3}).run(self.folder / "run")

    def test_runs_of_several_threads_take_turns(self):
        results, threads = [], []
        for seed in range(1, 5):
            experiment = twinmap.Experiment.from_file(TABLE_1).override(QUICK, seed=seed)
            threads.append(
                threading.Thread(target=lambda e=experiment, s=seed: results.append(e.run(self.folder / f"run{s}")))
            )
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(results), 4)
        self.assertEqual(len({float(r.metrics.sd_pct[0]) for r in results}), 4)
        for result in results:  # no line of another run in the log
            self.assertEqual((result.folder / "run.log").read_text().count("solver: "), 1)

    def test_sweep_gives_a_frame(self):
        frame = twinmap.sweep(TABLE_1, QUICK, "design.train.samples=40,60", out=self.folder / "sweep")
        self.assertEqual(len(frame), 8)
        self.assertEqual(sorted(set(frame["design.train.samples"])), [40, 60])
        self.assertIn("sd_pct", frame)
        with self.assertRaisesRegex(twinmap.ExperimentError, "sweep"):
            twinmap.Experiment.from_file(TABLE_1).override("seed=1,2").run(self.folder / "run")
        with self.assertRaisesRegex(twinmap.ExperimentError, "sweeps nothing"):
            twinmap.sweep(TABLE_1, out=self.folder / "none")


class Interrupting(FolderTestCase):
    CODE = """
import sys, twinmap
experiment = twinmap.Experiment.from_file(sys.argv[1])
print("begins", flush=True)
try:
    experiment.run(sys.argv[2])
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""

    def interrupt_after(self, delay, file):
        """Seconds until KeyboardInterrupt."""
        process = subprocess.Popen(
            [sys.executable, "-c", self.CODE, file, self.folder / f"{file.stem}{delay}"],
            stdout=subprocess.PIPE,
            text=True,
        )
        self.addCleanup(process.stdout.close)
        self.assertEqual(process.stdout.readline(), "begins\n")
        time.sleep(delay)
        start = time.monotonic()
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.stdout.readline(), "interrupted\n", delay)
        elapsed = time.monotonic() - start
        self.assertEqual(process.wait(), 0)
        return elapsed

    def test_ctrl_c_ends_a_run_within_a_second(self):
        for file, delays in [(BEST, [0.02, 0.3, 1.0]), (TABLE_1, [0.05, 0.2])]:
            for delay in delays:
                self.assertLess(self.interrupt_after(delay, file), 1.0, (file, delay))

    def test_an_interrupted_run_continues(self):
        experiment = twinmap.Experiment.from_file(BEST).override(QUICK)
        threading.Timer(0.3, _thread.interrupt_main).start()
        end = time.monotonic() + 60
        with self.assertRaises(KeyboardInterrupt):
            while time.monotonic() < end:  # the run may be over before the interrupt comes
                experiment.run(self.folder / "run")
        self.assertEqual(len(experiment.run(self.folder / "run").metrics), 4)
