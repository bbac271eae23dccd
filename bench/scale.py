#!/usr/bin/env python3
"""How twinmap grows: plans of many cases, stores of many samples, training on many simulations (docs/benchmarks/scale.md).

  bench/scale.py plan  build/release/framework/cli/twinmap
  bench/scale.py store build/release/bench/framework/store/store_bench
  bench/scale.py features build/release/framework/cli/twinmap [SIZE...]  a million samples by default
  bench/scale.py train build/release/framework/cli/twinmap [SIZE...]     16000, 32000, 64000, 100000 simulations by default

Prints wall time, processor time (user and system, of all threads) and the largest memory. `features` simulates
the two beams on two threads and writes features and store, without a map. `train` simulates the two beams in
lanes and trains four sparse maps on two threads, fits a power of the size to times and memory, and says what it
makes of a million.
"""
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

EXPERIMENTS = Path(__file__).resolve().parent.parent / "experiments/two_beam"
NESTED = ["design.train.method=nested_latin_hypercube", "evaluation.limit=false"]
SCALES = ",".join(f"{1 + i / 100:g}" for i in range(100))
# 10000 cases with a million samples between them: each with its own, a hundred sets of them, one set.
PLANS = {
    "each its own": ["seed=1..10000", "design.train.samples=90", "design.test.samples=10"],
    "a hundred sets": ["seed=1..100", f"noise.scale={SCALES}", "design.train.samples=9900", "design.test.samples=100"],
    "one set": [
        "trust.level=" + ",".join(f"{i / 1e6:g}" for i in range(1, 10001)),
        "design.train.samples=990000",
        "design.test.samples=10000",
    ],
}
SPARSE = ["refine=never", "inverse_map.gp.approximation=sgpr"]
STAGES = {"simulate": "simulate", "train": "train", "prepare": "calibrate the goodness-of-fit test"}


def measure(command):
    """Wall time and processor time in s, memory in MiB, output."""
    start = time.perf_counter()
    process = subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE, text=True)
    output = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{command[0]} {command[1]}: ended with {process.returncode}")
    return time.perf_counter() - start, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, output


def plan(twinmap):
    with tempfile.TemporaryDirectory(prefix="twinmap_scale_") as folder:
        for name, sweep in PLANS.items():
            wall, cpu, memory, output = measure(
                [
                    twinmap,
                    "plan",
                    EXPERIMENTS / "table1.yaml",
                    *NESTED,
                    *sweep,
                    "--on",
                    "local",
                    "--out",
                    folder + "/run",
                ]
            )
            cases = re.search(r"cases: +(\d+)", output)[1]
            samples = re.search(r"(\d+) to do", output)[1]
            print(f"{name}: {cases} cases, {samples} samples: {wall:.1f} s, processor {cpu:.1f} s, {memory:.0f} MiB")


def store(bench):
    with tempfile.TemporaryDirectory(prefix="twinmap_scale_") as folder:
        wall, cpu, _, _ = measure([bench, folder, 1000000, 200, 0])
        print(f"written in {wall:.1f} s, processor {cpu:.1f} s")
        for line in measure([bench, folder, 1000000, 200, 10000])[3].splitlines():
            print(line)


def features(twinmap, *sizes):
    for size in [int(size) for size in sizes] or [1000000]:
        with tempfile.TemporaryDirectory(prefix="twinmap_scale_") as folder:
            wall, cpu, memory, _ = measure(
                [
                    twinmap,
                    "run",
                    EXPERIMENTS / "table1.yaml",
                    f"design.train.samples={size}",
                    "--features-only",
                    "--threads",
                    2,
                    "--quiet",
                    "--out",
                    folder + "/run",
                ]
            )
            disk = sum(file.stat().st_size for file in Path(folder).rglob("*") if file.is_file()) / 2**20
            print(
                f"{size}: wall {wall:.1f} s, processor {cpu:.1f} s, {memory:.0f} MiB, disk {disk:.0f} MiB", flush=True
            )


def read_errors(folder):
    lines = [line.split(",") for line in (folder / "metrics.csv").read_text().splitlines()]
    return [
        [row[lines[0].index(key)] for key in ("parameter", "sd_pct", "ratio_to_limit", "coverage95")]
        for row in lines[1:]
    ]


def fit_power(sizes, seconds):
    """Least squares of log seconds on log size: exponent and the value at size 1."""
    x, y = [math.log(n) for n in sizes], [math.log(max(s, 1e-6)) for s in seconds]
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    slope = sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)
    return slope, math.exp(mean_y - slope * mean_x)


def train(twinmap, *sizes):
    sizes = [int(size) for size in sizes] or [16000, 32000, 64000, 100000]
    table = {"processor s": [], "memory MiB": [], **{name: [] for name in STAGES}}
    for size in sizes:
        with tempfile.TemporaryDirectory(prefix="twinmap_scale_") as name:
            folder = Path(name) / "run"
            wall, cpu, memory, _ = measure(
                [
                    twinmap,
                    "run",
                    EXPERIMENTS / "best.yaml",
                    *SPARSE,
                    f"design.train.samples={size}",
                    "--threads",
                    2,
                    "--quiet",
                    "--out",
                    folder,
                ]
            )
            seconds = json.loads((folder / "provenance.json").read_text())["seconds"]
            for stage, begin in STAGES.items():
                table[stage].append(sum(s for name, s in seconds.items() if name.startswith(begin)))
            table["processor s"].append(cpu)
            table["memory MiB"].append(memory)
            disk = sum(file.stat().st_size for file in folder.rglob("*") if file.is_file()) / 2**20
            stages = ", ".join(f"{stage} {table[stage][-1]:.1f} s" for stage in STAGES)
            print(f"{size}: wall {wall:.1f} s ({stages}), processor {cpu:.1f} s, {memory:.0f} MiB, disk {disk:.0f} MiB")
            for row in read_errors(folder):
                print("  ", *row, flush=True)
    for name, values in table.items():
        power, one = fit_power(sizes, values)
        print(f"{name}: grows as n^{power:.2f}; {one * 1e6 ** power:.0f} at a million")


if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] not in ("plan", "store", "features", "train"):
        sys.exit(__doc__)
    print("load", *os.getloadavg())
    {"plan": plan, "store": store, "features": features, "train": train}[sys.argv[1]](*sys.argv[2:])
