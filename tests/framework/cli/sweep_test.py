"""Sweeps from outside: what is simulated, what is left behind, and what an interruption or a failure changes."""
import collections
import filecmp
import os
import pty
import random
import re
import shlex
import shutil
import signal
import statistics
import struct
import subprocess
import time
import unittest

from case_turns import SEED, take_turn
from support import EXPERIMENTS, TWINMAP, OwnFolderTestCase, call, read_csv, run_once, wait_until

CART = EXPERIMENTS / "duffing/cart.yaml"
CHAIN = EXPERIMENTS / "three_mass_chain/modes.yaml"
QUICK = ["evaluation.limit=false", "design.train.method=nested_latin_hypercube"]
SMALL = [*QUICK, "design.test.samples=8", "inverse_map.gp.starts=1"]
DIFFERENCES = "simulation.engine=simbody"  # no derivatives of its own: stencils are simulated and kept
LIMITS = [*SMALL, "evaluation.limit=true", DIFFERENCES]
KILLED = [*LIMITS, "design.train.samples=8,16", "noise.scale=0.5,1", "seed=1..2", "design.test.samples=60"]
FULL = [*LIMITS, "design.train.samples=8,16", "noise.scale=0.5,1"]
SWEEP = [*SMALL, "design.train.samples=8,16", "noise.scale=0.5,1", "seed=1..2"]
TABLES = ["sweep.csv", "summary.csv", "table.md", "failed_cases.csv", "resolved.yaml"]
RESULTS = [
    "failures.csv",
    "joint.csv",
    "maps.h5",
    "metrics.csv",
    "pit.csv",
    "predictions.csv",
    "resolved.yaml",
    "samples.h5",
    "table.md",
    "table.tex",
    "training.csv",
]


def read_points(chunk):
    """The parameter points of a chunk file, by docs/reference/files.md."""
    data = chunk.read_bytes()
    parameters, _, samples = struct.unpack("<3Q", data[32:56])
    size = 8 * parameters
    return [data[56 + i * size : 56 + (i + 1) * size] for i in range(samples)]


class SweepTestCase(OwnFolderTestCase):
    def run_sweep(self, name, *arguments, file=CART, sweep=SWEEP, code=0):
        result = call("run", file, *sweep, *arguments, "--out", self.folder / name)
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    def copy_sweep(self, name):
        """The complete SWEEP, which all tests share, as if it had been run here."""
        shutil.copytree(run_once(CART, *SWEEP)[0], self.folder / name)

    def start(self, name, *arguments, sweep=SWEEP):
        return subprocess.Popen(
            [TWINMAP, "run", CART, *sweep, *arguments, "--out", str(self.folder / name)],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )

    def list_cases(self, name):
        return sorted(path.name for path in (self.folder / name / "cases").iterdir())

    def get_stored(self, name, stencils=False):
        """The points that were simulated, or those whose stencils were; none twice."""
        points = []
        for content in (self.folder / name).glob("chunks/*/content.yaml"):
            if ("\nstencils:" in content.read_text()) == stencils:
                points += [point for chunk in content.parent.glob("*.chunk") for point in read_points(chunk)]
        self.assertEqual(len(points), len(set(points)), "a point was simulated twice")
        return set(points)

    def get_all_stored(self, name):
        return self.get_stored(name), self.get_stored(name, stencils=True)

    def assert_same_files(self, a, b, files):
        _, different, missing = filecmp.cmpfiles(self.folder / a, self.folder / b, files, shallow=False)
        self.assertEqual((different, missing), ([], []))

    def assert_same_sweeps(self, a, b):
        self.assert_same_files(a, b, TABLES)
        self.assertEqual(self.list_cases(a), self.list_cases(b))
        for case in self.list_cases(a):
            self.assert_same_files(f"{a}/cases/{case}", f"{b}/cases/{case}", RESULTS)


