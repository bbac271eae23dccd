"""What `twinmap plan` predicts beside what a run takes, on experiments of different kinds: a table in Markdown.

Usage: plan_accuracy.py [BUILD] [--shared] [--only NAME]
BUILD (default: build/release) is a built folder. One thread. --shared: on a machine that others use too, both in
processor time: a small library makes the steady clock, by which a plan measures its probe, that of the process.
"""
import argparse
import os
import re
import resource
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
CASES = {
    "table1, processes": ["two_beam/table1.yaml"],
    "table1, 20000 test samples": ["two_beam/table1.yaml", "design.test.samples=20000", "evaluation.limit=false"],
    "best, refined processes": ["two_beam/best.yaml"],
    "cart, surrogate": ["duffing/cart.yaml", "design.train.samples=200"],
    "cart, no map": ["duffing/cart.yaml", "inverse_map=none", "design.test.samples=100"],
    "chain, modes": ["three_mass_chain/modes.yaml", "design.train.samples=200"],
    "cubic chain, surrogate": ["mechanisms/cubic_chain.yaml", "design.train.samples=200"],
    "end stops, surrogate": ["mechanisms/end_stops.yaml", "design.train.samples=200"],
    "released pendulum, network": [
        "mechanisms/released_pendulum.yaml",
        "inverse_map={network: {}}",
        "design.train.samples=250",
    ],
    "crane, eight parameters, 250 samples": ["crane/crane.yaml", "design.train.samples=250"],
}
CLOCK = """#define _GNU_SOURCE
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>
int clock_gettime(clockid_t id, struct timespec *time) {
  return syscall(SYS_clock_gettime, id == CLOCK_MONOTONIC ? CLOCK_PROCESS_CPUTIME_ID : id, time);
}
"""
UNITS = {"s": 1.0, "min": 60.0, "h": 3600.0, "MiB": 1.0, "GiB": 1024.0}


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", type=Path, default=ROOT / "build/release")
    parser.add_argument("--shared", action="store_true")
    parser.add_argument("--only")
    return parser.parse_args()


def compile_clock(folder):
    source, library = folder / "clock.c", folder / "clock.so"
    source.write_text(CLOCK)
    subprocess.run(["gcc", "-O2", "-shared", "-fPIC", "-o", library, source], check=True)
    return {"LD_PRELOAD": str(library)}


def read_quantity(plan, key):
    number, unit = re.search(rf"^{key}: +about ([0-9.e+]+) (\w+)", plan, re.MULTILINE).groups()
    return float(number) * UNITS[unit]


def run(command, folder, preload):
    """Seconds and MiB of a command; its output."""
    options = ["--threads", "1", "--out", folder / "run", "--store", folder / "store"]
    environment = dict(os.environ, OMP_NUM_THREADS="1", **preload)
    measured = ["/usr/bin/time", "-o", folder / "time", "-f", "%U %S %e %M", *command, *options]
    text = subprocess.run(
        measured, check=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment
    )
    user, system, elapsed, memory = map(float, (folder / "time").read_text().split())
    return (user + system if preload else elapsed), memory / 1024.0, text.stdout


def measure(twinmap, arguments, preload):
    case = [str(ROOT / "experiments" / arguments[0]), *arguments[1:]]
    with tempfile.TemporaryDirectory() as name:
        spent, _, plan = run([twinmap, "plan", *case], Path(name), preload)
        seconds, memory, _ = run([twinmap, "run", *case], Path(name), preload)
    return read_quantity(plan, "time"), seconds, read_quantity(plan, "memory"), memory, spent


def main():
    arguments = parse_arguments()
    twinmap = arguments.build.resolve() / "framework/cli/twinmap"
    with tempfile.TemporaryDirectory() as name:
        preload = compile_clock(Path(name)) if arguments.shared else {}
        print("| experiment | predicted | took | ratio | memory, predicted | peak | ratio | the plan took |")
        print("|---|--:|--:|--:|--:|--:|--:|--:|")
        for label, case in CASES.items():
            if arguments.only in (None, label):
                time, took, memory, peak, spent = measure(twinmap, case, preload)
                print(
                    f"| {label} | {time:.3g} s | {took:.3g} s | {time / took:.2f} | {memory:.0f} MiB | {peak:.0f} MiB "
                    f"| {memory / peak:.2f} | {spent:.2g} s |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
