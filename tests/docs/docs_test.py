"""Every snippet of docs/ does what it is there for; a tutorial and a how-to page has one.

Blocks of a document are run in their order, in one folder with a copy of experiments/, where `twinmap` is a command:
  sh      by bash, which ends at the first command that fails
  python  by the Python of the package, with the names of the blocks before it
  c       as a program of its own, compiled with all warnings
  yaml    which describes a whole experiment (it has features and a system or model) passes `twinmap check`
Others are not: output, a part of something, what is not for every machine. A word after the language says so
("python fragment").
"""
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ["TWINMAP_SOURCE_DIR"])
TWINMAP = Path(os.environ["TWINMAP"])
LIBRARY = Path(os.environ["TWINMAP_LIBRARY"])
PACKAGE = Path(os.environ["TWINMAP_PACKAGE"])
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
RUN = ("sh", "python", "c", "yaml")
PYTHON = "/usr/bin/python3"


def is_experiment(text):
    return re.search(r"^(system|model):", text, re.MULTILINE) and re.search(r"^features:", text, re.MULTILINE)


def find_snippets(document):
    """(language, text) of what is to be run."""
    blocks = BLOCK.findall(document.read_text())
    return [
        (language, text) for language, text in blocks if language in RUN and (language != "yaml" or is_experiment(text))
    ]


# Executes snippets that come as lines of JSON, with the names of those before.
SESSION = """
import contextlib, json, sys, traceback
names = {"__name__": "__main__"}
for line in sys.stdin:
    answer = ""
    with contextlib.redirect_stdout(sys.stderr):
        try:
            exec(json.loads(line), names)
        except Exception:
            answer = traceback.format_exc()
    print(json.dumps(answer), flush=True)
"""


class Sandbox:
    """The folder that a document's snippets work in."""

    def __init__(self, folder):
        self.folder = folder
        self.python = None
        shutil.copytree(SOURCE / "experiments", folder / "experiments", ignore=shutil.ignore_patterns("*.fmu"))
        (folder / "framework/models/fmu").mkdir(parents=True)
        shutil.copytree(SOURCE / "framework/models/fmu/headers", folder / "framework/models/fmu/headers")
        (folder / "scripts").symlink_to(SOURCE / "scripts")
        self.environment = {
            **os.environ,
            "PATH": f"{TWINMAP.parent}:{os.environ['PATH']}",
            "LD_LIBRARY_PATH": str(LIBRARY.parent),
            "PYTHONPATH": str(PACKAGE),
        }

    def call(self, *command, **options):
        result = subprocess.run(
            [str(word) for word in command],
            cwd=self.folder,
            env=self.environment,
            timeout=900,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            **options,
        )
        if result.returncode != 0:
            raise AssertionError(f"{result.stdout[-3000:]}")

    def run_sh(self, text):
        self.call("bash", "-euo", "pipefail", input=text)

    def run_python(self, text):
        if self.python is None:
            self.python = subprocess.Popen(
                [PYTHON, "-c", SESSION],
                cwd=self.folder,
                env=self.environment,
                text=True,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
            )
        self.python.stdin.write(json.dumps(text) + "\n")
        self.python.stdin.flush()
        answer = json.loads(self.python.stdout.readline())
        if answer:
            raise AssertionError(answer)

    def close(self):
        if self.python is not None:
            self.python.communicate()

    def run_c(self, text):
        (self.folder / "snippet.c").write_text(text)
        self.call(
            "cc",
            "-std=c99",
            "-Wall",
            "-Wextra",
            "-Werror",
            f"-I{SOURCE}/framework/c_api",
            "snippet.c",
            f"-L{LIBRARY.parent}",
            "-ltwinmap",
            "-lm",
            "-o",
            "snippet",
        )
        self.call("./snippet")

    def run_yaml(self, text):
        (self.folder / "snippet.yaml").write_text(text)
        self.call("twinmap", "check", "snippet.yaml")


class Docs(unittest.TestCase):
    def run_document(self, document):
        with tempfile.TemporaryDirectory(prefix="twinmap_docs_") as folder:
            sandbox = Sandbox(Path(folder))
            snippets = find_snippets(document)
            if document.parent.name in ("tutorials", "how-to"):
                self.assertTrue(snippets, f"{document.name} has nothing to run")
            if not (PACKAGE / "twinmap").is_dir() and any("import twinmap" in text for _, text in snippets):
                self.skipTest("the Python package was not built")
            try:
                for language, text in snippets:
                    with self.subTest(snippet=text.strip().split("\n")[0]):
                        getattr(sandbox, f"run_{language}")(text)
            finally:
                sandbox.close()


def add_document(document):
    name = "test_" + document.stem.replace("-", "_")
    setattr(Docs, name, lambda self: self.run_document(document))


for path in sorted((SOURCE / "docs").rglob("*.md")):
    add_document(path)
