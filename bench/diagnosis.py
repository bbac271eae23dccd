#!/usr/bin/env python3
"""Holds `twinmap diagnose` to its bars on mechanisms of different kinds and writes a page.

Usage: bench/diagnosis.py STUDY [--terms N] [--tests N] [--nothing N] [--gusts N] [--pairs N] [--mechanism NAME ...] [--logs DIR] --out FILE

STUDY is the program diagnosis_study (bench/framework/diagnosis); diagnosis_cost lies beside it. Of each mechanism, N terms that its recordings can show,
spread evenly over the list of candidates, are missing from the model in turn, by 1.2 to 30 times chi-square; and nothing is.
Then a random force acts on each coordinate in turn, and two terms of unlike kinds are missing together. --logs keeps what STUDY prints of each term, and takes what is there
already instead of running it again.
"""
import argparse
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MECHANISMS = [
    "bench/framework/diagnosis/oscillator.yaml",
    "experiments/duffing/cart.yaml",
    "experiments/two_beam/table1.yaml",
    "experiments/mechanisms/double_pendulum_mild.yaml",
    "experiments/mechanisms/cubic_chain.yaml",
    "experiments/mechanisms/end_stops.yaml",
    "experiments/mechanisms/released_pendulum.yaml",
    "experiments/mechanisms/spatial_arm.yaml",
    "experiments/crane/crane.yaml",
    "experiments/mechanisms/stick_slip.yaml",
    "experiments/mechanisms/dry_belt.yaml",
    "experiments/mechanisms/unbalanced_rotor.yaml",
    "bench/framework/diagnosis/gantry.yaml",
    "bench/framework/diagnosis/sprung_beam.yaml",
    "bench/framework/diagnosis/geared_motor.yaml",
    "bench/framework/diagnosis/two_joint_arm.yaml",
    "bench/framework/diagnosis/rotary_pendulum.yaml",
    "bench/framework/diagnosis/flexible_joint.yaml",
    "bench/framework/diagnosis/half_car.yaml",
]
LINE = re.compile(
    r"(?P<term>\S+)\s+(?P<tests>\d+) chi2/n\s+(?P<ratio>\S+) first\s+(?P<first>\d+) tied\s+(?P<tied>\d+) "
    r"nothing\s+(?P<nothing>\d+) alike (?P<alike_named>\d+)/(?P<alike>\d+) second (?P<advised>\d+) apart (?P<apart>\d+) "
    r"alone (?P<alone>\d+) "
    r"\| held (?P<before>[\d. ]*) -> (?P<after>[\d. ]*) \| worst z \S+ -> \S+ \| (?P<seconds>\S+) s"
    r"( \| scaled (?P<scaled>[\d. ]*))? \| ?(?P<found>.*)"
)
SHAPES = ["drag.x", "coulomb.x", "quintic_spring.x", "delay.F", "hysteresis.x", "hidden_mode.x"]
SHAPE_TESTS = 8
SHAPE_HEAD = f"""
## Intervals that hold

Of the oscillator's m, d, k and k3, share of {SHAPE_TESTS} machines: with the noise alone, with the residual's variance in its place (as
identification without a known noise has it, such as mujoco.sysid), and after the diagnosis.

| the truth has | chi-square / n | first or tied | noise alone | residual scaled | after |
|---|--:|--:|---|---|---|
"""
PAIRS = {
    "bench/framework/diagnosis/oscillator.yaml": "coulomb.x+delay.F",
    "experiments/duffing/cart.yaml": "drag.x+lag.F",
    "experiments/mechanisms/double_pendulum_mild.yaml": "drag.a1+delay.F",
    "experiments/crane/crane.yaml": "coulomb.y+delay.theta",
    "bench/framework/diagnosis/two_joint_arm.yaml": "coulomb.q1+coulomb.q2",
    "bench/framework/diagnosis/rotary_pendulum.yaml": "coulomb.phi+delay.alpha",
    "bench/framework/diagnosis/flexible_joint.yaml": "coulomb.hub+lag.tau",
    "bench/framework/diagnosis/half_car.yaml": "coulomb.z+gain.th",
}
PAIRS_HEAD = """
## Two terms of unlike kinds

Both are missing, each of 1.2 to 30 times the model's chi-square alone. Both named: as found, tied, or in the place of what was found.

| mechanism | the truth has | both named | found most often | coverage before | after | s |
|---|---|--:|---|--:|--:|--:|
"""
COST_HEAD = """
## What all scores cost

From one recording, milliseconds of a processor, the median of seven: candidates without states, then all of them.

| mechanism | without states | ms | all | ms |
|---|--:|--:|--:|--:|
"""
COST = re.compile(
    r"(?P<file>\S+)\s+without states\s+(?P<plain>\d+)\s+(?P<plain_ms>\S+) ms, all\s+(?P<all>\d+)\s+(?P<all_ms>\S+) ms"
)
MISSED_HEAD = """
## Not named each time

With what stood first in their place, and how often ("-": nothing).

| mechanism | the truth has | named | first |
|---|---|--:|---|
"""
HEAD = """# What a model lacks, measured

Written by `bench/diagnosis.py STUDY`: machines drawn from the bounds that have one term more than the model, of 1.2 to 30 times its
chi-square, each measured once and diagnosed ([how](../how-to/find-what-a-model-lacks.md)). Machines and noise differ from term to term; a share
p of n cases has a standard error of the root of p(1-p)/n. First or tied: the term is named, alone or among
those that one test does not tell apart. Alike: of the cases in which some other term does the same to within what evidence could tell,
those in which the missing one is named among several. Second test: of those whose advice is one of another amplitude, those in which
both together name the missing term and rule out all that it was tied with; alone: and name no other either. Random force: named as a force
on its coordinate. Coverage: share of the true parameters within their 95 % intervals, of the model alone and after the diagnosis. Time: of
a processor, a diagnosis with both posteriors.

"""


