"""An experiment on a Slurm of two nodes, which the test starts: the same bits as in one process, whatever is lost."""
import collections
import filecmp
import json
import os
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

from slurm_node import Slurm, find_missing

TWINMAP = os.environ["TWINMAP"]
TABLE1 = Path(os.environ["TWINMAP_SOURCE_DIR"]) / "experiments/two_beam/table1.yaml"
# 6 cases, or 24 with TWINMAP_WHOLE_BARS=1; Simbody takes some ms a sample, so that jobs can be interrupted, or half a
# second, so that one job alone reaches a time limit of a minute.
WHOLE = bool(os.environ.get("TWINMAP_WHOLE_BARS"))
CASES = 24 if WHOLE else 6
SWEEP = [
    "design.train.samples=8,12,16",
    "noise.scale=0.5,1",
    "seed=1..4" if WHOLE else "seed=1..1",
    "design.test.samples=8",
    "evaluation.limit=false",
    "design.train.method=nested_latin_hypercube",
    "simulation.engine=simbody",
    "inverse_map.gp.starts=1",
]
if WHOLE:
    SWEEP += [
        "simulation.duration=50",
        "simulation.relative_tolerance=1e-10",
        "simulation.absolute_tolerance=1e-12",
        "simulation.max_steps=10000000",
        "simulation.max_wall_time=600",
    ]
TABLES = ["sweep.csv", "summary.csv", "table.md", "failed_cases.csv", "resolved.yaml"]
RESULTS = ["maps.h5", "metrics.csv", "predictions.csv", "samples.h5", "training.csv", "resolved.yaml"]


def read_points(chunk):
    data = chunk.read_bytes()
    parameters, _, samples = struct.unpack("<3Q", data[32:56])
    return [data[56 + i * 8 * parameters : 56 + (i + 1) * 8 * parameters] for i in range(samples)]


@unittest.skipIf(find_missing(), find_missing())
class OnSlurm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="twinmap_slurm_")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        (cls.folder / "slurm").mkdir()
        cls.folder.chmod(0o755)
        cls.slurm = Slurm(cls.folder / "slurm")
        cls.addClassCleanup(cls.slurm.stop)
        cls.slurm.start()
        result = subprocess.run(
            [TWINMAP, "run", TABLE1, *SWEEP, "--quiet", "--threads", "1", "--out", cls.folder / "alone"],
            capture_output=True,
            text=True,
        )
        assert result.returncode == 0, result.stderr

    def call(self, *arguments, code=0):
        result = self.slurm.call(TWINMAP, *arguments)
        self.assertEqual(result.returncode, code, result.stderr + result.stdout)
        return result.stdout + result.stderr

    def submit(self, name, *options, code=0):
        shards = () if "--shards" in options else ("--shards", "6")
        return self.call(
            "submit", TABLE1, *SWEEP, "--on", "slurm", *shards, "--out", self.folder / name, *options, code=code
        )

    def list_shards(self, name, state):
        return [
            path.stem
            for path in (self.folder / name / "cluster/shards").glob("*.json")
            if json.loads(path.read_text())[-1]["state"] == state
        ]

    def wait_for_running(self, name):
        self.slurm.wait(lambda: self.list_shards(name, "running"), "no shard begins")

    def read_logs(self, name):
        return "".join(path.read_text() for path in (self.folder / name / "cluster/log").iterdir())

    def wait_and_compare(self, name, seconds=240):
        self.slurm.wait(self.slurm.is_idle, f"{name} does not end", seconds)
        status = self.call("status", self.folder / name)
        self.assertIn(f"{CASES} of {CASES} complete, 0 failed", status, self.read_logs(name))
        self.assertNotIn("failed:", status)
        alone = self.folder / "alone"
        cases = sorted(path.name for path in (alone / "cases").iterdir())
        self.assertEqual(len(cases), CASES)
        for files, one, other in [
            (TABLES, alone, self.folder / name),
            *((RESULTS, alone / "cases" / case, self.folder / name / "cases" / case) for case in cases),
        ]:
            _, different, missing = filecmp.cmpfiles(one, other, files, shallow=False)
            self.assertEqual((different, missing), ([], []), other)
        for folder in (self.folder / name / "chunks").iterdir():
            count = collections.Counter(point for chunk in folder.glob("*.chunk") for point in read_points(chunk))
            self.assertEqual(sum(count.values()), len(count), "a sample was saved twice")

    def test_gives_the_bits_of_one_process_and_simulates_nothing_twice(self):
        self.assertIn("6 of samples", self.submit("calm"))
        self.wait_and_compare("calm")
        self.assertIn(" done", self.call("status", self.folder / "calm"))

    @unittest.skipUnless(WHOLE, "takes minutes; TWINMAP_WHOLE_BARS=1 runs it")
    def test_a_job_that_hits_its_time_limit_goes_on(self):
        self.submit("limited", "--time", "1", "--shards", "1")
        self.wait_and_compare("limited", seconds=1200)
        self.assertIn("is tried again; try 1 on n", self.read_logs("limited"))
        self.assertIn(": interrupted: interrupted: ", self.read_logs("limited"))

    def test_a_lost_node_a_time_limit_and_a_cancelled_job_change_no_bit(self):
        self.submit("rough")
        self.wait_for_running("rough")
        self.slurm.kill_node("n1")
        self.slurm.start_node("n1")
        # What Slurm sends some time before the limit, to the shell of each running job.
        self.slurm.call("scancel", "--batch", "--signal=TERM", "--state=RUNNING", "--user=root")
        self.assertIn("cancelled: ", self.call("cancel", self.folder / "rough"))
        self.slurm.wait(self.slurm.is_idle, "cancelled jobs do not end")
        self.submit("rough")
        self.wait_and_compare("rough", seconds=1200)

    def test_a_refusal_shows_the_words_of_the_scheduler(self):
        self.assertIn("invalid partition specified: nowhere", self.submit("refused", "--partition", "nowhere", code=1))


