"""twinmap export --track: the tracker in C and in FMUs against twinmap track."""
import csv
import json
import os
import re
import subprocess
import unittest
import xml.etree.ElementTree as ElementTree
import zipfile

import numpy as np

from export_test import SMALL, TWO_BEAM, Block2, Block3, Exported, check_description, compile_c, need
from support import EXPERIMENTS, call, run_once

BEAMS = EXPERIMENTS / "two_beam/best.yaml"
NETWORK = ["inverse_map={network: {steps: 500, surrogate_samples: 4000}}", "design.train.samples=100"]
COUNT = 1000 if os.environ.get("TWINMAP_ALL_CASES") else 120
TRACKED = "200 tracked, 0 differences"
TRACKING = """
tracking:
  drift: {k_y: {random_walk: {stddev: 0.02, over: 10}}, k_theta: {trend: unknown}}
  changes: {k_y: {every: 1 d}, d_y: {every: 1 year}}
  alarm: {false_alarms: 1 in 5000}
"""
FOLLOWING = TRACKING + "  follows: {k_y: [temperature], d_y: [temperature, load]}\n"
# Reads measurements (rows of signals on the grid), writes what is believed behind each.
DRIVER = r"""
#include <stdio.h>
#include "twinmap_track.h"
static twinmap_state state;
static twinmap_track track;
static double times[TWINMAP_GRID], row[TWINMAP_ROWS];
int main(void)
{
  const twinmap_real *signals[TWINMAP_SIGNALS];
  double number = 0.0;
  int i, s;
  for (s = 0; s < TWINMAP_SIGNALS; ++s) {
    signals[s] = row + s * TWINMAP_GRID;
  }
  if (fread(times, sizeof(double), TWINMAP_GRID, stdin) != TWINMAP_GRID) {
    return 1;
  }
  twinmap_track_begin(&track);
  while (fread(row, sizeof(double), TWINMAP_ROWS, stdin) == TWINMAP_ROWS) {
    twinmap_result result;
    twinmap_track_answer answer;
    number += 1.0;
    if (twinmap_infer(&state, TWINMAP_GRID, times, signals, 0.0, NULL, &result) != TWINMAP_OK ||
        twinmap_track_update(&track, &result, number, NULL, &answer) != TWINMAP_TRACK_OK) {
      return 1;
    }
    for (i = 0; i < TWINMAP_PARAMETERS; ++i) {
      printf("%.17g %.17g %.17g %.17g %.17g ", answer.mean[i], answer.sd[i], answer.lower[i], answer.upper[i],
             answer.walk[i]);
    }
    for (i = 0; i < TWINMAP_PARAMETERS; ++i) {
      printf("%.17g ", answer.covariance[i]);
    }
    printf("%.17g %d %d %d %.17g %.17g\n", answer.alarm_statistic, answer.fits, (int)answer.alarm, answer.parameter,
           answer.change_time, answer.change_size);
  }
  return 0;
}
"""


