"""scripts/hooks format what is committed and nothing else; formatters that are easily told apart stand for the real ones."""
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ["TWINMAP_SOURCE_DIR"])
# Drops spaces at the ends of lines; refuses what says so.
FORMATTER = """#!/bin/sh
text=$(cat)
case "$text" in *unreadable*) exit 1 ;; esac
printf '%s\\n' "$text" | sed 's/ *$//'
"""
INSTALL = "#!/bin/sh\necho install ok installed\n"  # dpkg-query, of any package


@unittest.skipUnless(shutil.which("git"), "git is not installed")
class Hooks(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="twinmap_hooks_")
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name) / "clone"
        self.tools = Path(folder.name) / "tools"
        self.tools.mkdir()
        for name, text in (
            ("clang-format", FORMATTER),
            ("black", FORMATTER),
            ("codespell", "#!/bin/sh\n"),
            ("dpkg-query", INSTALL),
        ):
            (self.tools / name).write_text(text)
            (self.tools / name).chmod(0o755)
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
        self.environment["PATH"] = f"{self.tools}:{self.environment['PATH']}"
        self.environment["HOME"] = folder.name  # no settings but the clone's
        shutil.copytree(SOURCE / "scripts", self.root / "scripts", ignore=shutil.ignore_patterns("__pycache__"))
        self.git("init", "--quiet")
        self.git("config", "user.name", "A")
        self.git("config", "user.email", "a@b")
        self.run_command("scripts/install-dependencies", "style")
        self.write("a.cpp", "int a;\nint b;\nint c;\nint d;\n")
        self.commit("-a")

    def run_command(self, *command, code=0):
        result = subprocess.run(command, cwd=self.root, env=self.environment, capture_output=True, text=True)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result.stdout + result.stderr

    def git(self, *arguments, code=0):
        return self.run_command("git", *arguments, code=code)

    def commit(self, *arguments, code=0):
        self.git("add", "--intent-to-add", "a.cpp")
        return self.git("commit", "--quiet", "-m", "Add something", *arguments, code=code)

    def write(self, name, text):
        (self.root / name).write_text(text)

    def test_what_is_committed_is_formatted_there_and_in_the_folder(self):
        self.write("a.cpp", "int a; \n")
        self.write("b.py", "b = 1  \n")
        self.git("add", "b.py")
        self.assertIn("formatted a.cpp", self.commit("-a"))
        for name, text in (("a.cpp", "int a;\n"), ("b.py", "b = 1\n")):
            self.assertEqual(self.git("show", f"HEAD:{name}"), text)
            self.assertEqual((self.root / name).read_text(), text)
        self.assertEqual(self.git("status", "--short", "--untracked-files=no"), "")

    def test_what_is_not_staged_stays_as_it_is(self):
        self.write("a.cpp", "int a;  \nint b;\nint c;\nint d;\n")
        self.git("add", "a.cpp")
        self.write("a.cpp", "int a;  \nint b;\nint c;\nint d;  \n")
        self.commit()
        self.assertEqual(self.git("show", "HEAD:a.cpp"), "int a;\nint b;\nint c;\nint d;\n")
        self.assertEqual((self.root / "a.cpp").read_text(), "int a;  \nint b;\nint c;\nint d;  \n")

    def test_of_single_files_the_second_commit_passes(self):
        self.write("a.cpp", "int a;  \n")
        self.assertIn("commit again", self.commit("a.cpp", code=1))
        self.assertEqual((self.root / "a.cpp").read_text(), "int a;\n")
        self.commit("a.cpp")
        self.assertEqual(self.git("status", "--short", "--untracked-files=no"), "")

    def test_what_cannot_be_formatted_is_not_committed(self):
        self.write("a.cpp", "unreadable\n")
        self.assertIn("a.cpp is not formatted", self.commit("-a", code=1))

    def test_without_formatters_it_says_so_and_commits(self):
        for name in ("clang-format", "black", "codespell"):
            (self.tools / name).unlink()
        needed = ("bash", "sh", "git", "env", "python3", "cut", "grep", "head", "sed", "cat")
        for name in needed:
            (self.tools / name).symlink_to(shutil.which(name, path="/usr/bin:/bin"))
        self.environment["PATH"] = str(self.tools)
        self.write("a.cpp", "int a; \n")
        self.assertIn("clang-format is missing", self.commit("-a"))

    def test_subjects_and_words_are_checked(self):
        self.write("a.cpp", "int a;\n")
        self.git("commit", "--quiet", "-a", "-m", "added something", code=1)
        self.write("a.cpp", "// the grav" "est\n")  # of scripts/words.txt
        self.assertIn("most severe", self.commit("-a", code=1))

    def test_hooks_of_ones_own_are_left_alone(self):
        self.git("config", "--unset", "core.hooksPath")
        self.write(".git/hooks/pre-push", "#!/bin/sh\n")
        self.run_command("scripts/install-dependencies", "style")
        self.git("config", "core.hooksPath", code=1)


if __name__ == "__main__":
    unittest.main()
