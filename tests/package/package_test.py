"""The Debian package of the build that is tested: what is in it, and that it works from where it is unpacked."""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "framework/cli"))
from support import EXPERIMENTS, call  # noqa: E402

BUILD = Path(os.environ["TWINMAP_BUILD_DIR"])


def run(*command, **options):
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=600, **options)
    if result.returncode != 0:
        raise RuntimeError(f"{command}: {result.stdout}{result.stderr}")
    return result.stdout


class PackageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory(prefix="twinmap_package_")
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        run("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", cls.folder / "made")
        cls.package = next((cls.folder / "made").glob("*.deb"))
        cls.root = cls.folder / "root"
        run("dpkg-deb", "-x", cls.package, cls.root)
        cls.program = cls.root / "usr/bin/twinmap"

    def test_works_from_where_it_is_unpacked(self):
        experiment = next(self.root.rglob("table1.yaml"))
        output = run(self.program, "check", experiment)
        self.assertIn("two_beam_table1", output)

    @unittest.skipUnless(shutil.which("qemu-x86_64"), "qemu-x86_64 is not installed")
    def test_says_what_an_older_processor_lacks(self):
        loads = ["/usr/bin/python3", "-c", "import ctypes, sys; ctypes.CDLL(sys.argv[1])"]
        libraries = [*self.root.rglob("libtwinmap.so.0"), *self.root.rglob("_twinmap*.so")]
        self.assertTrue(libraries)
        for command in ([self.program, "--version"], *([*loads, library] for library in libraries)):
            result = subprocess.run(
                ["qemu-x86_64", "-cpu", "Nehalem", *map(str, command)], capture_output=True, text=True, timeout=600
            )
            self.assertEqual(result.returncode, 1, command)
            self.assertIn("twinmap: error: this processor lacks AVX2", result.stderr)

    def test_has_a_page_for_every_command(self):
        if not shutil.which("help2man"):
            self.skipTest("help2man is not installed")
        pages = {path.name for path in (self.root / "usr/share/man/man1").iterdir()}
        commands = re.findall(r"^  ([a-z]+)  ", call("--help").stdout, re.MULTILINE)
        self.assertEqual(pages, {"twinmap.1.gz", *(f"twinmap-{command}.1.gz" for command in commands)})
        for page in (self.root / "usr/share/man/man1").iterdir():
            name = page.name[: -len(".1.gz")]
            text = run("gzip", "-dc", page)
            self.assertRegex(text, rf"(?m)^\.TH {name.upper()} ")
            self.assertRegex(text, rf"(?m)^{name} \\- [a-z]")

    def test_completes_and_explains(self):
        share = self.root / "usr/share"
        for path, shell in (
            ("bash-completion/completions/twinmap", "bash"),
            ("zsh/vendor-completions/_twinmap", "zsh"),
            ("fish/vendor_completions.d/twinmap.fish", "fish"),
        ):
            self.assertEqual((share / path).read_text(), call("completion", shell).stdout)
        self.assertIn("properties", json.loads((share / "twinmap/experiment.schema.json").read_text()))

    def test_has_what_the_source_tree_has_for_users(self):
        documents = self.root / "usr/share/doc/twinmap"
        for path in EXPERIMENTS.rglob("*.yaml"):
            self.assertTrue((documents / "examples/experiments" / path.relative_to(EXPERIMENTS)).is_file(), path)
        for name in ("copyright", "changelog.gz", "CHANGELOG.md", "README.md", "docs/reference/experiment-file.md"):
            self.assertTrue((documents / name).is_file(), name)
        self.assertTrue(list(self.root.rglob("twinmap.h")) and list(self.root.rglob("libtwinmap.so.0")))
        self.assertTrue(list(self.root.rglob("twinmap.pc")))

    def test_names_the_libraries_that_it_needs(self):
        depends = run("dpkg-deb", "-f", self.package, "Depends")
        for name in ("libsimbody", "libgomp", "libc6"):
            self.assertIn(name, depends)

    @unittest.skipUnless(shutil.which("lintian"), "lintian is not installed")
    def test_is_one_without_errors_to_lintian(self):
        result = subprocess.run(
            ["lintian", "--allow-root", "--fail-on", "error", str(self.package)], capture_output=True, text=True
        )
        self.assertEqual(result.returncode, 0, result.stdout)
