"""Every command once, on experiments of a few samples, as a new user would go through them.

The other tests of the command say what each result must be. This one is what sanitizer builds run of them."""
import json
import subprocess
import unittest

from support import EXPERIMENTS, RunTestCase, call, read_csv

TINY = ["design.train.samples=30", "design.test.samples=6"]
CHAIN = EXPERIMENTS / "three_mass_chain/modes.yaml"


class Walkthrough(RunTestCase):
    ARGUMENTS = TINY

    def succeed(self, *arguments, **options):
        result = call(*arguments, **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.measurement = cls.simulate("m.csv", "parameters.k_y=8")

    def test_experiments_are_checked(self):
        subprocess.run([EXPERIMENTS / "fmu/build-fmu"], check=True, capture_output=True)
        for path in sorted(EXPERIMENTS.glob("*/*.yaml")):
            if path.parent.name != "silverbox":  # needs data that are not ours to distribute
                self.assertIn("parameters:", self.succeed("check", path))
        self.assertIn("properties", json.loads(self.succeed("schema")))

    def test_a_wrong_experiment_is_refused(self):
        result = call("check", self.FILE, "noise.scale=-1")
        self.assertEqual(result.returncode, 2)
        self.assertIn("noise.scale", result.stderr)

    def test_a_run_has_its_tables_and_is_the_same_when_verified(self):
        self.assertEqual(len(read_csv(self.run_folder / "metrics.csv")), 4)
        self.succeed("verify", self.run_folder, "--samples", 2)
        self.succeed("report", self.run_folder)
        self.assertIn("</html>", (self.run_folder / "report.html").read_text())

    def test_the_map_is_exported(self):
        self.succeed(
            "export",
            self.run_folder,
            "--c",
            self.folder / "c",
            "--float",
            "--fmu",
            self.folder / "map.fmu",
            "--json",
            self.folder / "map.json",
        )
        self.assertIn("twinmap_infer", (self.folder / "c/twinmap_map.h").read_text())
        self.assertEqual(json.loads((self.folder / "map.json").read_text())["format"], "twinmap map")
        self.assertIn("trigger", self.succeed("variables", self.folder / "map.fmu"))

    def test_a_measurement_is_inferred_refined_and_replayed(self):
        inferred = json.loads(self.succeed("infer", self.run_folder, self.measurement, "--json", "--refine"))
        self.assertEqual(set(inferred["parameters"]), {"d_y", "d_theta", "k_y", "k_theta"})
        self.succeed("replay", self.run_folder, self.measurement, "--out", self.folder / "replay")
        self.assertEqual(len(read_csv(self.folder / "replay/fit.csv")), 2)
        stream = self.measurement.read_text()
        lines = self.succeed("infer", self.run_folder, "--follow", input=f"{stream}\n{stream}\n").splitlines()
        self.assertEqual(len(lines), 2)
        self.assertIn("theta", self.succeed("noise", self.measurement, "--window", "0,2"))

    def test_a_sweep_is_planned_run_continued_and_compared(self):
        sweep = [self.FILE, *TINY, "noise.scale=1,2", "evaluation.limit=false", "--out", self.folder / "sweep"]
        self.assertRegex(self.succeed("plan", *sweep), "cases: +2")
        self.succeed("run", *sweep)
        self.succeed("run", *sweep)
        self.succeed("status", self.folder / "sweep")
        cases = sorted((self.folder / "sweep/cases").iterdir())
        self.assertEqual(len(cases), 2)
        self.assertIn("k_theta", self.succeed("compare", *cases))

    def test_other_kinds_of_features_and_maps_are_run(self):
        self.succeed("run", CHAIN, *TINY, "--out", self.folder / "modes")
        self.succeed(
            "run",
            self.FILE,
            *TINY,
            "evaluation.limit=false",
            "inverse_map.gp.approximation=sgpr",
            "inverse_map.gp.inducing=10",
            "--out",
            self.folder / "sparse",
        )
