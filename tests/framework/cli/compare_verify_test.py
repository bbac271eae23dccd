"""twinmap compare and verify: two runs side by side, and a run against what it is recomputed to be."""
import csv
import io
import json
import shutil
import unittest

import h5py
import numpy as np
import yaml

from support import EXPERIMENTS, FolderTestCase, call

TABLE1 = EXPERIMENTS / "two_beam/table1.yaml"
SMALL = ["design.train.samples=40", "design.test.samples=30", "inverse_map.gp.starts=1"]


def read_csv(text):
    return list(csv.DictReader(io.StringIO(text)))


class TestCase(FolderTestCase):
    """Runs are made once for all tests of a class; `copy` gives a test one of its own to damage."""

    @classmethod
    def run_experiment(cls, name, *arguments, file=TABLE1):
        result = call("run", file, *SMALL, *arguments, "--out", cls.folder / name)
        assert result.returncode == 0, result.stderr

    def copy(self, name):
        target = self.folder / self.id()
        shutil.copytree(self.folder / name, target)
        return target

    def assert_wrong_input(self, *arguments, message):
        result = call(*arguments)
        self.assertEqual(result.returncode, 2, result)
        self.assertIn(message, result.stderr + result.stdout)


class Compare(TestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.run_experiment("a")
        cls.run_experiment("b", "noise.scale=0.5")
        cls.run_experiment("other_seed", "seed=2")
        experiment = yaml.safe_load(TABLE1.read_text())
        del experiment["parameters"]["d_y"]
        experiment["constants"]["d_y"] = 1.0
        (cls.folder / "three.yaml").write_text(yaml.safe_dump(experiment, sort_keys=False))
        cls.run_experiment("three", file=cls.folder / "three.yaml")

    def compare(self, a, b, *options):
        result = call("compare", self.folder / a, self.folder / b, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr, "")
        return result.stdout

    def read_metrics(self, run):
        return {row["parameter"]: row for row in read_csv((self.folder / run / "metrics.csv").read_text())}

    def test_figures_are_those_of_both_runs_with_an_interval_of_their_difference(self):
        metrics_a, metrics_b = self.read_metrics("a"), self.read_metrics("b")
        rows = read_csv(self.compare("a", "b", "--csv"))
        figures = ["bias_pct", "sd_pct", "mare_pct", "coverage95", "nlpd", "crps_pct"]
        figures += [name for name in ("limit_pct", "ratio_to_limit") if name in metrics_a["d_y"]]
        self.assertEqual(
            [(row["parameter"], row["figure"]) for row in rows],
            [(parameter, figure) for parameter in metrics_a for figure in figures],
        )
        for row in rows:
            a, b = (float(metrics[row["parameter"]][row["figure"]]) for metrics in (metrics_a, metrics_b))
            self.assertEqual((float(row["a"]), float(row["b"])), (a, b), row)
            self.assertAlmostEqual(float(row["difference"]), b - a, 12)
            self.assertEqual(row["paired"], "1")
            if row["figure"] == "coverage95":
                self.assertEqual((row["lower"], row["upper"]), ("", ""))
            else:
                self.assertLess(float(row["lower"]), b - a)
                self.assertGreater(float(row["upper"]), b - a)
        k_theta = next(row for row in rows if (row["parameter"], row["figure"]) == ("k_theta", "crps_pct"))
        self.assertLess(float(k_theta["upper"]), 0)  # half the noise

    def test_pairs_tell_more_than_independent_sets(self):
        paired, independent = (
            {(row["parameter"], row["figure"]): row for row in read_csv(self.compare("a", other, "--csv"))}
            for other in ("b", "other_seed")
        )
        self.assertEqual({row["paired"] for row in independent.values()}, {"0"})
        for figure in ("nlpd", "crps_pct"):
            widths = [
                float(rows["k_theta", figure]["upper"]) - float(rows["k_theta", figure]["lower"])
                for rows in (paired, independent)
            ]
            self.assertLess(2 * widths[0], widths[1])
        self.assertIn(
            "The test sets are not the same (the true d_y of test sample 0 is ", self.compare("a", "other_seed")
        )
        self.assertIn("Both inferred the same 30 test samples", self.compare("a", "b"))

    def test_names_the_keys_that_differ(self):
        self.assertRegex(self.compare("a", "b"), r"\nnoise\.scale +1 +0\.5\n$")
        self.assertEqual(
            json.loads(self.compare("a", "other_seed", "--json"))["keys"], [{"key": "seed", "a": "1", "b": "2"}]
        )
        self.assertIn("The experiments are the same.", self.compare("a", "a"))

    def test_a_run_does_not_differ_from_itself(self):
        for row in read_csv(self.compare("a", "a", "--csv")):
            self.assertEqual(float(row["difference"]), 0)
            self.assertIn(row["lower"], ("0", ""))

    def test_parameters_that_only_one_run_has_are_named(self):
        self.assertIn("Only A has d_y.\n", self.compare("a", "three"))
        compared = json.loads(self.compare("three", "a", "--json"))
        self.assertEqual((compared["a"]["only"], compared["b"]["only"]), ([], ["d_y"]))
        self.assertEqual([parameter["name"] for parameter in compared["parameters"]], ["d_theta", "k_y", "k_theta"])

    def test_says_the_same_each_time(self):
        self.assertEqual(self.compare("a", "other_seed"), self.compare("a", "other_seed"))

    def test_folders_that_are_no_finished_run_are_wrong_input(self):
        run = self.folder / "a"
        self.assert_wrong_input("compare", run, message="B is required")
        self.assert_wrong_input("compare", run, run, "--csv", "--json", message="--csv excludes --json")
        self.assert_wrong_input("compare", run, self.folder / "nowhere", message="nowhere: there is no such folder")
        self.assert_wrong_input(
            "compare", self.folder, run, message="is not a folder of a run: it has no resolved.yaml"
        )
        unfinished = self.copy("a")
        (unfinished / "provenance.json").unlink()
        self.assert_wrong_input("compare", run, unfinished, message="the run in it is not finished")
        sweep = self.folder / "sweep"
        (sweep / "cases/first").mkdir(parents=True)
        self.assert_wrong_input("compare", sweep, run, message=f"name one of its cases, such as {sweep}/cases/first")

    def test_damaged_predictions_are_a_located_failure(self):
        run = self.copy("a")
        lines = (run / "predictions.csv").read_text().splitlines()
        lines[3] = lines[3].replace("k_y", "k_z")
        (run / "predictions.csv").write_text("\n".join(lines) + "\n")
        result = call("compare", self.folder / "a", run)
        self.assertEqual(result.returncode, 1)
        self.assertIn("predictions.csv:4: parameter 'k_z' must be 'k_y'", result.stderr)


class Verify(TestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.run_experiment("run")

    def verify(self, run, *options):
        """What differs by check, the digests aside, and the whole output. self.changed: what the digests say."""
        result = call("verify", run, "--seed", 1, *options)
        lines = result.stdout.splitlines()
        differing = {line[11:]: lines[i + 1].strip() for i, line in enumerate(lines) if line.startswith("  differs  ")}
        self.assertEqual(result.returncode, 1 if differing else 0, result)
        self.changed = differing.pop("files: digests in provenance.json", "")
        return differing, result.stdout + result.stderr

    def flip_bit(self, file, offset, bit=0):
        content = bytearray(file.read_bytes())
        content[offset] ^= 1 << bit
        file.write_bytes(content)

    def flip_number(self, file, dataset, index):
        """The last bit of a number."""
        with h5py.File(file) as opened:
            data = opened[dataset]
            element = int(np.ravel_multi_index(index, data.shape)) if index else 0
            offset = data.id.get_offset() + 8 * element
        self.flip_bit(file, offset)

    def change_text(self, file, line, old, new):
        lines = file.read_text().splitlines(keepends=True)
        self.assertIn(old, lines[line - 1])
        lines[line - 1] = lines[line - 1].replace(old, new)
        file.write_text("".join(lines))

    def test_a_fresh_run_passes_and_is_not_written_to(self):
        before = {path: path.stat().st_mtime_ns for path in (self.folder / "run").rglob("*")}
        differing, output = self.verify(self.folder / "run")
        self.assertEqual((differing, self.changed), ({}, ""), output)
        for part in (
            "digests",
            "parameters, names and times",
            "5 training and 5 test samples",
            "70 samples that chunks hold",
            "maps.h5",
            "predictions.csv",
            "metrics.csv",
            "joint.csv",
            "pit.csv",
            "table.md",
            "table.tex",
        ):
            self.assertIn(part, output)
        self.assertEqual({path: path.stat().st_mtime_ns for path in (self.folder / "run").rglob("*")}, before)

    def test_all_runs_everything_again(self):
        differing, output = self.verify(self.folder / "run", "--all")
        self.assertEqual(differing, {}, output)
        for file in ("samples.h5", "maps.h5", "predictions.csv", "metrics.csv", "training.csv", "failures.csv"):
            self.assertRegex(output, f"  ok +{file}\n")

    def test_a_flipped_bit_in_the_samples_is_found_and_named(self):
        run = self.copy("run")
        self.flip_number(run / "samples.h5", "train/responses", (17, 1, 33))
        differing, _ = self.verify(run, "--samples", 0)
        self.assertEqual(list(differing), ["samples.h5: responses of the 70 samples that chunks hold"])
        self.assertRegex(list(differing.values())[0], r"^training sample 17, theta\(1\.7 s\): \S+ instead of \S+$")
        shutil.rmtree(run / "chunks")
        differing, _ = self.verify(run, "--samples", 40)
        self.assertEqual(list(differing), ["samples.h5: 40 training and 30 test samples, simulated again"])
        differing, _ = self.verify(run, "--all")
        self.assertRegex(differing["samples.h5"], r"^/train/responses\[17, 1, 33\]: \S+ instead of \S+$")
        self.assertEqual(list(differing), ["samples.h5"])

    def test_flipped_bits_beside_the_responses_are_found(self):
        for dataset, index in (("test/parameters", (3, 2)), ("times", (0,)), ("parameters/lower", (1,))):
            run = self.copy("run")
            self.flip_number(run / "samples.h5", dataset, index)
            differing, output = self.verify(run, "--samples", 0)
            self.assertIn(
                f"/{dataset}", differing.get("samples.h5: parameters, names and times of all samples", output)
            )
            shutil.rmtree(run)

    def test_a_file_that_is_no_longer_hdf5_is_a_difference(self):
        for file in ("samples.h5", "maps.h5"):
            run = self.copy("run")
            self.flip_bit(run / file, 1)
            differing, output = self.verify(run)
            self.assertIn("cannot be opened as an HDF5 file" if file == "samples.h5" else "byte 1 differs", output)
            self.assertEqual([name[: len(file)] for name in differing], [file])
            shutil.rmtree(run)

    def test_a_flipped_bit_in_the_map_is_found_and_named(self):
        for dataset, index in (
            ("map/processes/3/alpha", (7,)),
            ("map/processes/1/factor", (9, 4)),
            ("map/training_inputs", (3, 5)),
            ("map/target/scale", (0,)),
            ("map/transform/0/offset", (2,)),
            ("map/residual_correlation", (1, 0)),
            ("map/processes/2/nlml", ()),
            ("trust/reference/chi_square", (5,)),
        ):
            run = self.copy("run")
            self.flip_number(run / "maps.h5", dataset, index)
            differing, output = self.verify(run)
            self.assertEqual(list(differing), ["maps.h5: fitted again"], output)
            self.assertEqual(self.changed, "maps.h5 is not as it was written")
            self.assertRegex(list(differing.values())[0], rf"^/{dataset}.*: \S+ instead of \S+$")
            shutil.rmtree(run)

    def test_a_flipped_bit_in_a_hyperparameter_is_found_and_named(self):
        run = self.copy("run")
        self.flip_number(run / "maps.h5", "map/processes/0/noise_stddev", ())
        self.verify(run)
        self.assertEqual(self.changed, "maps.h5 is not as it was written")  # too small a change for anything else
        differing, _ = self.verify(run, "--all")
        self.assertEqual(list(differing), ["maps.h5"])
        self.assertRegex(differing["maps.h5"], r"^/map/processes/0/noise_stddev: \S+ instead of \S+$")

    def test_a_changed_digit_in_a_table_is_found_and_named(self):
        for file, column in (("predictions.csv", "inferred"), ("metrics.csv", "loo_sd_pct"), ("joint.csv", "value")):
            run = self.copy("run")
            value = read_csv((run / file).read_text())[2][column]
            self.change_text(run / file, 4, value, value[:-1] + str((int(value[-1]) + 1) % 10))
            differing, output = self.verify(run)
            self.assertEqual([name.split(":")[0] for name in differing], [file], output)
            self.assertEqual(self.changed, f"{file} is not as it was written")
            self.assertRegex(list(differing.values())[0], rf"^line 4, {column}: '\S+' instead of '{value}'$")
            shutil.rmtree(run)

    def test_a_damaged_chunk_is_named(self):
        run = self.copy("run")
        chunk = sorted((run / "chunks").rglob("*.chunk"))[0]
        self.flip_bit(chunk, 1000)
        differing, _ = self.verify(run)
        self.assertEqual(self.changed, "")
        self.assertEqual(differing, {"chunks: checksums": f"{chunk.name}: its checksum is wrong"})
        self.assertTrue(chunk.exists())

    def test_an_edited_experiment_differs(self):
        run = self.copy("run")
        self.change_text(
            run / "resolved.yaml",
            1 + (run / "resolved.yaml").read_text().splitlines().index("seed: 1"),
            "seed: 1",
            "seed: 2",
        )
        self.assertIn("samples.h5: parameters, names and times of all samples", self.verify(run)[0])

    def test_a_missing_file_is_a_difference(self):
        run = self.copy("run")
        (run / "joint.csv").unlink()
        self.assertEqual(list(self.verify(run)[0]), ["joint.csv: made again"])
        self.assertEqual(self.changed, "joint.csv is missing")

    def test_another_build_is_noted(self):
        run = self.copy("run")
        provenance = json.loads((run / "provenance.json").read_text())
        provenance["libraries"]["Eigen"] = "2.0"
        (run / "provenance.json").write_text(json.dumps(provenance))
        differing, output = self.verify(run)
        self.assertEqual(differing, {})
        self.assertRegex(output, r'bits may differ: libraries\.Eigen: "2\.0" then, "\S+" now')

    def test_other_experiments_pass(self):
        self.run_experiment("whitened", "transform=[whiten, principal_components]", "noise.replicates=2")
        self.run_experiment("sparse", "inverse_map.gp.approximation=sgpr", "inverse_map.gp.inducing=20")
        chain = EXPERIMENTS / "three_mass_chain/modes.yaml"
        self.run_experiment("modes", file=chain)
        for name in ("whitened", "sparse", "modes"):
            differing, output = self.verify(self.folder / name)
            self.assertEqual(differing, {}, output)

    def test_of_a_sweep_some_cases_are_verified(self):
        sweep = self.folder / "sweep"
        for name in ("a", "b", "c", "d"):
            shutil.copytree(self.folder / "run", sweep / "cases" / name)
        _, output = self.verify(sweep)
        self.assertEqual(output.count(f"{sweep}/cases/"), 3)
        for name in ("b", "d"):  # two are enough of all
            shutil.rmtree(sweep / "cases" / name)
        self.change_text(sweep / "cases/c/metrics.csv", 2, "d_y", "d_z")
        self.assertEqual(self.verify(sweep, "--all")[0], {"metrics.csv": "line 2, parameter: 'd_z' instead of 'd_y'"})

    def test_folders_that_are_no_finished_run_are_wrong_input(self):
        self.assert_wrong_input("verify", message="DIR is required")
        self.assert_wrong_input("verify", self.folder / "nowhere", message="there is no such folder")
        self.assert_wrong_input("verify", self.folder, message="is not a folder of a run")
        self.assert_wrong_input("verify", self.folder / "run", "--samples", -1, message="--samples")
