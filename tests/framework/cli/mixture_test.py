"""A network whose answers are mixtures, on a rotor whose unbalance may lie on either side of its axis."""
import filecmp
import json
import shutil
import unittest

from support import EXPERIMENTS, OwnFolderTestCase, call, read_csv, run_once, write_csv

ROTOR = EXPERIMENTS / "mechanisms/unbalanced_rotor.yaml"
SMALL = ["design.train.samples=1000", "design.test.samples=400", "evaluation.limit=false"]
QUICK = "inverse_map={network: {head: mixture, samples_from: simulations, steps: 2500, hidden: [32, 32]}}"
MIRRORED = ["design.train.samples=200", "design.test.samples=100"]
SHORT = QUICK.replace("2500", "60")
OFFSET = 0.06


class Mixture(OwnFolderTestCase):
    def measure(self):
        file = self.folder / "measured.csv"
        self.assertEqual(call("simulate", ROTOR, f"parameters.offset={OFFSET}", "--csv", file).returncode, 0)
        return file

    def infer(self, run, *arguments):
        result = call("infer", run, self.measure(), *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def test_intervals_are_calibrated_and_the_run_warns_of_multimodal_estimates(self):
        run, result = run_once(ROTOR, *SMALL, QUICK)
        self.assertIn("fraction of the test samples with several separate estimates: offset", result.stderr)
        self.assertNotIn("the measurement reduces the uncertainty by only", result.stderr)
        for row in read_csv(run / "metrics.csv"):
            self.assertGreater(float(row["coverage95"]), 0.91, row["parameter"])
            self.assertTrue(0.4 < float(row["coverage50"]) < 0.66, row)
        weights = {}
        for row in read_csv(run / "components.csv"):
            if row["parameter"] == "offset":
                weights.setdefault(row["sample"], []).append(float(row["weight"]))
        self.assertEqual(len(weights), 400)
        for sample, of_sample in weights.items():
            self.assertEqual(len(of_sample), 3, sample)
            self.assertAlmostEqual(sum(of_sample), 1.0, places=12)

    def test_inferring_gives_both_answers(self):
        run, _ = run_once(ROTOR, *SMALL, QUICK)
        answer = json.loads(self.infer(run, "--json"))
        self.assertEqual(answer["statuses"], ["multimodal"])
        intervals = answer["parameters"]["offset"]["intervals95"]
        self.assertEqual(len(intervals), 2)
        for (lower, upper), truth in zip(intervals, (-OFFSET, OFFSET)):
            self.assertTrue(lower < truth < upper, intervals)
        self.assertEqual(answer["parameters"]["offset"]["lower"], intervals[0][0])
        self.assertEqual(answer["parameters"]["offset"]["upper"], intervals[1][1])
        self.assertEqual(len(answer["parameters"]["k"]["intervals95"]), 1)
        self.assertAlmostEqual(sum(one["weight"] for one in answer["components"]), 1.0, places=12)
        mean = sum(one["weight"] * one["parameters"]["offset"]["mean"] for one in answer["components"])
        self.assertAlmostEqual(answer["parameters"]["offset"]["mean"], mean, places=12)
        text = self.infer(run)
        self.assertIn("multimodal, several parameter values may fit:", text)
        self.assertRegex(text, r"-0\.0\d+ \.\. -0\.0\d+, 0\.0\d+ \.\. 0\.0\d+")

    def test_refining_from_one_answer_is_not_accepted(self):
        run, _ = run_once(ROTOR, *SMALL, QUICK)
        answer = json.loads(self.infer(run, "--refine", "--json"))
        self.assertEqual(answer["method"], "posterior")
        self.assertEqual(answer["refined"]["status"], "multimodal")
        self.assertEqual(answer["statuses"], ["multimodal"])
        self.assertEqual(len(answer["parameters"]["offset"]["intervals95"]), 2)
        for component, truth in zip(
            sorted(answer["components"], key=lambda one: one["parameters"]["offset"]["mean"]), (-OFFSET, OFFSET)
        ):
            found = component["parameters"]["offset"]
            self.assertLess(abs(found["mean"] - truth), 4 * found["sd"])
        refined = self.folder / "refined"
        result = call("run", ROTOR, *SMALL, QUICK, "design.test.samples=60", "refine=always", "--out", refined)
        self.assertEqual(result.returncode, 0, result.stderr)
        statuses = [row["status"] for row in read_csv(refined / "refined.csv")]
        self.assertGreater(statuses.count("multimodal"), 40)
        answers = read_csv(refined / "refined.csv")
        self.assertEqual({row["answer"] for row in answers if row["status"] == "multimodal"}, {"posterior"})
        rows = [row for row in read_csv(refined / "components.csv") if row["parameter"] == "k"]
        several = sum(row["statuses"] == "multimodal" for row in answers)
        self.assertEqual(len(rows), 2 * several + 60 - several)
        self.assertGreater(several, 40)

    def test_the_table_judges_what_infer_gives(self):
        run, result = run_once(ROTOR, "inverse_map=surrogate", "refine=automatic", *MIRRORED)
        for row in read_csv(run / "metrics.csv"):
            self.assertGreater(float(row["coverage95"]), 0.85, row)  # 100 samples: one of 10000 is below by chance
            self.assertLess(float(row["ratio_to_limit"]), 1.3, row)
        answers = {row["sample"]: row for row in read_csv(run / "refined.csv")}
        not_ok = sum(row["statuses"] != "ok" for row in answers.values()) / len(answers)
        self.assertGreater(not_ok, 0.5)
        self.assertAlmostEqual(float(read_csv(run / "metrics.csv")[0]["not_ok"]), not_ok, 12)
        self.assertIn(f"Not ok by infer: {100 * not_ok:.3g} % of the test samples (multimodal", result.stdout)
        components = [row for row in read_csv(run / "components.csv") if row["parameter"] == "offset"]
        responses = read_csv(run / "responses.csv")
        for case in ("best", "median", "worst"):
            rows = [row for row in responses if row["case"] == case]
            columns = [[float(row[name]) for row in rows] for name in ("time", "measured")]
            write_csv(self.folder / "case.csv", ["t", "angle"], columns)
            answer = json.loads(call("infer", run, self.folder / "case.csv", "--json").stdout)
            sample = rows[0]["sample"]
            self.assertEqual(answers[sample]["answer"], answer["method"], case)
            self.assertEqual(answers[sample]["statuses"], "; ".join(answer["statuses"]), case)
            of_table = sorted(float(row["mean"]) for row in components if row["sample"] == sample)
            of_infer = sorted(one["parameters"]["offset"]["mean"] for one in answer.get("components", []))
            for mean, inferred in zip(of_table, of_infer):
                self.assertAlmostEqual(mean, inferred, 9)
        self.assertEqual(call("verify", run).returncode, 0)

    def test_a_replay_draws_from_both(self):
        run, _ = run_once(ROTOR, *SMALL, QUICK)
        result = call("replay", run, self.measure(), "--out", self.folder / "replay")
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_the_report_draws_each_answer_and_runs_are_compared_by_them(self):
        run, _ = run_once(ROTOR, *SMALL, QUICK)
        self.assertIn("Estimates against true", (run / "report.html").read_text())
        copy = self.folder / "copy"
        shutil.copytree(run, copy)
        (copy / "components.csv").unlink()
        result = call("compare", run, copy, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        offset = json.loads(result.stdout)["parameters"][0]
        figures = offset.get("figures", offset)
        metrics = read_csv(run / "metrics.csv")[0]
        self.assertAlmostEqual(figures["coverage95"]["a"], float(metrics["coverage95"]), places=12)
        self.assertLess(figures["nlpd"]["a"], figures["nlpd"]["b"] - 0.5)

    def test_results_do_not_depend_on_the_threads_and_are_verified(self):
        runs = [self.folder / f"threads{n}" for n in (1, 3)]
        for run, threads in zip(runs, ("1", "3")):
            result = call("run", ROTOR, *SMALL, SHORT, "--threads", threads, "--out", run)
            self.assertEqual(result.returncode, 0, result.stderr)
        names = ["components.csv", "predictions.csv", "metrics.csv", "joint.csv"]
        self.assertEqual(filecmp.cmpfiles(*runs, names, shallow=False), (names, [], []))
        result = call("verify", runs[0])
        self.assertEqual(result.returncode, 0, result.stderr + result.stdout)

    def test_exporting_is_refused(self):
        run, _ = run_once(ROTOR, *SMALL, QUICK)
        result = call("export", run, "--c", self.folder / "c")
        self.assertEqual(result.returncode, 1)
        self.assertIn("mixtures cannot be exported", result.stderr)

    def test_the_number_of_components_is_checked(self):
        result = call("check", ROTOR, "inverse_map={network: {head: mixture, components: 5}}")
        self.assertEqual(result.returncode, 2)
        self.assertIn("must be a whole number from 2 to 4", result.stderr)
