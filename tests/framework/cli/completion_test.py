"""Completion as a shell does it: bash and zsh at a terminal, fish by its own command."""
import os
import pty
import re
import select
import shutil
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from support import TWINMAP, call

COMMANDS = re.findall(r"^  ([a-z]+)  ", call("--help").stdout, re.MULTILINE)


def list_options(command):
    return re.findall(r"^  (?:-\w,)?(--[a-z0-9-]+)", call(command, "--help").stdout, re.MULTILINE)


class Terminal:
    """An interactive shell with twinmap's completion, in a folder."""

    def __init__(self, words, folder, setup):
        self.process, self.terminal = pty.fork()
        if self.process == 0:
            os.chdir(folder)
            os.environ.update(PS1="$ ", TERM="dumb", PATH=f"{Path(TWINMAP).parent}:{os.environ['PATH']}")
            os.execvp(words[0], words)
        self.send(setup + "; echo rea''dy\n")
        self.read_until("ready")

    def send(self, text):
        os.write(self.terminal, text.encode())

    def read_until(self, expected, seconds=20):
        text, end = "", time.monotonic() + seconds
        while expected not in text and time.monotonic() < end:
            if select.select([self.terminal], [], [], 0.1)[0]:
                text += os.read(self.terminal, 65536).decode(errors="replace")
        return text

    def close(self):
        os.close(self.terminal)
        os.waitpid(self.process, 0)


class CompletionTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        (self.folder / "pendulum.yaml").touch()
        (self.folder / "results here").mkdir()

    def complete(self, words, setup, line, expected):
        terminal = Terminal(words, self.folder, setup)
        self.addCleanup(terminal.close)
        terminal.send(line + "\t")
        self.assertIn(expected, terminal.read_until(expected))

    def check_shell(self, words, setup):
        self.complete(words, setup, "twinmap verif", "twinmap verify")
        self.complete(words, setup, "twinmap run --keep", "twinmap run --keep-going")
        self.complete(words, setup, "twinmap check pend", "twinmap check pendulum.yaml")
        self.complete(words, setup, "twinmap run pendulum.yaml --out res", "--out results\\ here")
        self.complete(words, setup, "twinmap infer --set x=1 --fol", "--follow")

    def test_bash(self):
        self.check_shell(["bash", "--norc", "--noprofile", "-i"], "source <(twinmap completion bash)")

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_zsh(self):
        self.check_shell(
            ["zsh", "-f", "-i"], "autoload -Uz compinit && compinit -u -D && source <(twinmap completion zsh)"
        )

    @unittest.skipUnless(shutil.which("fish"), "fish is not installed")
    def test_fish(self):
        environment = {**os.environ, "HOME": str(self.folder), "PATH": f"{Path(TWINMAP).parent}:{os.environ['PATH']}"}

        def complete(line):
            result = subprocess.run(
                ["fish", "--no-config", "-c", f"twinmap completion fish | source; complete -C '{line}'"],
                cwd=self.folder,
                env=environment,
                capture_output=True,
                text=True,
                timeout=60,
            )
            self.assertEqual(result.stderr, "")
            return [line.split("\t")[0] for line in result.stdout.splitlines()]

        self.assertEqual(sorted(complete("twinmap ")), sorted(COMMANDS))
        self.assertIn("--keep-going", complete("twinmap run --k"))
        self.assertIn("pendulum.yaml", complete("twinmap check p"))
        self.assertEqual(complete("twinmap run pendulum.yaml --out re"), ["results here/"])

    def test_scripts_know_all_commands_and_options(self):
        self.assertGreater(len(COMMANDS), 12)
        for shell in ("bash", "zsh", "fish"):
            script = call("completion", shell).stdout
            for command in COMMANDS:
                self.assertIn(command, script)
                for option in list_options(command):
                    self.assertIn(f"-l {option[2:]} " if shell == "fish" else option, script, (shell, command))

    def test_another_shell_is_an_error(self):
        result = call("completion", "tcsh")
        self.assertEqual(result.returncode, 2)
        self.assertIn("bash", result.stderr)