def run(study, file, terms, tests, logs=None):
    lines = []
    for term in terms or [None]:
        log = logs and logs / f"{Path(file).stem}-{term or 'visible'}-{tests}.log"
        if log and log.exists():
            lines += log.read_text().splitlines()
            continue
        command = [study, str(ROOT / file), str(tests), "1"] + ([term] if term else [])
        printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        if log:
            log.write_text(printed)
        lines += printed.splitlines()
    return [m.groupdict() for m in map(LINE.match, lines) if m]


def choose(names, count):
    """Spread over the list, ambiguous ones included."""
    names = [name for name in names if name != "none" and not name.startswith("process.")]
    return [names[int((i + 0.5) * len(names) / count)] for i in range(min(count, len(names)))]


def mean(text):
    values = [float(v) for v in text.split()]
    return sum(values) / len(values) if values else float("nan")


def share(rows, key):
    return sum(int(r[key]) for r in rows), sum(int(r["tests"]) for r in rows)


def coverage(rows, key):
    tests = sum(int(r["tests"]) for r in rows)
    return sum(int(r["tests"]) * mean(r[key]) for r in rows) / max(1, tests)


def of(named, all_of, rows):
    total = sum(int(r[all_of]) for r in rows)
    return f"{sum(int(r[named]) for r in rows)} of {total}" if total else "-"


def make_row(name, missing, nothing, processes):
    tied, tests = share(missing, "tied")
    none, sound = share(nothing, "nothing")
    seconds = sum(int(r["tests"]) * float(r["seconds"]) for r in missing) / max(1, tests)
    return (
        f"| {name} | {tied} of {tests} | {none} of {sound} | {of('alike_named', 'alike', missing)} | "
        f"{of('apart', 'advised', missing)} | {of('alone', 'advised', missing)} | {of('tied', 'tests', processes)} | {coverage(missing, 'before'):.2f} | "
        f"{coverage(missing, 'after'):.2f} | {coverage(nothing, 'after'):.2f} | {seconds:.1f} |\n"
    )


def make_costs(study, files):
    program = Path(study).with_name("diagnosis_cost")
    printed = subprocess.run(
        [program] + [str(ROOT / file) for file in files], capture_output=True, text=True, check=True
    ).stdout
    text = COST_HEAD
    for row in filter(None, map(COST.match, printed.splitlines())):
        cells = (Path(row["file"]).stem, row["plain"], row["plain_ms"], row["all"], row["all_ms"])
        text += f"| {' | '.join(cells)} |\n"
    return text


