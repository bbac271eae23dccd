"""Every status and warning has an example that produces it, and a remedy that helps (notices.yaml)."""
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import yaml
from support import TWINMAP, call

SOURCE = Path(os.environ["TWINMAP_SOURCE_DIR"])
EXAMPLES = yaml.safe_load((SOURCE / "tests/framework/cli/notices.yaml").read_text())
NOTICES = {notice["name"]: notice for notice in json.loads(call("explain", "--json").stdout)}


def make_pattern(notice):
    """What its first line looks like; of a status, its name."""
    if notice["kind"] == "status":
        return rf"\b{notice['name']}\b"
    words = [re.escape(part) for part in re.split(r"\{[^}]*\}", notice["says"])]
    return ".*".join(words) if any(words) else re.escape(notice["remedy"])


class Notices(unittest.TestCase):
    def test_every_one_is_in_the_list_of_examples_and_no_other(self):
        self.assertEqual(set(EXAMPLES), set(NOTICES))
        for name, example in EXAMPLES.items():
            self.assertTrue("run" in example or "why_none" in example, name)

    def test_every_status_that_the_code_gives_is_listed(self):
        given = set()
        for file in (SOURCE / "framework/inference").glob("*.cpp"):
            given.update(re.findall(r"emplace_back\(\"([a-z_]+)\"\)", file.read_text()))
        self.assertGreater(len(given), 4)
        self.assertLessEqual(given, set(NOTICES))

    def test_every_one_says_what_to_do_in_one_sentence_or_nothing(self):
        for name, notice in NOTICES.items():
            with self.subTest(name):
                self.assertTrue(notice["says"] and notice["cause"].endswith("."))
                self.assertLessEqual(len(re.findall(r"[.!?](?:\s|$)", notice["remedy"])), 1, notice["remedy"])

    def test_explain_finds_a_name_and_suggests_one(self):
        self.assertIn("remedy:", call("explain", "model_mismatch").stdout)
        self.assertIn("did you mean 'model_mismatch'?", call("explain", "model_mismath").stderr)
        self.assertEqual(call("explain", "model_mismath").returncode, 2)


class Examples(unittest.TestCase):
    def run_script(self, script, folder):
        environment = {**os.environ, "PATH": f"{Path(TWINMAP).parent}:{os.environ['PATH']}", "NO_COLOR": "1"}
        result = subprocess.run(
            ["bash", "-euo", "pipefail"], input=script, cwd=folder, env=environment, capture_output=True, text=True
        )
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result.stdout + result.stderr


class Statuses(Examples):
    """A test of each, added below."""


class Warnings(Examples):
    """A test of each, added below."""


def add_example(name, example):
    def test(self):
        pattern = make_pattern(NOTICES[name])
        with tempfile.TemporaryDirectory(prefix="twinmap_notice_") as folder:
            shutil.copytree(SOURCE / "experiments", Path(folder) / "experiments")
            self.assertRegex(self.run_script(example["run"], folder), pattern)
            if "remedy" in example:
                self.assertNotRegex(self.run_script(example["remedy"], folder), pattern)

    setattr(Statuses if NOTICES[name]["kind"] == "status" else Warnings, f"test_{name}", test)


for _name, _example in EXAMPLES.items():
    if "run" in _example and _name in NOTICES:
        add_example(_name, _example)


if __name__ == "__main__":
    unittest.main()
