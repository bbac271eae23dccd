#!/usr/bin/env python3
"""How busy a sweep keeps the cores, and what it costs beside simulating and training.

  bench/sweep_utilisation.py build/release/framework/cli/twinmap experiments/two_beam/table1.yaml \
      design.train.method=nested_latin_hypercube design.train.samples=50,100,250 noise.scale=0.5,1 seed=1..3

Runs `plan`, then the sweep in a temporary folder. Utilisation is user time / (wall time x threads). The overhead is what
the cases' time has beside the stages of provenance.json (training, inference, limits), over all CPU time.
"""
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path


def read_stages(folder):
    seconds = 0.0
    for file in folder.glob("cases/*/provenance.json"):
        seconds += sum(json.loads(file.read_text())["seconds"].values())
    return seconds


def main():
    twinmap, *experiment = sys.argv[1:]
    cores = os.cpu_count()
    with tempfile.TemporaryDirectory(prefix="twinmap_bench_") as name:
        folder = Path(name) / "sweep"
        print("load before:", *os.getloadavg())
        print(
            subprocess.run(
                [twinmap, "plan", *experiment, "--out", folder], text=True, check=True, stdout=subprocess.PIPE
            ).stdout,
            end="",
        )
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        start = time.perf_counter()
        subprocess.run([twinmap, "run", *experiment, "--out", folder, "--quiet"], check=True, stdout=subprocess.DEVNULL)
        wall = time.perf_counter() - start
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        user, system = after.ru_utime - before.ru_utime, after.ru_stime - before.ru_stime
        simulating = float(re.search(r"simulated in ([\d.]+) s", (folder / "run.log").read_text())[1])
        stages = read_stages(folder)
        size = sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())
    print(
        f"wall {wall:.1f} s, user {user:.1f} s, system {system:.1f} s, largest memory {after.ru_maxrss / 2**20:.2f} GiB, "
        f"disk {size / 2**30:.2f} GiB, load after {os.getloadavg()[0]:.1f}"
    )
    print(f"utilisation {100 * user / (wall * cores):.0f} % of {cores} cores")
    print(f"simulating {simulating:.1f} s on all cores, stages of the cases {stages:.1f} s on one")
    busy = simulating * cores + stages
    print(f"overhead {100 * (1 - busy / (wall * cores)):.0f} % of the cores' time (right on an idle machine only)")


if __name__ == "__main__":
    main()
