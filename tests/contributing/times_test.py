"""scripts/times reads what Ninja and ctest leave, and scripts/stages.sh what a script's stages took."""
import importlib.machinery
import importlib.util
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ["TWINMAP_SOURCE_DIR"])
NINJA_LOG = """# ninja log v5
0\t1500\t1\tdata/CMakeFiles/twinmap_data.dir/table.cpp.o\taa
1500\t1750\t1\tdata/libtwinmap_data.a\tbb
200\t9200\t1\tdata/CMakeFiles/twinmap_data.dir/gone.cpp.o\tcc
0\t4000\t1\tCMakeFiles/twinmap_precompiled_light.dir/cmake_pch.hxx.gch\tdd
10\t2510\t2\tdata/CMakeFiles/twinmap_data.dir/Unity/unity_0_cxx.cxx.o\tee
5000\t5250\t3\tdata/CMakeFiles/twinmap_data.dir/table.cpp.o\tff
"""
JUNIT = """<?xml version="1.0" encoding="UTF-8"?>
<testsuite name="Linux-c++" tests="4" failures="1" disabled="1" skipped="0" time="7">
<testcase name="cli" classname="cli" time="5.25" status="run"><system-out>ok</system-out></testcase>
<testcase name="Gp.Trains" classname="Gp.Trains" time="0.5" status="run"/>
<testcase name="sweep" classname="sweep" time="1.5" status="fail"><failure message=""/></testcase>
<testcase name="slurm" classname="slurm" time="0" status="disabled"/>
</testsuite>
"""
# A script as scripts/test is, and what it does not tell apart from Ninja and ctest.
SCRIPT = """set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/stages.sh
stage "release: build" sleep 0.2
[ -z "${1:-}" ] || scripts/other
cp given.xml "$(junit "release: tests of tests/framework")"
stage "release: tests of tests/framework" python3 -c "raise SystemExit(${2:-0})"
"""


def load_times():
    sys.dont_write_bytecode = True  # no __pycache__ in scripts
    loader = importlib.machinery.SourceFileLoader("times", str(SOURCE / "scripts/times"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("times", loader))
    loader.exec_module(module)
    return module


class TimesTestCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="twinmap_times_")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.build = self.folder / "build/release"

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def write_build(self):
        self.write("build/release/.ninja_log", NINJA_LOG)
        objects = "build/release/data/CMakeFiles/twinmap_data.dir"
        self.write(f"{objects}/table.cpp.o", "")
        self.write(f"{objects}/Unity/unity_0_cxx.cxx.o", "")
        self.write(f"{objects}/Unity/unity_0_cxx.cxx", '#include "/x/data/a.cpp"\n#include "/x/data/b.cpp"\n')
        self.write("build/release/CMakeFiles/twinmap_precompiled_light.dir/cmake_pch.hxx.gch", "")
        self.write("build/release/data/libtwinmap_data.a", "")


class Reading(TimesTestCase):
    def setUp(self):
        super().setUp()
        self.times = load_times()
        self.write_build()

    def test_an_object_counts_by_its_last_compilation_if_it_is_still_there(self):
        found = {Path(output).name: seconds for output, seconds in self.times.read_units(self.build)}
        self.assertEqual(found, {"table.cpp.o": 0.25, "cmake_pch.hxx.gch": 4.0, "unity_0_cxx.cxx.o": 2.5})

    def test_objects_are_named_by_what_they_are_made_of(self):
        units = sorted(self.times.read_units(self.build), key=lambda unit: unit[1])
        self.assertEqual(
            [self.times.name_sources(self.build, output) for output, _ in units],
            ["twinmap_data: table.cpp", "/x/data/a.cpp and 1 more", "twinmap_precompiled_light: cmake_pch.hxx"],
        )

    def test_tests_are_those_that_ran(self):
        self.write("tests.xml", JUNIT)
        self.assertEqual(
            self.times.read_tests(self.folder / "tests.xml"),
            [("cli", 5.25, False), ("Gp.Trains", 0.5, False), ("sweep", 1.5, True)],
        )

    def test_totals_and_what_is_slowest(self):
        self.write("times/command", "scripts/test\n")
        self.write("times/stages", "release: build\t0\t3.5 6.5 0.5\nrelease: tests\t0\t4.5 5.0 1.0\nstyle\t0\t1 1 0\n")
        self.write("times/release: tests.xml", JUNIT)
        sitting = self.times.Sitting(self.folder / "times", self.folder / "build")
        expected = {
            "release: objects": (3, 6.75),
            "release: tests": (3, 7.25),
            "scripts/test: wall": (3, 9.0),
            "scripts/test: processor": (3, 14.0),
        }
        self.assertEqual(sitting.calc_totals(), expected)
        self.assertEqual(sitting.list_slowest_tests()[0], ("release: cli", 5.25))
        self.assertEqual(sitting.list_slowest_units()[1], ("release: /x/data/a.cpp and 1 more", 2.5))
        self.assertEqual(sitting.list_failures(), ["test sweep"])


