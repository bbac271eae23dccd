"""Damaged recordings: each has an estimate that says what was left out, or an error that names the place; no crash, and
nothing that is `ok` is more than 5 standard deviations from the truth. TWINMAP_MUTATIONS says of how many (200),
TWINMAP_MUTATION_SEED which (7)."""
import json
import os
import random
import unittest

from case_turns import take_turn
from support import EXPERIMENTS, FolderTestCase, call

CART = EXPERIMENTS / "duffing/cart.yaml"
TRUE = {"k": 95.0, "d": 1.2, "k3": 2500.0}
MOST = 5.0  # standard deviations


def change_cell(generator, rows, change, column=None):
    row = generator.choice(rows)
    column = generator.randrange(len(row)) if column is None else column
    row[column] = change(row[column])


def break_number(generator, text):
    """A byte deleted or replaced so that no number is left."""
    i = generator.randrange(len(text))
    return text[:i] + generator.choice(["x", "..", "%", "\u00e9"]) + text[i + generator.randrange(2) :]


def swap(generator, rows):
    a, b = generator.choice(rows), generator.choice(rows)
    i, j = generator.randrange(len(a)), generator.randrange(len(b))
    a[i], b[j] = b[j], a[i]


def shuffle(generator, rows):
    first = generator.randrange(len(rows) - 3)
    part = rows[first : first + generator.randint(2, 20)]
    generator.shuffle(part)
    rows[first : first + len(part)] = part


def drop(generator, rows):
    first = generator.randrange(len(rows))
    del rows[first : first + generator.randint(1, 20)]


def change_header(generator, header):
    i = generator.randrange(len(header))
    header[i] = generator.choice(
        [header[i] + " [mm]", header[i] + "_2", "", header[i].upper(), "t", "x [s]", header[i] + " [furlongs]", "1.5"]
    )


MUTATIONS = {
    "broken": lambda g, h, r: change_cell(g, r, lambda text: break_number(g, text)),
    "emptied": lambda g, h, r: change_cell(g, r, lambda text: g.choice(["", "nan", "NA", "-"])),
    "swapped": lambda g, h, r: swap(g, r),
    "dropped": lambda g, h, r: drop(g, r),
    "doubled": lambda g, h, r: r.insert(g.randrange(len(r)), list(g.choice(r))),
    "shuffled": lambda g, h, r: shuffle(g, r),
    "stamp moved": lambda g, h, r: change_cell(g, r, lambda text: repr(float(text) + g.gauss(0, 0.2)), 0),
    "short row": lambda g, h, r: g.choice(r).pop(),
    "long row": lambda g, h, r: g.choice(r).append("1"),
    "header": lambda g, h, r: change_header(g, h),
}


class MutatedRecordings(FolderTestCase):
    def mutate(self, generator, lines):
        header, rows = lines[0].split(","), [line.split(",") for line in lines[1:]]
        names = [generator.choice(list(MUTATIONS)) for _ in range(generator.randint(1, 3))]
        for name in names:
            try:
                MUTATIONS[name](generator, header, rows)
            except (ValueError, IndexError):  # a cell that another mutation broke
                pass
        return names, "\n".join(",".join(row) for row in [header] + rows) + "\n"

    def test_have_an_estimate_or_a_located_error(self):
        clean = self.folder / "clean.csv"
        point = [f"parameters.{name}={value}" for name, value in TRUE.items()]
        result = call("simulate", CART, "--noise", "--csv", clean, *point)
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = clean.read_text().splitlines()
        generator = random.Random(int(os.environ.get("TWINMAP_MUTATION_SEED", 7)))
        files, names = [], {}
        for i in range(int(os.environ.get("TWINMAP_MUTATIONS", 200))):
            path = self.folder / f"m{i}.csv"
            names[str(path)], text = self.mutate(generator, lines)
            path.write_text(text)
            files.append(path)
        files = take_turn(files)
        seen = 0
        for first in range(0, len(files), 100):
            result = call("infer", CART, "--json", *files[first : first + 100])
            self.assertIn(result.returncode, (0, 1, 2), result.stderr)
            for line in result.stdout.splitlines():
                self.check(json.loads(line), names)
                seen += 1
        self.assertEqual(seen, len(files))

    def check(self, found, names):
        what = (names[found["source"]], found)
        if "error" in found:
            self.assertIn(found["source"], found["error"], what)
        elif found["statuses"] == ["ok"]:
            for name, true in TRUE.items():
                estimate = found["parameters"][name]
                self.assertLess(abs(estimate["mean"] - true), MOST * estimate["sd"], what)


if __name__ == "__main__":
    unittest.main()