class Simulations(SweepTestCase):
    def test_sizes_noise_levels_and_seeds_need_the_largest_design_and_the_test_set_of_each_seed(self):
        tiny_maps = [
            "inverse_map.gp={approximation: sgpr, inducing: 5, subset: 10, refine_evaluations: 0, starts: 1}",
            "noise.replicates=1",
        ]
        self.run_sweep(
            "run",
            file=CHAIN,
            sweep=[
                *QUICK,
                *tiny_maps,
                "design.test.samples=50",
                "design.train.samples=10,20,50,100,200",
                "noise.scale=0.25,0.5,1,2",
                "seed=1..5",
            ],
        )
        self.assertEqual(len(self.list_cases("run")), 5 * 4 * 5)
        self.assertEqual(len(self.get_stored("run")), (200 + 50) * 5)
        self.assertIn("1250 of 1250 stored", call("status", self.folder / "run").stdout)

    def test_a_case_is_bit_for_bit_the_run_of_it_alone(self):
        """Also where cases differ in what they see of the response: they share the simulations."""
        features = [
            "features[0].samples.interval=0.05,0.07",
            "features[0].samples.count=60",
            *SMALL,
            "transform=[z_score],[whiten, principal_components]",
            "design.train.samples=12",
        ]
        self.run_sweep("run", sweep=features)
        self.assertEqual(len(self.get_stored("run")), 12 + 8)
        for interval in ("0.05", "0.07"):
            for i, transform in enumerate(("[z_score]", "[whiten, principal_components]")):
                alone = [
                    *SMALL,
                    "features[0].samples.count=60",
                    f"features[0].samples.interval={interval}",
                    f"transform={transform}",
                    "design.train.samples=12",
                ]
                self.run_sweep(f"alone{interval}{i}", sweep=alone)
                self.assert_same_files(
                    f"run/cases/interval-{interval}_transform-{i + 1}", f"alone{interval}{i}", RESULTS
                )

    def test_cases_share_the_stencils_of_their_test_points(self):
        sweep = [
            *LIMITS,
            "noise.scale=0,0.5,1",
            "features[0].samples.interval=0.05,0.07",
            "features[0].samples.count=60",
            "transform=[z_score]",
            "design.train.samples=12,16",
        ]
        self.run_sweep("run", sweep=sweep)
        self.assertEqual(list(map(len, self.get_all_stored("run"))), [16 + 8, 8])
        self.assertIn("differences at test points: 8 of 8 stored", call("status", self.folder / "run").stdout)
        self.run_sweep(
            "alone",
            sweep=[
                *LIMITS,
                "noise.scale=0.5",
                "features[0].samples.interval=0.07",
                "features[0].samples.count=60",
                "transform=[z_score]",
                "design.train.samples=12",
            ],
        )
        self.assert_same_files(
            "run/cases/scale-0.5_interval-0.07_samples-12", "alone", [*RESULTS, "identifiability.csv"]
        )
        self.run_sweep("noiseless", sweep=[*LIMITS, "noise.scale=0", "transform=[z_score]", "design.train.samples=12"])
        self.assertEqual(self.get_stored("noiseless", stencils=True), set())

    def test_a_selection_by_fisher_information_shares_stencils_of_training_points(self):
        select = "transform=[{select: {fisher_information: {count: 6}}}, z_score]"
        self.run_sweep("run", sweep=[*SMALL, select, "design.train.samples=20,30", "noise.scale=0.5,1", DIFFERENCES])
        self.assertEqual(len(self.get_stored("run", stencils=True)), 16)

    def test_other_bounds_have_other_stencils(self):
        self.run_sweep("run", sweep=[*LIMITS, "parameters.k.bounds=[80, 120],[90, 110]", "design.train.samples=12"])
        self.assertEqual(len(self.get_stored("run", stencils=True)), 2 * 8)

    def test_exact_derivatives_need_no_stencils(self):
        sweep = [
            *LIMITS,
            "simulation.engine=lanes",
            "noise.scale=0.5,1",
            "design.train.samples=12",
            "features[0].samples.interval=0.05,0.07",
            "features[0].samples.count=60",
        ]
        self.assertNotIn("limits", call("plan", CART, *sweep, "--out", self.folder / "run").stdout)
        self.run_sweep("run", sweep=sweep)
        self.assertEqual(list(map(len, self.get_all_stored("run"))), [12 + 8, 0])
        self.assertEqual(len(list(self.folder.glob("run/chunks/*"))), 1)
        self.assertNotIn("stencils", (self.folder / "run/run.log").read_text())
        self.assertNotIn("limits", call("status", self.folder / "run").stdout)
        self.run_sweep(
            "alone",
            sweep=[
                *LIMITS,
                "simulation.engine=lanes",
                "noise.scale=0.5",
                "design.train.samples=12",
                "features[0].samples.interval=0.07",
                "features[0].samples.count=60",
            ],
        )
        self.assert_same_files("run/cases/scale-0.5_interval-0.07", "alone", [*RESULTS, "identifiability.csv"])

    def test_results_are_bitwise_the_same_for_any_number_of_threads_and_any_memory(self):
        self.run_sweep("1", "--threads", 1)
        for threads in (2, 3, 5):
            self.run_sweep(str(threads), "--threads", threads)
            self.assert_same_sweeps("1", str(threads))
        self.run_sweep("alone", "--threads", 2, "--memory", 1e-6)
        self.assert_same_sweeps("1", "alone")