class Script(TimesTestCase):
    """A script in a project of its own, whose reference is a small file."""

    def setUp(self):
        super().setUp()
        self.write("CMakeLists.txt", "project(twinmap VERSION 1.2.3 LANGUAGES CXX)\n")
        self.write("bench/times/reference.cpp", "int answer() { return 42; }\n")
        self.write("scripts/test", SCRIPT)
        self.write("scripts/other", SCRIPT.replace("release", "dev"))
        self.write("given.xml", JUNIT.replace('status="fail"', 'status="run"'))
        self.write_build()
        for name in ("times", "stages.sh"):
            shutil.copy(SOURCE / "scripts" / name, self.folder / "scripts")
        for name in ("test", "other"):
            (self.folder / "scripts" / name).chmod(0o755)

    def call(self, *command, code=0):
        environment = {name: value for name, value in os.environ.items() if name != "TWINMAP_TIMES"}
        result = subprocess.run(command, cwd=self.folder, env=environment, capture_output=True, text=True, timeout=300)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result.stdout

    def find_row(self, name, text):
        """Words behind a name at the begin of a line."""
        rows = [line[len(name) :].split() for line in text.splitlines() if line.startswith(name + " ")]
        self.assertTrue(rows, f"no row '{name}' in {text}")
        return rows

    def test_ends_with_the_table(self):
        text = self.call("bash", "scripts/test")
        wall, processor = map(float, self.find_row("release: build", text)[0])
        self.assertGreaterEqual(wall, 0.2)  # it slept as long
        self.assertLess(processor, wall)
        self.assertEqual(self.find_row("release: tests of tests/framework", text)[1][:2], ["3", "7.2"])
        self.assertIn("slowest objects", text)

    def test_stages_of_a_script_within_belong_to_it(self):
        text = self.call("bash", "scripts/test", "inner")
        names = [line.split("  ")[0] for line in text.strip().split("\n\n")[0].splitlines()[1:]]
        build, tests = "build", "tests of tests/framework"
        self.assertEqual(names, [f"release: {build}", f"dev: {build}", f"dev: {tests}", f"release: {tests}"])
        self.assertEqual(text.count("slowest objects"), 1)

    def test_a_failure_keeps_its_exit_code_and_is_named_last(self):
        text = self.call("bash", "scripts/test", "", "7", code=7)
        self.assertTrue(text.endswith("failed: stage release: tests of tests/framework\n"), text)
        self.call("python3", "scripts/times", "--keep", code=1)
        self.assertFalse((self.folder / "bench/times/last_release.json").exists())

    def test_what_was_kept_is_shown_in_seconds_of_this_machine(self):
        self.call("bash", "scripts/test")
        (self.folder / "build/times/reference").write_text("3.0")
        self.call("python3", "scripts/times", "--keep")
        kept = json.loads((self.folder / "bench/times/last_release.json").read_text())
        self.assertEqual(kept["version"], "1.2.3")
        self.assertEqual(kept["totals"]["release: objects"], [3, 6.8])
        (self.folder / "build/times/reference").write_text("6.0")  # a machine of half the speed
        text = self.call("python3", "scripts/times")
        self.assertEqual(self.find_row("release: objects", text)[0], ["3", "6.8", "13.6", "0.50"])


if __name__ == "__main__":
    unittest.main()