class Life:
    """Responses of a machine whose k_y steps in the middle of its life; one in twenty is bad."""

    def __init__(self, folder, count):
        columns = []
        for k_y in (9, 9.3):
            file = folder / f"{k_y}.csv"
            result = call("simulate", BEAMS, "--csv", file, f"parameters.k_y={k_y}")
            assert result.returncode == 0, result.stderr
            with open(file, newline="") as text:
                rows = list(csv.DictReader(text))
            columns.append({name: np.array([float(row[name]) for row in rows]) for name in rows[0]})
        rng = np.random.default_rng(11)
        self.times = columns[0]["t"]
        self.values = []
        for i in range(count):
            clean = columns[i >= count // 2]
            noisy = [clean[name] + sd * rng.standard_normal(len(clean[name])) for name, sd in TWO_BEAM.items()]
            if i % 20 == 19:
                noisy[0] = noisy[0] * (0.9 if i % 40 == 19 else 1.1)
            self.values.append(np.concatenate(noisy))

    def write(self, path):
        path.write_bytes(self.times.tobytes() + np.ascontiguousarray(self.values).tobytes())

    def track(self, run, state, *arguments):
        lines = []
        for row in self.values:
            lines.append(",".join(["t", *TWO_BEAM]))
            samples = zip(self.times, *row.reshape(len(TWO_BEAM), -1))
            lines += [",".join(repr(float(value)) for value in sample) for sample in samples] + [""]
        text = "\n".join(lines) + "\n"
        result = call("track", run, "--follow", "--no-refine", "--state", state, *arguments, input=text)
        if result.returncode != 0:
            raise AssertionError(result.stderr)
        return [json.loads(line)["track"] for line in result.stdout.splitlines()]


class ExportedTracks(Exported):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.trained, _ = run_once(BEAMS, *SMALL, *NETWORK)
        cls.life = Life(cls.folder, COUNT)

    def write_section(self, text=TRACKING):
        file = self.folder / f"tracking{len(text)}.yaml"
        file.write_text(text)
        return file

    def export_track(self, *arguments):
        return self.export(self.trained, "--track", *map(str, arguments))

    def compare_tracks(self, most, *section):
        folder = self.folder / f"compared{len(section)}"
        result = call("export", self.trained, "--c", folder, "--track", *section)
        self.assertEqual(result.returncode, 0, result.stderr)
        (folder / "driver.c").write_text(DRIVER)
        compile_c(folder, ["driver.c", "twinmap_map.c", "twinmap_track.c"], "driver", "-O3")
        self.life.write(folder / "measurements")
        with open(folder / "measurements", "rb") as file:
            found = subprocess.run([folder / "driver"], stdin=file, capture_output=True, text=True)
        self.assertEqual(found.returncode, 0)
        expected = self.life.track(self.trained, folder / "track.h5", *section)
        rows = [[float(number) for number in line.split()] for line in found.stdout.splitlines()]
        self.assertEqual(len(rows), len(expected))
        worst, alarms = 0.0, []
        for row, answer in zip(rows, expected):
            parameters = answer["parameters"]
            p = len(parameters)
            numbers, scales = [], []
            for one in parameters.values():
                numbers += [one["mean"], one["sd"], one["lower"], one["upper"], one["walk"]["sd"]]
                scales += [abs(one["mean"])] * 4 + [100 * abs(one["mean"])]  # weights of rates are exponentials
            apart = np.abs(np.array(row[: 5 * p]) - numbers) / scales
            worst = max(worst, np.max(apart))
            sds = [one["sd"] for one in parameters.values()]
            np.testing.assert_allclose(row[5 * p : 6 * p], answer["covariance"][0], rtol=1e-9, atol=1e-9 * sds[0] ** 2)
            statistic, fits, alarm, parameter, time, size = row[6 * p :]
            self.assertAlmostEqual(statistic, answer["alarm_statistic"], delta=1e-7 * (1 + statistic))
            self.assertEqual(bool(fits), answer["fits"])
            self.assertEqual(int(alarm) > 0, len(answer["alarms"]) > 0)
            for one in answer["alarms"]:
                alarms.append(one["parameter"])
                if one["parameter"] is not None:
                    self.assertEqual(list(parameters)[int(parameter)], one["parameter"])
                    self.assertEqual(time, one["time"])
                    self.assertAlmostEqual(size, one["size"], delta=1e-9 * one["sd"])
        print(f"{len(rows)} tracked {section}: within {worst:.2g}, alarms {alarms}")
        self.assertLess(worst, most)
        self.assertIn("k_y", alarms)

    def test_the_c_tracks_as_track_does(self):
        self.compare_tracks(1e-12)

    def test_the_c_tracks_as_a_section_says(self):
        self.compare_tracks(2e-11, "--tracking", self.write_section())  # a slope loses digits

    def test_selftests_pass_with_gcc_clang_and_a_prefix(self):
        self.check_selftest(self.export_track(), says=TRACKED)
        self.check_selftest(self.export_track("--tracking", self.write_section()), "CC=clang", says=TRACKED)
        followed = self.export_track("--tracking", self.write_section(FOLLOWING), "--prefix", "pump")
        self.check_selftest(followed, says=TRACKED)
        self.assertNotIn("twinmap_", (followed / "pump_track.c").read_text())
        self.assertIn("Conditions, in this order: temperature, load", (followed / "README.md").read_text())

    def test_it_takes_no_heap_and_the_memory_that_the_readme_says(self):
        for section in ([], ["--tracking", self.write_section(FOLLOWING)]):
            folder = self.export_track(*section)
            self.check_memory(folder)
            self.check_memory(folder, "track", "track", "stack of an update")

    @need("aarch64-linux-gnu-gcc", "qemu-aarch64", "arm-none-eabi-gcc", "qemu-system-arm")
    def test_selftests_pass_on_emulated_machines(self):
        folder = self.export_track("--tracking", self.write_section(FOLLOWING))
        self.check_on_aarch64(folder, says=TRACKED)
        self.check_on_cortex_m7(folder, "track_selftest.c", ("map", "track"), TRACKED)

    def test_the_fmus_track(self):
        (first, *_) = self.life.track(self.trained, self.folder / "fmu.h5")
        for version, kind in ((2, Block2), (3, Block3)):
            file, folder = self.folder / f"track{version}.fmu", self.folder / f"fmu{version}"
            result = call("export", self.trained, "--fmu", file, "--fmi", version, "--track")
            self.assertEqual(result.returncode, 0, result.stderr)
            with zipfile.ZipFile(file) as archive:
                archive.extractall(folder)
            root = ElementTree.parse(folder / "modelDescription.xml").getroot()
            references = check_description(self, root, version)
            (library,) = folder.glob("binaries/*/*.so")
            block = kind(library, root)
            signals = self.life.values[0].reshape(len(TWO_BEAM), -1)
            for i, t in enumerate(np.append(self.life.times, self.life.times[-1] + 0.05)):
                block.set([references[name] for name in TWO_BEAM], signals[:, min(i, signals.shape[1] - 1)])
                block.step(float(t), 0.05)
            for name, one in first["parameters"].items():
                found = block.get([references[f"track.{key}.{name}"] for key in ("mean", "sd", "lower")])
                for value, key in zip(found, ("mean", "sd", "lower")):
                    self.assertAlmostEqual(value, one[key], delta=1e-5 * one["sd"])  # the window is resampled
            self.assertEqual(block.get_integer(references["inferences"]), 1)
            self.assertEqual(block.get_integer(references["track.alarms"]), 0)
            self.assertEqual(block.get_integer(references["track.alarm.parameter"]), 0)

    def test_what_cannot_be_is_refused(self):
        section = self.write_section(FOLLOWING)
        for arguments, says in (
            (["--json", self.folder / "map.json", "--track"], "trackers are C"),
            (["--fmu", self.folder / "map.fmu", "--track", "--tracking", section], "no inputs"),
            (["--c", self.folder / "no", "--tracking", section], "--track"),
            (["--c", self.folder / "no", "--track", "--tracking", BEAMS], "has no section 'tracking'"),
        ):
            result = call("export", self.trained, *arguments)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(says, result.stderr)
        self.assertFalse((self.folder / "no").exists())

    def test_the_readme_says_what_an_update_takes(self):
        readme = (self.export_track() / "README.md").read_text()
        found = re.search(r"An update takes at most ([\d.]+) thousand multiply-adds and ([\d.]+) thousand", readme)
        self.assertGreater(float(found.group(1)), 1)
        for said in ("Late measurements", "The same measurement again", "Rivals"):
            self.assertIn(said, readme)


if __name__ == "__main__":
    unittest.main()
