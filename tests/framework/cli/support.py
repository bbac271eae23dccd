"""What the tests of the command share."""
import csv
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

TWINMAP = os.environ["TWINMAP"]
EXPERIMENTS = Path(os.environ["TWINMAP_SOURCE_DIR"]) / "experiments"
# A run of a few seconds that infers well: 60 simulations, no information limit.
QUICK = ["design.train.samples=60", "design.test.samples=60", "evaluation.limit=false"]


def call(*arguments, timeout=1500, **options):
    return subprocess.run([TWINMAP, *map(str, arguments)], capture_output=True, text=True, timeout=timeout, **options)


def read_csv(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


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


class RunTestCase(FolderTestCase):
    """One run for all tests of the class, of FILE with ARGUMENTS."""
    FILE = EXPERIMENTS / "two_beam/best.yaml"
    ARGUMENTS = QUICK

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.run_folder = cls.folder / "run"
        result = call("run", cls.FILE, *cls.ARGUMENTS, "--out", cls.run_folder)
        if result.returncode != 0:
            raise RuntimeError(result.stderr)

    @classmethod
    def simulate(cls, name, *arguments):
        """A simulated measurement, noise included."""
        path = cls.folder / name
        result = call("simulate", cls.FILE, "--noise", "--csv", path, *arguments)
        if result.returncode != 0:
            raise RuntimeError(result.stderr)
        return path