class Tables(SweepTestCase):
    def test_hold_every_case_and_the_means_over_the_seeds(self):
        result = self.run_sweep("run", "seed=1..3")
        self.assertEqual(result.stdout, (self.folder / "run/table.md").read_text())
        rows = read_csv(self.folder / "run/sweep.csv")
        self.assertEqual(len(rows), 2 * 2 * 3 * 3)
        self.assertEqual(
            list(rows[0])[:6], ["case", "design.train.samples", "noise.scale", "seed", "parameter", "unit"]
        )
        for row in rows:
            metrics = [
                m
                for m in read_csv(self.folder / "run/cases" / row["case"] / "metrics.csv")
                if m["parameter"] == row["parameter"]
            ]
            self.assertEqual({key: row[key] for key in metrics[0]}, metrics[0])
        summary = read_csv(self.folder / "run/summary.csv")
        self.assertEqual(len(summary), 2 * 2 * 3)
        for row in summary:
            values = [
                float(r["sd_pct"])
                for r in rows
                if all(r[key] == row[key] for key in ("design.train.samples", "noise.scale", "parameter"))
            ]
            self.assertEqual(row["cases"], "3")
            self.assertAlmostEqual(float(row["sd_pct"]), statistics.mean(values), 9)
            self.assertAlmostEqual(float(row["sd_pct_se"]), statistics.stdev(values) / 3**0.5, 9)

    def test_the_resolved_sweep_repeats_it(self):
        self.copy_sweep("a")
        self.run_sweep("b", file=self.folder / "a/resolved.yaml", sweep=[])
        self.assert_same_sweeps("a", "b")

    def test_zip_takes_the_values_together(self):
        self.run_sweep("run", "sweep.combine=zip")
        self.assertEqual(self.list_cases("run"), ["samples-16_scale-1_seed-2", "samples-8_scale-0.5_seed-1"])