def make_pairs(study, files, tests, logs):
    """Two terms are missing from each mechanism that has such a pair."""
    pairs = {file: run(study, file, [PAIRS[file]], tests, logs) for file in files if file in PAIRS}
    text = PAIRS_HEAD
    for file, rows in pairs.items():
        found = " ".join(rows[0]["found"].split()[:1])
        text += (
            f"| {Path(file).stem} | {rows[0]['term']} | {of('tied', 'tests', rows)} | {found} | "
            f"{coverage(rows, 'before'):.2f} | {coverage(rows, 'after'):.2f} | {rows[0]['seconds']} |\n"
        )
    rows = sum(pairs.values(), [])
    return text + (
        f"| all | | {of('tied', 'tests', rows)} | | {coverage(rows, 'before'):.2f} | {coverage(rows, 'after'):.2f} | |\n"
    )


def make_shapes(study, logs):
    """What a term that the model lacks does to intervals, by each parameter."""
    text = SHAPE_HEAD
    for row in run(study, MECHANISMS[0], SHAPES, SHAPE_TESTS, logs):
        cells = (
            row["term"],
            row["ratio"],
            f"{row['tied']} of {row['tests']}",
            row["before"],
            row["scaled"],
            row["after"],
        )
        text += f"| {' | '.join(cells)} |\n"
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study")
    parser.add_argument("--terms", type=int, default=8)
    parser.add_argument("--tests", type=int, default=2)
    parser.add_argument("--nothing", type=int, default=12)
    parser.add_argument("--gusts", type=int, default=2, help="tests of a random force on each coordinate")
    parser.add_argument("--pairs", type=int, default=12, help="tests of each pair of terms")
    parser.add_argument("--mechanism", nargs="*", default=[], help="only these, by the names of their files")
    parser.add_argument("--logs", type=Path, help="folder")
    parser.add_argument("--out", type=Path, required=True, help="the page, Markdown")
    arguments = parser.parse_args()
    if arguments.logs:
        arguments.logs.mkdir(parents=True, exist_ok=True)
    chosen = [file for file in MECHANISMS if not arguments.mechanism or Path(file).stem in arguments.mechanism]
    table = "| mechanism | first or tied | nothing found where nothing is missing | alike | second test | alone | random force | coverage before | after | nothing missing | s |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n"
    all_missing, all_nothing, all_processes, missed = [], [], [], []
    for file in chosen:
        names = [row["term"] for row in run(arguments.study, file, [], 0, arguments.logs)]
        missing = run(arguments.study, file, choose(names, arguments.terms), arguments.tests, arguments.logs)
        nothing = run(arguments.study, file, ["none"], arguments.nothing, arguments.logs)
        forces = [name for name in names if name.startswith("process.")] if arguments.gusts else []
        processes = run(arguments.study, file, forces, arguments.gusts, arguments.logs) if forces else []
        table += make_row(Path(file).stem, missing, nothing, processes)
        all_processes += processes
        all_missing += missing
        all_nothing += nothing
        missed += [
            f"| {Path(file).stem} | {r['term']} | {r['tied']} of {r['tests']} | {r['found']} |\n"
            for r in missing
            if int(r["tied"]) < int(r["tests"])
        ]
        print(table.splitlines()[-1], flush=True)
        named = MISSED_HEAD + "".join(missed) if missed else ""
        total = make_row("all", all_missing, all_nothing, all_processes)
        left = [Path(one).stem for one in MECHANISMS if one not in chosen]
        page = HEAD + table + total + (f"\nNot measured: {', '.join(left)}.\n" if left else "") + named
        arguments.out.write_text(page)  # what is finished is kept
    if arguments.pairs:
        page += make_pairs(arguments.study, chosen, arguments.pairs, arguments.logs)
    if MECHANISMS[0] in chosen:
        page += make_shapes(arguments.study, arguments.logs)
    arguments.out.write_text(page + make_costs(arguments.study, chosen))


if __name__ == "__main__":
    main()
