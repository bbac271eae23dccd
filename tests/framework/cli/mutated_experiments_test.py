"""Hundreds of mutated experiment files: each is refused with the place and the rule, or means what it says and runs or
fails as a run does. Never a crash, a hang, an exhausted memory or a silent default."""
import os
import re
import resource
import shutil
import subprocess
import unittest

import yaml

import mutations
from case_turns import count_turn, take_turn
from support import EXPERIMENTS, TWINMAP, FolderTestCase

TABLE1 = EXPERIMENTS / "two_beam/table1.yaml"
# Small where the mutation does not say otherwise.
SMALL = {
    "design.train.samples": 20,
    "design.test.samples": 4,
    "evaluation.limit": "false",
    "simulation.max_steps": 3000,
    "inverse_map.gp.starts": 1,
}
CHECK_TIMEOUT, RUN_TIMEOUT, MEMORY = 60, 300, 12 << 30


def list_files():
    """(experiment file, name of the mutation, path that it touches, content)."""
    for file in sorted(EXPERIMENTS.glob("*/*.yaml")):
        # mechanisms are made of the same keys as the others, whose mutations take a minute; an FMU or program lies beside its experiment
        if file.parent.name in ("mechanisms", "fmu", "python_plant"):
            continue
        for mutation in mutations.mutate_trees(file.stem, file.read_text()):
            yield (file, *mutation)
    for mutate in (mutations.mutate_sizes, mutations.mutate_text):
        for mutation in mutate("table1", TABLE1.read_text()):
            yield (TABLE1, *mutation)


def call(*arguments, timeout):
    """A command that may take only so much memory."""
    limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    return subprocess.run([TWINMAP, *map(str, arguments)], capture_output=True, timeout=timeout, preexec_fn=limit)


def list_leaves(tree, path=()):
    if isinstance(tree, dict):
        return [leaf for key, value in tree.items() for leaf in list_leaves(value, (*path, key))]
    if isinstance(tree, list):
        return [leaf for i, value in enumerate(tree) for leaf in list_leaves(value, (*path, i))]
    return [(path, tree)]


def look_up(tree, path):
    """The value at a path; in a resolved experiment a short form (m1: 3.3, whiten) is written out."""
    for step in path:
        tree = tree[step]
    return tree.get("value", tree) if isinstance(tree, dict) else tree


def is_part(key, other):
    """Whether one of two key paths is within the other."""
    return (key + ".").startswith(other + ".") or (other + ".").startswith(key + ".")


def is_same(given, resolved):
    if isinstance(resolved, dict):
        return list(resolved) == [given]
    if isinstance(resolved, list):
        return "..".join([resolved[0], resolved[-1]]) == given
    try:
        return float(given) == float(resolved)
    except ValueError:
        return (
            given.strip() == resolved.strip()
            or resolved == str(EXPERIMENTS / given)
            or (os.path.isabs(resolved) and resolved.endswith(os.path.basename(given)))
        )


class MutatedExperiments(FolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.files = take_turn(list_files())
        cls.checked = [cls.check(number, file) for number, file in enumerate(cls.files)]

    @classmethod
    def check(cls, number, file):
        path = cls.folder / f"{number}.yaml"
        path.write_bytes(file[3])
        try:
            return path, call("check", path, timeout=CHECK_TIMEOUT)
        except subprocess.TimeoutExpired:
            return path, None

    def for_each(self, test, code=None):
        """Calls test(file, path, result) for each file, or for each with that exit code; returns their number."""
        chosen = [
            (file, *checked)
            for file, checked in zip(self.files, self.checked)
            if code is None or (checked[1] is not None and checked[1].returncode == code)
        ]
        for file, path, result in chosen:
            with self.subTest(file[1]):
                test(file, path, result)
        return len(chosen)

    def test_each_is_accepted_or_refused_in_time(self):
        def test(_file, _path, result):
            self.assertIsNotNone(result, "took too long")
            self.assertIn(result.returncode, (0, 2), result.stderr)

        self.assertGreater(self.for_each(test), count_turn(600))

    def test_refusals_name_place_and_rule(self):
        def test(_file, path, result):
            message = result.stderr.decode()
            place = re.escape(str(path)) + r"(:\d+:\d+:|: [\w.\[\]]+:|: is larger than) "
            self.assertRegex(message, f"^twinmap: error: {place}.*[a-z]{{2}}")
            self.assertLess(len(message), 1000 + len(str(path)), message[:2000])
            self.assertEqual(message.count("\n"), 1, message)

        print(self.for_each(test, 2), "of", len(self.files), "files are refused")

    def test_what_is_accepted_is_what_was_written(self):
        def test(file, _path, result):
            resolved = yaml.load(result.stdout, yaml.BaseLoader)
            # PyYAML refuses a tab before a value, which is YAML.
            content = file[3].decode("utf-8-sig").replace(":\t", ": ")
            for path, given in list_leaves(yaml.load(content, yaml.BaseLoader)):
                if given not in ([], {}):
                    self.assertTrue(is_same(given, look_up(resolved, path)), (path, given))

        # 99 of all files are accepted, 16 to 23 of a turn.
        self.assertGreater(self.for_each(test, 0), count_turn(60))

    def test_what_is_accepted_checks_as_itself(self):
        def test(_file, path, result):
            resolved = path.with_suffix(".resolved.yaml")
            resolved.write_bytes(result.stdout)
            again = call("check", resolved, timeout=CHECK_TIMEOUT)
            self.assertEqual(again.stdout, result.stdout, again.stderr)

        self.for_each(test, 0)

    def test_what_is_accepted_runs_or_fails_as_a_run_does(self):
        def test(file, path, _result):
            if "sweep" in file[2] or "sweep" in file[0].stem:
                return
            overrides = [f"{key}={value}" for key, value in SMALL.items() if not is_part(key, file[2])]
            run = path.with_suffix("")
            result = call("run", path, *overrides, "--quiet", "--out", run, timeout=RUN_TIMEOUT)
            self.assertIn(result.returncode, (0, 1, 2), result.stderr[-2000:])
            if result.returncode == 0:
                self.assertTrue((run / "metrics.csv").exists())
            else:
                self.assertRegex(result.stderr.decode(), "twinmap: error: .{20}")
                self.assertNotIn(b"bad_alloc", result.stderr)
            shutil.rmtree(run, ignore_errors=True)

        self.for_each(test, 0)