class Continuing(SweepTestCase):
    def test_a_complete_sweep_is_left_alone(self):
        self.copy_sweep("run")
        before = {path: path.stat().st_mtime_ns for path in (self.folder / "run/cases").rglob("*")}
        self.assertIn("8 of 8 complete (8 before)", self.run_sweep("run").stderr)
        self.assertEqual(before, {path: path.stat().st_mtime_ns for path in (self.folder / "run/cases").rglob("*")})

    def test_only_what_is_missing_is_done(self):
        self.copy_sweep("run")
        self.copy_sweep("undisturbed")
        (self.folder / "run/cases/samples-8_scale-1_seed-2/provenance.json").unlink()
        (self.folder / "run/cases/samples-8_scale-1_seed-2/metrics.csv").write_text("torn")
        self.assertIn("7 of 8 complete", call("status", self.folder / "run").stdout)
        self.assertIn("8 of 8 complete (7 before)", self.run_sweep("run").stderr)
        self.assert_same_sweeps("run", "undisturbed")

    def test_another_experiment_is_refused_with_the_keys_that_differ(self):
        self.copy_sweep("run")
        result = self.run_sweep("run", "noise.scale=0.5,2", "simulation.duration=6", code=2)
        self.assertIn("simulation.duration: 5 there, 6 now", result.stderr)
        self.assertIn("sweep.over.noise.scale[1]: 1 there, 2 now", result.stderr)
        self.run_sweep("run", "description=only words")
        one = [*SMALL, "design.train.samples=8"]
        self.run_sweep("one", sweep=one)
        self.assertIn("noise.scale: 1 there, 2 now", self.run_sweep("one", "noise.scale=2", sweep=one, code=2).stderr)
        self.run_sweep("one", sweep=one)

    def test_killed_at_random_moments_it_simulates_nothing_twice_and_changes_no_bit(self):
        start = time.monotonic()
        self.run_sweep("undisturbed", sweep=KILLED)
        duration = time.monotonic() - start
        rng = random.Random(SEED)
        kills = take_turn(range(int(os.environ.get("TWINMAP_SWEEP_KILLS", "10"))))
        stages = collections.Counter()
        for i in kills:
            stored = self.get_all_stored("run")
            child = self.start("run", "--threads", rng.choice("123"), sweep=KILLED)
            if i % 5 == 1:
                self.wait_for_stencils("run", child)
            time.sleep(rng.uniform(0.0, 0.1 if i % 2 == 1 else 0.6 * duration))
            survived = child.poll() is not None
            child.kill()
            child.communicate()
            for before, now in zip(stored, self.get_all_stored("run")):
                self.assertLessEqual(before, now)
            stages["survived" if survived else self.find_stage("run")] += 1
        print("killed while at:", dict(stages))
        self.assertLess(stages["survived"], len(kills))
        self.run_sweep("run", sweep=KILLED)
        self.assertEqual(self.get_all_stored("run"), self.get_all_stored("undisturbed"))
        self.assert_same_sweeps("run", "undisturbed")

    def wait_for_stencils(self, name, child):
        while child.poll() is None and not any(
            "\nstencils:" in content.read_text() for content in (self.folder / name).glob("chunks/*/content.yaml")
        ):
            time.sleep(0.002)

    def find_stage(self, name):
        """Of a sweep KILLED that was killed, by what it left."""
        samples, stencils = self.get_all_stored(name)
        complete = len(list(self.folder.glob(f"{name}/cases/*/report.html")))
        return (
            "samples"
            if len(samples) < 2 * (16 + 60)
            else "stencils"
            if len(stencils) < 2 * 60
            else "cases"
            if complete < 8
            else "tables"
        )

    def test_a_full_disk_is_named_and_with_more_room_the_sweep_continues(self):
        probe = subprocess.run(["unshare", "-rm", "mount", "-t", "tmpfs", "none", self.folder], capture_output=True)
        if probe.returncode != 0:
            self.skipTest("no file system of its own: " + probe.stderr.decode())
        self.run_sweep("undisturbed", sweep=FULL)
        size = sum(file.stat().st_size for file in (self.folder / "undisturbed").rglob("*") if file.is_file())
        for part in (0.01, 0.04, 0.08, 0.3, 0.6, 0.95):  # samples, stencils, cases, ...
            with self.subTest(part=part):
                self.fill_disk(f"disk{part}", int(part * size), f"run{part}")
                kept = self.get_all_stored(f"run{part}")
                self.run_sweep(f"run{part}", sweep=FULL)
                for before, now, whole in zip(
                    kept, self.get_all_stored(f"run{part}"), self.get_all_stored("undisturbed")
                ):
                    self.assertLessEqual(before, now)
                    self.assertEqual(now, whole)
                self.assert_same_sweeps(f"run{part}", "undisturbed")

    def fill_disk(self, disk, size, name):
        """Runs the sweep on a disk of so many bytes, and copies what is there then."""
        (self.folder / disk).mkdir()
        run = shlex.join([TWINMAP, "run", str(CART), *FULL, "--quiet", "--out", str(self.folder / disk / name)])
        script = f"""mount -t tmpfs -o size={size} none {self.folder / disk} || exit 9
            {run}; code=$?; cp -a {self.folder / disk / name} {self.folder}; exit $code"""
        done = subprocess.run(["unshare", "-rm", "sh", "-c", script], capture_output=True, text=True, timeout=600)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stderr, r"twinmap: error: \S+: cannot be \w+[\w ]*: No space left on device")
        self.assertIn(
            "with more room the same command continues:\n  twinmap run", done.stderr.replace(TWINMAP, "twinmap")
        )

    def test_a_store_elsewhere_is_found_by_status_and_verify(self):
        self.run_sweep("run", "--store", self.folder / "store", sweep=[*LIMITS, "design.train.samples=8,16"])
        self.assertFalse((self.folder / "run/chunks").exists())
        status = call("status", self.folder / "run").stdout
        self.assertIn("samples: 24 of 24 stored\nlimits:  differences at test points: 8 of 8 stored", status)
        verified = call("verify", self.folder / "run")
        self.assertEqual(verified.returncode, 0, verified.stdout)
        self.assertIn("responses of the 24 samples that chunks hold", verified.stdout)

    def interrupt(self, name, number, pattern, times=1):
        """Sends the signal once something matches the pattern in the folder."""
        child = self.start(name, "--threads", "1")
        wait_until(lambda: list(self.folder.glob(f"{name}/{pattern}")), child)
        for _ in range(times):
            child.send_signal(number)
            time.sleep(0.05)
        _, message = child.communicate(timeout=600)
        return child.returncode, message

    def test_an_interrupt_finishes_what_is_under_way_and_says_how_to_continue(self):
        self.copy_sweep("undisturbed")
        code, message = self.interrupt("run", signal.SIGINT, "cases/*")
        self.assertEqual(code, 130)
        self.assertIn("the same command continues:\n  twinmap run", message)
        complete = len(list(self.folder.glob("run/cases/*/provenance.json")))
        self.assertEqual(complete, len(self.list_cases("run")), "a case under way was not finished")
        self.assertEqual(len({row["case"] for row in read_csv(self.folder / "run/sweep.csv")}), complete)
        self.assertLess(complete, 8)
        self.run_sweep("run")
        self.assert_same_sweeps("run", "undisturbed")
        self.assertEqual(self.interrupt("term", signal.SIGTERM, "cases/*")[0], 143)

    def test_an_interrupt_during_the_simulations_keeps_those_finished(self):
        long = [*SMALL, "design.train.samples=2000,4000", "seed=1..2"]
        child = self.start("run", sweep=long)
        wait_until(lambda: self.get_stored("run"), child)
        child.send_signal(signal.SIGINT)
        child.communicate(timeout=600)
        self.assertEqual(child.returncode, 130)
        stored = len(self.get_stored("run"))
        self.assertIn(f"{stored} of 8016 stored", call("status", self.folder / "run").stdout)
        self.assertLess(stored, 8016)

    def test_a_second_interrupt_stops_at_once(self):
        slow = [*SMALL, "design.train.samples=600,601", "noise.replicates=4"]  # trains for many seconds
        child = self.start("run", "--threads", "1", sweep=slow)
        wait_until(lambda: list(self.folder.glob("run/cases/*/samples.h5")), child)
        child.send_signal(signal.SIGINT)
        time.sleep(0.1)
        self.assertIsNone(child.poll())
        child.send_signal(signal.SIGINT)
        child.communicate(timeout=30)
        self.assertEqual(child.returncode, 130)

    def test_status_says_who_is_running(self):
        slow = [*SMALL, "design.train.samples=600,601", "noise.replicates=4"]
        child = self.start("run", "--threads", "1", sweep=slow)
        wait_until(lambda: list(self.folder.glob("run/cases/*/samples.h5")), child)
        status = call("status", self.folder / "run").stdout
        second = self.run_sweep("run", sweep=slow, code=1)
        child.kill()
        child.communicate()
        self.assertIn(f"running: process {child.pid}", status)
        self.assertIn("0 of 2 complete, 0 failed, 2 missing", status)
        self.assertIn(f"is in use by process {child.pid}", second.stderr)
        self.assertIn("not running", call("status", self.folder / "run").stdout)


