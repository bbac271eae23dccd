"""pip install from the source tree, without a network."""
import os
import subprocess
import sys
import unittest
from pathlib import Path

from package_support import SOURCE, TABLE_1, FolderTestCase

USE = """
import twinmap
experiment = twinmap.Experiment.from_file({file!r})
print(twinmap.__file__)
print(experiment.simulate({{"k_y": 8}})["y"].shape, (__import__("pathlib").Path(twinmap.__file__).parent / "py.typed").exists())
"""


class Install(FolderTestCase):
    def test_pip_installs_the_source_tree(self):
        target = self.folder / "site"
        environment = {**os.environ, "TWINMAP_BUILD": os.environ["TWINMAP_BUILD_DIR"], "PIP_NO_INDEX": "1"}
        subprocess.run(
            [
                sys.executable,
                "-m",
                "pip",
                "install",
                "--quiet",
                "--no-build-isolation",
                "--no-deps",
                "--disable-pip-version-check",
                "--target",
                target,
                SOURCE,
            ],
            check=True,
            env=environment,
        )
        used = subprocess.run(
            [sys.executable, "-c", USE.format(file=str(TABLE_1))],
            capture_output=True,
            text=True,
            cwd=self.folder,
            env={"PYTHONPATH": str(target), "PATH": os.environ["PATH"]},
        )
        self.assertEqual(used.stdout, f"{target}/twinmap/__init__.py\n(1, 100) True\n", used.stderr)
        version = next(Path(target).glob("twinmap-*.dist-info")).name
        self.assertRegex(version, r"twinmap-\d+\.\d+\.\d+\.dist-info")
