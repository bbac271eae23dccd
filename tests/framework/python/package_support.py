"""What the tests of the Python package share."""
import os
import sys
import tempfile
import unittest
from functools import lru_cache
from pathlib import Path

import twinmap

SOURCE = Path(os.environ["TWINMAP_SOURCE_DIR"])
sys.path.insert(0, str(SOURCE / "tests/framework/cli"))
TABLE_1 = SOURCE / "experiments/two_beam/table1.yaml"
BEST = SOURCE / "experiments/two_beam/best.yaml"
QUICK = {"design.train.samples": 60, "design.test.samples": 60, "evaluation.limit": False}

FOLDER = tempfile.TemporaryDirectory(prefix="twinmap_python_")


@lru_cache(maxsize=None)
def run_once(file=BEST):
    """Experiment and results of a quick run, made once for all tests of the program."""
    experiment = twinmap.Experiment.from_file(file).override(QUICK)
    return experiment, experiment.run(Path(FOLDER.name) / file.stem)


class FolderTestCase(unittest.TestCase):
    """A folder for each test."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="twinmap_test_")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