class ProgressShown(SweepTestCase):
    def run_on_terminal(self, name, *arguments):
        """What a run writes to a terminal as its stderr."""
        terminal, stderr = pty.openpty()
        child = subprocess.Popen(
            [TWINMAP, "run", CART, *SWEEP, *arguments, "--out", str(self.folder / name)],
            stdout=subprocess.DEVNULL,
            stderr=stderr,
            env={**os.environ, "TERM": "xterm"},
        )
        os.close(stderr)
        shown = b""
        try:
            while part := os.read(terminal, 4096):
                shown += part
        except OSError:  # the other end is closed
            pass
        os.close(terminal)
        self.assertEqual(child.wait(timeout=600), 0)
        return shown.decode()

    def test_a_terminal_has_a_bar_with_stage_counts_and_rate(self):
        shown = self.run_on_terminal("run")
        self.assertRegex(shown, r"\[#+-*\] simulate: \d+ of 48, \d+ simulations/s")
        self.assertRegex(shown, r"\[#{30}\] cases: 8 of 8")

    def test_stencils_are_a_stage_that_counts_their_simulations(self):
        shown = self.run_on_terminal("run", "evaluation.limit=true", DIFFERENCES)
        self.assertRegex(shown, rf"\[#+-*\] simulate sensitivities: \d+ of {2 * 8 * 7}, \d+ simulations/s")
        self.assertIn("16 of 16 missing stencils simulated", (self.folder / "run/run.log").read_text())

    def test_quiet_shows_none_and_other_outputs_get_no_control_sequences(self):
        self.assertNotIn("simulate:", self.run_on_terminal("quiet", "--quiet"))
        self.assertNotIn("\x1b", run_once(CART, *SWEEP)[1].stderr)

    def test_the_log_names_the_cases(self):
        self.copy_sweep("run")
        log = (self.folder / "run/run.log").read_text()
        self.assertIn("48 of 48 missing samples simulated", log)
        self.assertIn("info: samples-8_scale-1_seed-2: train the inverse map: ", log)
        self.assertIn("case samples-16_scale-0.5_seed-1 is complete", log)


