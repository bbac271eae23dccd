"""Whether a change moves rows of docs/benchmarks/posterior.md: a fifth of its kinds, few tests each, two programs side by side.

    bench/posterior_rows.py STORE BASE CHANGED              # posterior_study of both commits; some five minutes each
    bench/posterior_rows.py STORE BASE CHANGED --rows crane,mirror --times 3

What was run is kept in STORE (JSON lines), by the program's path and age, so that a run that was stopped goes on, and the base
is run once. A row: 95 % coverage over all parameters and tests; ratio, median over the parameters; the largest z; `ok` and
answers in which the best basin was missed; median simulations and processor time. Behind it what moved: coverage that differs
by more than three binomial standard errors, a ratio by 5 %, `ok` by three, simulations by 10 %. The machines and their noise are
the same for both, so that answers differ only where the change does something.
"""
import argparse
import json
import math
import re
import statistics
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
MECHANISMS = HERE.parent / "experiments" / "mechanisms"
MACHINES = HERE / "machines"
#: Name, file and tests.
ROWS = [
    ("crane", HERE.parent / "experiments/crane/crane.yaml", 60),
    ("cubic_chain", MECHANISMS / "cubic_chain.yaml", 30),
    ("spinning_top", MECHANISMS / "spinning_top.yaml", 40),
    ("stick_slip", MECHANISMS / "stick_slip.yaml", 60),
    ("end_stops", MECHANISMS / "end_stops.yaml", 60),
    ("double_pendulum", MECHANISMS / "double_pendulum.yaml", 40),
    ("stiff_drive", MECHANISMS / "stiff_drive.yaml", 20),
    ("servo_axis", MECHANISMS / "servo_axis.yaml", 12),
    ("released_pendulum", MECHANISMS / "released_pendulum.yaml", 60),
    ("rolling_start", MACHINES / "rolling_start.yaml", 60),
    ("mirror", MACHINES / "mirror.yaml", 60),
    ("product", MACHINES / "product.yaml", 60),
    ("sum", MACHINES / "sum.yaml", 60),
    ("noisy_cart", MACHINES / "noisy_cart.yaml", 60),
    ("exact_cart", MACHINES / "exact_cart.yaml", 40),
    ("long_chain", MACHINES / "long_chain.yaml", 12),
    ("driven_cart", HERE / "driven_cart.yaml", 12),
]
PARAMETER = re.compile(r"coverage95 (\S+)  coverage50 (\S+)  ratio (\S+) .*worst z (\S+)")
TOTALS = re.compile(r"(\d+) measurements .* (\d+) with a reliable posterior; best basin missed (\d+)")
COST = re.compile(r"median (\S+) s of a processor \(.*\), (\d+) simulations")


def read(text):
    """The figures of a study's output."""
    parameters = [[float(number) for number in found] for found in PARAMETER.findall(text)]
    tests, reliable, missed = map(int, TOTALS.search(text.replace("\n", " ")).groups())
    seconds, simulations = map(float, COST.search(text).groups())
    ok = re.findall(r"^ +(\d+) ok$", text, re.MULTILINE)
    return {
        "tests": tests,
        "reliable": reliable,
        "missed": missed,
        "ok": int(ok[0]) if ok else 0,
        "coverage": statistics.mean(one[0] for one in parameters) if parameters else math.nan,
        "held": len(parameters) * reliable,
        "ratio": statistics.median(one[2] for one in parameters) if parameters else math.nan,
        "worst": max((one[3] for one in parameters), default=math.nan),
        "seconds": seconds,
        "simulations": simulations,
    }


class Store:
    def __init__(self, path):
        self.path = path
        lines = path.read_text().splitlines() if path.exists() else []
        self.kept = {tuple(key): figures for key, figures in map(json.loads, lines)}

    def get(self, program, row, tests):
        name, file, _ = row
        key = (str(program), int(program.stat().st_mtime), name, tests)
        if key not in self.kept:
            command = [str(program), str(file), str(tests)]
            done = subprocess.run(command, capture_output=True, text=True, env={"OMP_NUM_THREADS": "1"})
            if done.returncode != 0:
                sys.exit(f"{' '.join(command)} failed:\n{done.stdout[-1000:]}{done.stderr[-1000:]}")
            self.kept[key] = read(done.stdout)
            with self.path.open("a") as stream:
                stream.write(json.dumps([key, self.kept[key]]) + "\n")
        return self.kept[key]


def find_moves(base, changed):
    """What differs by more than chance, though both saw the same measurements."""
    moves = []
    if base["held"] and changed["held"]:
        error = math.sqrt(base["coverage"] * (1 - base["coverage"]) / base["held"]) + 1e-3
        if abs(changed["coverage"] - base["coverage"]) > 3 * error:
            moves.append("coverage")
        if abs(changed["ratio"] / base["ratio"] - 1) > 0.05:
            moves.append("ratio")
        if changed["worst"] > max(4.0, 1.2 * base["worst"]):
            moves.append("worst")
    if abs(changed["ok"] - base["ok"]) >= 3:
        moves.append("ok")
    if changed["missed"] >= base["missed"] + 2:
        moves.append("missed")
    if changed["simulations"] > 1.1 * base["simulations"]:
        moves.append("simulations")
    return moves


def describe(figures):
    return (
        f"{figures['coverage']:.3f} {figures['ratio']:5.2f} {figures['worst']:7.1f} {figures['ok']:3d} "
        f"{figures['missed']:2d} {figures['simulations']:6.0f} {figures['seconds']:.3f}"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("store", type=Path)
    parser.add_argument("base", type=Path)
    parser.add_argument("changed", type=Path)
    parser.add_argument("--rows", help="names, with commas; else all")
    parser.add_argument("--times", type=float, default=1.0, help="so many times the tests")
    arguments = parser.parse_args()
    wanted = arguments.rows.split(",") if arguments.rows else [row[0] for row in ROWS]
    store, ratios = Store(arguments.store), []
    columns = "cover ratio   worst  ok ms  simul.    s"
    print(f"{'row':18}tests | {columns} | {columns} | moved")
    for row in (row for row in ROWS if row[0] in wanted):
        tests = max(2, round(arguments.times * row[2]))
        base, changed = (store.get(program, row, tests) for program in (arguments.base, arguments.changed))
        ratios.append((changed["simulations"] / base["simulations"], changed["seconds"] / base["seconds"]))
        moved = ", ".join(find_moves(base, changed))
        print(f"{row[0]:18}{tests:5d} | {describe(base)} | {describe(changed)} | {moved}", flush=True)
    medians = [statistics.median(column) for column in zip(*ratios)]
    print(f"median of cost: simulations {medians[0]:.2f}, processor time {medians[1]:.2f}")


if __name__ == "__main__":
    main()