class Elsewhere(unittest.TestCase):
    def call(self, *arguments, **options):
        return subprocess.run([TWINMAP, *map(str, arguments)], capture_output=True, text=True, **options)

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="twinmap_cluster_")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.arguments = [
            TABLE1,
            "design.train.samples=20,30",
            "design.test.samples=10",
            "inverse_map.gp.starts=1",
            "--out",
            self.folder / "run",
        ]

    def test_without_slurm_one_line_says_what_is_missing(self):
        result = self.call("submit", *self.arguments, "--on", "slurm", env={"PATH": "/nowhere"})
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, r"^twinmap: error: sbatch was not found: [^\n]*\n$")

    def test_the_commands_of_local_can_be_run_by_hand_and_give_the_bits_of_a_run(self):
        local = self.call("submit", *self.arguments, "--on", "local", "--shards", "2")
        self.assertEqual(local.returncode, 0, local.stderr)
        self.assertEqual(self.call("shard", self.folder / "run", "2").returncode, 1)  # its samples are not there
        result = subprocess.run(["bash", "-euo", "pipefail"], input=local.stdout, capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr + result.stdout)
        alone = self.call("run", *self.arguments[:-1], self.folder / "alone", "--quiet")
        self.assertEqual(alone.returncode, 0, alone.stderr)
        for case in ("samples-20", "samples-30"):
            _, different, missing = filecmp.cmpfiles(
                self.folder / "run/cases" / case, self.folder / "alone/cases" / case, RESULTS, shallow=False
            )
            self.assertEqual((different, missing), ([], []))
        self.assertEqual((self.folder / "run/sweep.csv").read_bytes(), (self.folder / "alone/sweep.csv").read_bytes())
        self.assertIn("done before", self.call("shard", self.folder / "run", "0").stdout)

    def test_a_template_submits_each_shard_after_the_stage_before(self):
        queue = self.folder / "queue"
        command = f"echo '{{shard}} {{after}}' >>{queue}; echo job{{shard}}"
        result = self.call(
            "submit",
            *self.arguments,
            "--on",
            "template",
            "--shards",
            "2",
            "--submit",
            command,
            "--after",
            "-W depend=afterany:{jobs}",
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout.split(), ["job0", "job1", "job2", "job3"])
        self.assertEqual(
            queue.read_text().splitlines(), ["0 ", "1 ", "2 -W depend=afterany:job0:job1", "3 -W depend=afterany:job2"]
        )
        refused = self.call("submit", *self.arguments, "--on", "template", "--submit", "echo no room; exit 1")
        self.assertEqual(refused.returncode, 1)
        self.assertIn("no room", refused.stderr)

    def test_what_was_lost_twice_is_reported_and_not_begun_again(self):
        self.call("submit", *self.arguments, "--on", "local", "--shards", "2")
        lost = {"host": "n1", "state": "running", "reason": "", "failed_cases": []}
        shards = self.folder / "run/cluster/shards"
        shards.mkdir(exist_ok=True)
        (shards / "0.json").write_text(json.dumps([lost, lost]))
        result = self.call("shard", self.folder / "run", "0")
        self.assertEqual(result.returncode, 1)
        self.assertIn("failed twice for the same reason", result.stderr)

    def test_what_was_stopped_twice_without_progress_is_reported_too(self):
        self.call("submit", *self.arguments, "--on", "local", "--shards", "2")
        stopped = {"host": "n1", "state": "interrupted", "reason": "interrupted: 0 of 9 are kept", "failed_cases": []}
        shards = self.folder / "run/cluster/shards"
        shards.mkdir(exist_ok=True)
        further = {**stopped, "reason": "interrupted: 4 of 9 are kept"}
        (shards / "0.json").write_text(json.dumps([stopped, further]))
        (shards / "1.json").write_text(json.dumps([stopped, stopped]))
        status = self.call("status", self.folder / "run").stdout
        self.assertIn("stopped:  shard 0 (simulate), try 2 on n1: interrupted: interrupted: 4 of 9 are kept\n", status)
        self.assertRegex(status, r"shard 1 .*0 of 9 are kept; twice the same: not tried again before the next submit")
        result = self.call("shard", self.folder / "run", "0")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("shard 0 is tried again; try 2 on n1", result.stderr)
        self.assertEqual(self.call("shard", self.folder / "run", "1").returncode, 1)

    def test_a_machine_that_computes_other_bits_is_refused(self):
        self.call("submit", *self.arguments, "--on", "local", "--shards", "2")
        plan = self.folder / "run/cluster/plan.json"
        content = json.loads(plan.read_text())
        content["computed_with"] = "another build"
        plan.write_text(json.dumps(content))
        result = self.call("shard", self.folder / "run", "0")
        self.assertEqual(result.returncode, 2)
        self.assertIn("by one that computes with another build", result.stderr)