class Plan(SweepTestCase):
    def plan(self, *arguments):
        result = call("plan", CART, *arguments, "--out", self.folder / "run")
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def test_says_what_then_happens_and_changes_nothing(self):
        plan = self.plan(*SWEEP)
        self.assertIn("cases:       8, 0 of them complete", plan)
        self.assertIn("simulations: 48 needed, 0 stored, 48 to do", plan)
        self.assertRegex(plan, r"time:        about [\d.]+ (s|min): [\d.]+ s to simulate, [\d.]+ (s|min) for the cases")
        self.assertFalse((self.folder / "run").exists())
        self.run_sweep("run")
        self.assertEqual(len(self.get_stored("run")), 48)
        files = sorted((self.folder / "run").rglob("*"))
        self.assertIn("8, 8 of them complete\nsimulations: 48 needed, 48 stored, 0 to do", self.plan(*SWEEP))
        self.assertEqual(files, sorted((self.folder / "run").rglob("*")))

    def test_refuses_what_does_not_fit(self):
        gp = "inverse_map={gp: {approximation: exact}}"
        result = call("plan", CART, gp, "design.train.samples=60000", "--out", self.folder / "run")
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertRegex(result.stdout, r"memory:      about \d+ GiB, of ")
        self.assertRegex(result.stderr, r"design: needs about \d+ GiB of memory for .* 60000 training samples")
        self.assertFalse((self.folder / "run").exists())

    def test_counts_what_is_stored_and_what_the_limits_need(self):
        self.run_sweep("run", sweep=[*SMALL, DIFFERENCES, "design.train.samples=8"])
        plan = self.plan(*LIMITS, "design.train.samples=8,24", "--store", self.folder / "run/chunks")
        self.assertIn("simulations: 32 needed, 16 stored, 16 to do", plan)
        self.assertIn(f"finite differences at 8 points needed, 0 stored, 8 to do: {8 * (2 * 3 + 1)} simulations", plan)
        store = ["--store", self.folder / "run/chunks"]
        self.run_sweep("limits", *store, sweep=[*LIMITS, "design.train.samples=8,24"])
        self.assertIn(
            "finite differences at 8 points needed, 8 stored, 0 to do: 0 simulations",
            self.plan(*LIMITS, "design.train.samples=8,24,30", *store),
        )

    def test_warns_of_plain_latin_hypercubes(self):
        plan = self.plan(*SWEEP, "design.train.method=latin_hypercube")
        self.assertIn("design.train.method is latin_hypercube: each of its 2 sizes is simulated anew", plan)
        self.assertIn("simulations: 64 needed", plan)
        self.assertNotIn("warning", self.plan(*SWEEP))

    def test_disk_is_about_what_is_written(self):
        sizes = [
            *SMALL,
            "design.train.samples=100,200",
            "noise.replicates=2",
            "inverse_map.gp.max_evaluations=2",
            "evaluation.limit=true",
            "design.test.samples=60",
            DIFFERENCES,
        ]
        number, unit = re.search(r"disk:        about ([\d.e+]+) (\w+)", self.plan(*sizes)).groups()
        planned = float(number) * {"MiB": 2**20, "GiB": 2**30}[unit]
        self.run_sweep("run", sweep=sizes)
        written = sum(path.stat().st_size for path in (self.folder / "run").rglob("*") if path.is_file())
        self.assertLess(planned / 2, written)
        self.assertLess(written, 2 * planned)

    def test_why_times_are_not_known_is_said(self):
        self.assertIn("time:        not known: ", self.plan(*SMALL, "simulation.max_steps=3"))


