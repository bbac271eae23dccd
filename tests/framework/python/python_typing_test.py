"""The type hints of the package: complete, right about the module, and right about the code (mypy)."""
import inspect
import shutil
import subprocess
import sys
import tempfile
import typing
import unittest
from pathlib import Path

import twinmap
from twinmap import _twinmap

PACKAGE = Path(twinmap.__file__).parent
USER = """
import twinmap
experiment = twinmap.Experiment.from_file("a.yaml").override("seed=2", seed=3)
results = experiment.run(progress=True)
estimate: twinmap.Estimate = results.map.infer("m.csv", known={"payload": 1.0})
mean, stddev = estimate["k_y"]
total: float = mean + stddev
"""


def list_public():
    for name in twinmap.__all__:
        value = getattr(twinmap, name)
        yield name, value
        if (
            inspect.isclass(value)
            and value.__module__.startswith("twinmap._")
            and value.__module__ != "twinmap._twinmap"
        ):
            for key, member in vars(value).items():
                if not key.startswith("_"):
                    yield f"{name}.{key}", member.fget if isinstance(member, property) else member


class Typing(unittest.TestCase):
    def test_everything_public_is_documented_and_annotated(self):
        for name, value in list_public():
            function = value.__func__ if isinstance(value, staticmethod) else value
            if inspect.isfunction(function):
                hints = typing.get_type_hints(function)
                self.assertIn("return", hints, name)
                self.assertLessEqual(set(inspect.signature(function).parameters) - {"self"}, set(hints), name)
            if inspect.isclass(function) or len(getattr(function, "__qualname__", "").split(".")) < 2:
                self.assertTrue(inspect.getdoc(value), name)

    def test_stub_has_what_the_module_has(self):
        stub = (PACKAGE / "_twinmap.pyi").read_text()
        for name, value in vars(_twinmap).items():
            if name.startswith("__"):
                continue
            self.assertRegex(stub, rf"(class|def) {name}\b")
            for member in vars(value) if inspect.isclass(value) else []:
                if not member.startswith("_"):
                    self.assertRegex(stub, rf"(def )?\b{member}\b", f"{name}.{member}")

    def test_mypy_finds_nothing(self):
        with tempfile.TemporaryDirectory(prefix="twinmap_test_") as folder:
            user = Path(folder) / "user.py"
            user.write_text(USER)
            package = Path(folder) / "twinmap"  # mypy takes none from where packages are installed
            shutil.copytree(PACKAGE, package, ignore=lambda _, names: [n for n in names if ".py" not in n])
            result = subprocess.run(
                [
                    sys.executable,
                    "-m",
                    "mypy",
                    "--strict-optional",
                    "--check-untyped-defs",
                    "--ignore-missing-imports",
                    "--cache-dir",
                    folder,
                    user,
                    *package.glob("*.py"),
                ],
                capture_output=True,
                text=True,
                cwd=folder,
                env={"MYPYPATH": folder, "PATH": "/usr/bin"},
            )
        if "No module named mypy" in result.stderr:
            self.skipTest("mypy is not here")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
