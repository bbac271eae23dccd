"""What the tests of the command share."""
import csv
import functools
import io
import json
import os
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import h5py

TWINMAP = os.environ["TWINMAP"]
EXPERIMENTS = Path(os.environ["TWINMAP_SOURCE_DIR"]) / "experiments"
# A run of a few seconds that infers well: 60 simulations, no information limit.
QUICK = ["design.train.samples=60", "design.test.samples=60", "evaluation.limit=false"]

# The sign of e, how far the load is off the axis, is not seen.
MIRROR = """
name: mirror
parameters:
  e: {bounds: [-0.1, 0.1], unit: m, relative_to: range}
  k: {bounds: [3, 6], unit: N m/rad}
constants: {m: {value: 1.5, unit: kg}}
system:
  bodies:
    table: {mass: 2, inertia: {moments: [0.01, 0.01, 0.01]}, joint: {type: pin, coordinates: [th]}}
    load: {mass: m, joint: {type: weld, parent: table, in_parent: {point: [e, 0, 0]}}}
  springs: [{coordinate: th, stiffness: k}]
  dampers: [{coordinate: th, damping: 0.03}]
  applied_moments: [{body: table, moment: [0, 0, T]}]
excitation: {T: {unit: N m, pulses: [{amplitude: 1, start: 0.05, end: 0.2}]}}
outputs: {th: {coordinate: th}}
simulation: {duration: 3}
features: [{samples: {outputs: [th], start: 0.03, interval: 0.03, count: 99}}]
noise: {stddev: {th: 3e-3}}
"""


# Of which a free decay tells k / m alone, and a step both: trials follow.
WEIGHED_MACHINE = """
name: weighed
parameters:
  k: {bounds: [50, 150], unit: N/m}
  m: {bounds: [0.5, 2], unit: kg}
system:
  bodies: {cart: {mass: m, joint: {type: slider, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: k}]
  dampers: [{coordinate: x, damping: 0.02}]
  applied_forces: [{body: cart, force: [F, 0, 0]}]
outputs: {x: {coordinate: x}}
simulation: {duration: 2}
features: [{samples: {outputs: [x], start: 0.05, interval: 0.05, count: 39}}]
noise: {stddev: {x: 1e-3}}
excitation: {F: {unit: N, pulses: [{amplitude: 0, start: 0, end: 9}]}}
"""

WEIGHED_TRIALS = """\
trials:
  free:
    initial: {coordinates: {x: x0}}
    nuisance: {x0: {bounds: [0.04, 0.06], unit: m}}
  step:
    excitation: {F: {unit: N, pulses: [{amplitude: 4, start: 0, end: 9}]}}
    simulation: {duration: 3}
    features: [{samples: {outputs: [x], start: 0.1, interval: 0.1, count: 29}}]
"""


def call(*arguments, timeout=600, **options):
    return subprocess.run([TWINMAP, *map(str, arguments)], capture_output=True, text=True, timeout=timeout, **options)


SHARED = tempfile.TemporaryDirectory(prefix="twinmap_shared_")


@functools.lru_cache(maxsize=None)
def run_once(file, *arguments):
    """(folder, result) of a run that succeeds, made once for all tests of the program: read it, or damage a copy."""
    folder = Path(tempfile.mkdtemp(dir=SHARED.name)) / "run"
    result = call("run", file, *arguments, "--out", folder)
    if result.returncode != 0:
        raise RuntimeError(result.stderr)
    return folder, result


def read_csv(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def read_columns(text):
    """Name -> numbers, of CSV."""
    rows = list(csv.DictReader(io.StringIO(text)))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def read_datasets(path):
    """Name -> all digits of its values, of an HDF5 file; NaNs are equal."""
    found = {}
    with h5py.File(path) as file:
        file.visititems(
            lambda name, item: found.update({name: repr(item[()].tolist())}) if hasattr(item, "dtype") else None
        )
    return found


def wait_until(reached, child=None, seconds=300):
    """Fails where that is not reached in time, or its process has ended before."""
    deadline = time.monotonic() + seconds
    while not reached():
        if child is not None and child.poll() is not None and not reached():
            raise AssertionError(f"the process that was waited for ended with {child.returncode}")
        if time.monotonic() > deadline:
            raise AssertionError(f"waited for {seconds} s")
        time.sleep(0.002)


def find_processes(variable):
    """Ids of living processes that have NAME=VALUE in their environment."""
    found = []
    for entry in Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and variable.encode() in (entry / "environ").read_bytes():
                found.append(int(entry.name))
        except OSError:
            pass
    return found


def await_processes(variable, enough, timeout=20):
    """What the first look finds that is `enough`, or the last look of `timeout` seconds. To be judged as it is: a
    second look can differ, as a process that is just becoming another program (`python3` may be a script that starts
    one) has no environment."""
    deadline = time.monotonic() + timeout
    found = find_processes(variable)
    while not enough(found) and time.monotonic() < deadline:
        time.sleep(0.02)
        found = find_processes(variable)
    return found


def write_csv(path, names, columns):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(names)
        writer.writerows(zip(*columns))


class FolderTestCase(unittest.TestCase):
    """A folder for all tests of the class."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="twinmap_test_")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)


class OwnFolderTestCase(unittest.TestCase):
    """A folder for each test."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="twinmap_test_")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def expect_inference_from_the_file_alone(self, run, experiment, sds):
        """The maps.h5 of a run of the two beams, moved away, finds the parameters that were simulated."""
        measured = self.folder / "measured.csv"
        given = {"k_y": 8.0, "k_theta": 0.04}
        overrides = [f"parameters.{name}={value}" for name, value in given.items()]
        self.assertEqual(call("simulate", experiment, *overrides, "--csv", measured).returncode, 0)
        (run / "maps.h5").rename(self.folder / "maps.h5")
        result = call("infer", self.folder / "maps.h5", measured, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        answer = json.loads(result.stdout)
        self.assertEqual(answer["status"], "ok")
        for name, value in given.items():
            found = answer["parameters"][name]
            self.assertLess(abs(found["mean"] - value), sds * found["sd"], name)


class RunTestCase(FolderTestCase):
    """One run for all tests, of FILE with ARGUMENTS."""

    FILE = EXPERIMENTS / "two_beam/best.yaml"
    ARGUMENTS = QUICK

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write_files()
        cls.run_folder, _ = run_once(cls.FILE, *cls.ARGUMENTS)

    @classmethod
    def write_files(cls):
        """Writes what the run needs into the folder, FILE for one."""

    @classmethod
    def simulate(cls, name, *arguments):
        """A simulated measurement, noise included."""
        path = cls.folder / name
        result = call("simulate", cls.FILE, "--noise", "--csv", path, *arguments)
        if result.returncode != 0:
            raise RuntimeError(result.stderr)
        return path