class Failures(SweepTestCase):
    FAILING = [*SMALL, "design.train.samples=8", "simulation.max_steps=100000,3,90000"]

    def test_a_case_that_fails_is_listed_and_stops_no_other(self):
        result = self.run_sweep("run", sweep=self.FAILING, code=1)
        self.assertIn("1 of 3 cases failed", result.stderr)
        failures = read_csv(self.folder / "run/failed_cases.csv")
        self.assertEqual([f["case"] for f in failures], ["max_steps-3"])
        self.assertIn("step limit", failures[0]["reason"])
        self.assertEqual(
            {row["case"] for row in read_csv(self.folder / "run/sweep.csv")}, {"max_steps-100000", "max_steps-90000"}
        )
        self.assertIn("2 of 3 complete, 1 failed, 0 missing", call("status", self.folder / "run").stdout)
        again = call(*shlex.split(failures[0]["command"])[1:])
        self.assertEqual(again.returncode, 1)
        self.assertIn("8 of 8 train samples failed", again.stderr)
        self.run_sweep("run", sweep=self.FAILING, code=1)

    def test_a_model_that_always_fails_is_given_up_and_holds_up_no_other(self):
        for repeat in (1, 2):
            self.run_sweep("run", sweep=[*LIMITS, "design.train.samples=40", "simulation.max_steps=3,100000"], code=1)
            failures = read_csv(self.folder / "run/failed_cases.csv")
            self.assertEqual([f["case"] for f in failures], ["max_steps-3"])
            self.assertRegex(failures[0]["reason"], "the first 12 train simulations all failed: step limit")
            stored = {
                content.parent: sum(len(read_points(chunk)) for chunk in content.parent.glob("*.chunk"))
                for content in self.folder.glob("run/chunks/*/content.yaml")
            }
            # No stencils and a dozen samples; stencils and samples of the other.
            self.assertEqual(sorted(stored.values()), [0, 8, 12, 40 + 8], stored)

    def test_fail_fast_begins_no_other(self):
        result = self.run_sweep(
            "run",
            "--fail-fast",
            "--threads",
            1,
            "design.train.samples=8,16",
            "simulation.max_steps=3,100000",
            sweep=SMALL,
            code=1,
        )
        self.assertEqual(len(read_csv(self.folder / "run/failed_cases.csv")), 1)
        self.assertLess(len(self.list_cases("run")), 4)
        self.assertNotEqual(result.returncode, 0)

    def test_a_model_that_cannot_be_built_fails_its_cases_alone(self):
        broken = [*SMALL, "design.train.samples=8", "system.bodies.cart.mass=1.2,k-100"]
        self.run_sweep("run", sweep=broken, code=1)
        failures = read_csv(self.folder / "run/failed_cases.csv")
        self.assertEqual([f["case"] for f in failures], ["mass-k-100"])
        self.assertIn("mass", failures[0]["reason"])
        self.assertEqual({row["case"] for row in read_csv(self.folder / "run/sweep.csv")}, {"mass-1.2"})

    def test_a_wrong_value_is_found_before_anything_is_done(self):
        result = self.run_sweep("run", "noise.scale=1,-1", code=2)
        self.assertIn("command line: noise.scale: '-1' must be a number, 0 or above", result.stderr)
        self.assertFalse((self.folder / "run").exists())
        self.assertEqual(call("check", CART, "noise.scale=1,-1").returncode, 2)
