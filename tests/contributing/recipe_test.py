"""The recipes of docs/contributing: each patch still fits the tree, and what it adds works.

A recipe NAME.md says in its lines "test program: ..." and "tests: ..." which program of the build folder has the tests
that NAME.patch adds, and how they are called. The patch is applied to a copy of the sources. What contains a C++ file
that it touches is compiled there and linked with all else that is built, so that a recipe takes seconds. That holds for
patches that leave the layout of types alone which other files use; of the others, whose recipes name no program, the
test says that they fit the tree, and no more.
"""
import json
import os
import re
import shlex
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ["TWINMAP_SOURCE_DIR"])
BUILD = Path(os.environ["TWINMAP_BUILD_DIR"])
RECIPES = SOURCE / "docs/contributing"


def run(*command, cwd):
    """Output of a command that succeeds."""
    result = subprocess.run([str(word) for word in command], cwd=cwd, capture_output=True, text=True, timeout=900)
    if result.returncode != 0:
        raise AssertionError(f"{shlex.join(map(str, command))}\n{result.stdout[-3000:]}{result.stderr[-3000:]}")
    return result.stdout


def read_key(text, key):
    """The words after "key: " in a recipe; none without that line."""
    found = re.search(rf"^{key}: `(.*)`$", text, re.MULTILINE)
    return found[1].split() if found else []


def find_batches(unit):
    """(source, flags, object) of each compilation of the build that contains a file: itself, or batches of several."""
    found = []
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        source = Path(entry["file"])
        if source == SOURCE / unit or ("/Unity/" in str(source) and f'"{SOURCE / unit}"' in source.read_text()):
            words = shlex.split(entry["command"])
            precompiled = words[words.index("-include") :][:2] if "-include" in words else []
            flags = [word for word in words[: words.index("-o")] if word not in precompiled]
            found.append((source, flags, words[words.index("-o") + 1]))
    assert found, f"{unit} is not compiled"
    return found


class Recipe:
    def __init__(self, name, folder):
        self.text = (RECIPES / f"{name}.md").read_text()
        self.patch = RECIPES / f"patches/{name}.patch"
        self.folder = folder
        for part in ("framework", "kernels", "tests"):
            shutil.copytree(SOURCE / part, folder / part, ignore=shutil.ignore_patterns("__pycache__", "node_modules"))
        run("git", "apply", "--whitespace=error-all", self.patch, cwd=folder)
        self.touched = re.findall(r"^\+\+\+ b/(.*)$", self.patch.read_text(), re.MULTILINE)

    def compile(self):
        """What is compiled anew, by the name of the object in the build folder."""
        made = {}
        for unit in (name for name in self.touched if name.endswith(".cpp")):
            for source, flags, built in find_batches(unit):
                copy = self.folder / f"batch_{len(made)}.cpp"
                text = source.read_text() if "/Unity/" in str(source) else f'#include "{SOURCE / unit}"\n'
                copy.write_text(text.replace(f"{SOURCE}/", f"{self.folder}/"))
                if built not in made:
                    words = [word.replace(f"-I{SOURCE}", f"-I{self.folder}") for word in flags]
                    made[built] = copy.with_suffix(".o")
                    run(*words, "-O1", "-o", made[built], "-c", copy, cwd=BUILD)
        return made

    def link(self, program, made):
        """The program with new objects in the place of its own, and in front of those of the libraries it uses."""
        commands = run("ninja", "-C", BUILD, "-t", "commands", program, cwd=BUILD).splitlines()
        words = shlex.split(commands[-1].split("&&")[1])
        linked = self.folder / program
        words[words.index("-o") + 1] = str(linked)
        libraries = {str(Path(word).parent) for word in words if word.endswith(".a") and not word.startswith("/")}
        front = [new for built, new in made.items() if built.split("/CMakeFiles/")[0] in libraries]
        words = [str(made.get(word, word)) for word in words]
        run(words[0], "-Wl,-z,muldefs", *front, *words[1:], cwd=BUILD)
        return linked


class RecipeTest(unittest.TestCase):
    def check(self, name):
        if not read_key((RECIPES / f"{name}.md").read_text(), "test program"):
            run("git", "apply", "--check", "--whitespace=error-all", RECIPES / f"patches/{name}.patch", cwd=SOURCE)
            return
        with tempfile.TemporaryDirectory(prefix="twinmap_recipe_") as folder:
            recipe = Recipe(name, Path(folder))
            made = recipe.compile()
            (program,), (tests,) = read_key(recipe.text, "test program"), read_key(recipe.text, "tests")
            output = run(recipe.link(program, made), f"--gtest_filter={tests}", cwd=folder)
            self.assertRegex(output, r"\[  PASSED  \] [1-9]\d* test")


def add_recipe(name):
    setattr(RecipeTest, f"test_{name}", lambda self: self.check(name))


for patch in sorted((RECIPES / "patches").glob("*.patch")):
    add_recipe(patch.stem)
