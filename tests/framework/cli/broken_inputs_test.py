"""Broken experiments and recordings, drawn with a fixed seed: the first line that says what is wrong names the cause,
each time. TWINMAP_BROKEN says of how many (each kind once), TWINMAP_BROKEN_SEED which (2026); TWINMAP_BROKEN_SHOW prints the lines."""
import os
import random
import re
import subprocess
import unittest
from functools import partial

import yaml

from broken_inputs import (
    BEAM_FAULTS,
    EXPERIMENT_FAULTS,
    FILE_FAULTS,
    MACHINES,
    ROW_FAULTS,
    TEXT_FAULTS,
    load,
    read_rows,
)
from broken_machines import MACHINE_FAULTS
from broken_tables import TABLE_FAULTS, TABLE_FILE_FAULTS, TWO_COLUMN_FAULTS
from case_turns import take_turn
from support import EXPERIMENTS, TWINMAP, FolderTestCase

CART, BEAMS = MACHINES[:2]


def find_first_line(result):
    """Of an error its own; of a checked experiment the first; of a status what is left out, else the line that explains
    it."""
    if result.stderr.startswith("twinmap: error"):
        return result.stderr.splitlines()[0]
    lines = result.stdout.splitlines()
    if lines and lines[0].startswith("# "):
        return lines[0]
    said = [line for line in lines[1:] if line.startswith("  left out")]
    said += [line for line in lines[1:] if re.match(r"  \w+: ", line)]
    return said[0] if said else (lines or [""])[0] + result.stderr


def get_file(machine):
    return EXPERIMENTS / f"{machine}.yaml"


def write_rows(path, rows):
    lines = [",".join(cell if isinstance(cell, str) else repr(cell) for cell in row) for row in rows]
    path.write_text("\n".join(lines) + "\n")


class BrokenInputs(FolderTestCase):
    """Each of break_...() takes a fault, a generator and a path, writes there what is broken, and returns the cause and the
    command's arguments."""

    def run_command(self, *arguments):
        return subprocess.run([TWINMAP, *map(str, arguments)], capture_output=True, text=True, timeout=600)

    def record(self, machine):
        """A simulated recording of the machine."""
        path = self.folder / (machine.replace("/", "_") + ".csv")
        if not path.exists():
            result = self.run_command("simulate", get_file(machine), "--noise", "--csv", path)
            self.assertEqual(result.returncode, 0, result.stderr)
        return path

    def break_experiment(self, fault, generator, path):
        for machine in generator.sample(MACHINES, len(MACHINES)):
            tree = load(machine)
            try:
                cause = fault(generator, tree)
            except (KeyError, IndexError, StopIteration, TypeError):  # the machine has nothing of the kind
                continue
            path.write_text(yaml.safe_dump(tree, sort_keys=False))
            return cause, ("check", path)
        raise AssertionError(f"{fault.__name__}: fits no machine")

    def break_text(self, fault, generator, path):
        _, edit, cause = fault
        path.write_bytes(edit(get_file(generator.choice(MACHINES)).read_bytes()))
        return cause, ("check", path)

    def break_rows(self, fault, generator, path, machines=(CART, BEAMS)):
        machine = generator.choice(machines)
        rows = read_rows(self.record(machine))
        cause = fault(generator, rows)
        write_rows(path, rows)
        return cause, ("infer", get_file(machine), path)

    def break_file(self, fault, _generator, path):
        _, edit, cause = fault
        path.write_bytes(edit(self.record(CART).read_text()))
        return cause, ("infer", get_file(CART), path)

    def forget_experiment(self, _generator, path):
        return "does not exist", ("check", path)

    def forget_recording(self, _generator, path):
        return f"{path.name}.*does not exist", ("infer", get_file(CART), path)

    def jump(self, _generator, path):
        path = path.with_suffix(".yaml")
        path.write_text(get_file(CART).read_text().replace("F - k3 * x^3", "F - k3 * x^3 - 0.5 * sign(x_dot)"))
        return r"sign\(x_dot\) jumps: give this term as friction", ("infer", path, self.record(CART))

    def list_faults(self):
        """(name, extension of what is broken, break_...() of the fault)"""
        faults = [
            ("no such experiment", ".yaml", self.forget_experiment),
            ("no such recording", ".csv", self.forget_recording),
            ("sign in a force", ".yaml", self.jump),
        ]
        faults += [
            (fault.__name__, ".yaml", partial(self.break_experiment, fault))
            for fault in EXPERIMENT_FAULTS + MACHINE_FAULTS
        ]
        faults += [(fault[0], ".yaml", partial(self.break_text, fault)) for fault in TEXT_FAULTS]
        faults += [(fault.__name__, ".csv", partial(self.break_rows, fault)) for fault in ROW_FAULTS + TABLE_FAULTS]
        for fault in BEAM_FAULTS + TWO_COLUMN_FAULTS:
            faults.append((fault.__name__, ".csv", partial(self.break_rows, fault, machines=[BEAMS])))
        for fault in FILE_FAULTS + TABLE_FILE_FAULTS:
            faults.append((fault[0], ".csv", partial(self.break_file, fault)))
        return faults

    def test_first_line_names_the_cause(self):
        generator = random.Random(int(os.environ.get("TWINMAP_BROKEN_SEED", 2026)))
        count = int(os.environ.get("TWINMAP_BROKEN", len(self.list_faults())))
        faults, drawn = self.list_faults(), []
        while len(drawn) < count:  # each once before any comes again
            drawn += generator.sample(faults, len(faults))
        broken = [
            (name, *break_one(generator, self.folder / f"{number}{extension}"))
            for number, (name, extension, break_one) in enumerate(drawn[:count])
        ]
        for name, cause, arguments in take_turn(broken):
            result = self.run_command(*arguments)
            line = find_first_line(result)
            if "TWINMAP_BROKEN_SHOW" in os.environ:
                print(f"{name}: {line.replace(str(self.folder), '')}", flush=True)
            with self.subTest(fault=name, command=" ".join(map(str, arguments))):
                self.assertIn(result.returncode, (0, 1, 2), result.stderr)
                self.assertRegex(line, cause)


if __name__ == "__main__":
    unittest.main()
