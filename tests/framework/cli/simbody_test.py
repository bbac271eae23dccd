"""Simbody is loaded where a model is first built on it, and nowhere else."""
import os
import shutil
import subprocess
import unittest
from pathlib import Path

from support import EXPERIMENTS, TWINMAP, FolderTestCase, RunTestCase

CART = EXPERIMENTS / "duffing" / "cart.yaml"


def call_with(program, *arguments, **environment):
    return subprocess.run(
        [program, *map(str, arguments)], capture_output=True, text=True, timeout=600, env={**os.environ, **environment}
    )


class Loaded(RunTestCase):
    def loads_simbody(self, *arguments):
        """By what the dynamic linker says of the files that it opens."""
        result = call_with(TWINMAP, *arguments, LD_DEBUG="files")
        self.assertEqual(result.returncode, 0, result.stderr[-1000:])
        self.assertIn("libstdc++", result.stderr)
        return "libSimTK" in result.stderr

    def test_inference_loads_none_with_or_without_refinement(self):
        measurement = self.simulate("m.csv", "parameters.k_y=8")
        self.assertFalse(self.loads_simbody("infer", self.run_folder, measurement, "--no-refine"))
        self.assertFalse(self.loads_simbody("infer", self.run_folder, measurement, "--refine"))

    def test_a_model_that_is_simulated_first_is_checked_by_it(self):
        self.assertTrue(self.loads_simbody("simulate", CART))


class Missing(FolderTestCase):
    """The command with its database of units alone."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        units = "share/twinmap/units"
        shutil.copytree(Path(TWINMAP).parents[2] / units, cls.folder / units)

    def test_what_is_missing_is_named(self):
        alone = shutil.copy2(TWINMAP, self.folder / "twinmap")
        result = call_with(alone, "simulate", CART)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, r"Simbody is needed.*twinmap_simbody\.so.*install")
        self.assertEqual(call_with(alone, "schema").returncode, 0)

    def test_a_module_that_cannot_be_loaded_says_what_to_install(self):
        folder = self.folder / "broken"
        folder.mkdir()
        alone = shutil.copy2(TWINMAP, folder / "twinmap")
        (folder / "twinmap_simbody.so").write_text("not a library")
        result = call_with(alone, "simulate", CART)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, r"cannot be loaded.*libsimbody3\.7")


if __name__ == "__main__":
    unittest.main()
