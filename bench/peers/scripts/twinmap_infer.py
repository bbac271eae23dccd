"""`twinmap infer FILE.yaml measurement.csv`: the posterior on the simulator, without training."""
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from harness import Answer, answer_each

TWINMAP = os.environ["TWINMAP"]
#: Seconds, five times what an arm takes.
LONGEST = 1200


def read(line, names):
    """Of what `infer --json` prints; what is not `ok` is a word of warning."""
    found = line["parameters"]
    column = lambda key: [found[name][key] for name in names]
    return Answer(
        np.array(column("mean"), float),
        np.array(column("sd"), float),
        column("intervals95"),
        column("intervals50"),
        [status for status in line["statuses"] if status != "ok"],
        line.get("simulations") or line.get("posterior", {}).get("simulations") or 0,
    )


def call(case, machine, source, *options):
    files = case.files(machine)
    named = [part for trial, file in files.items() for part in (["--trial", f"{trial}={file}"] if trial else [file])]
    command = [TWINMAP, "infer", source, *named, "--json", *options]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=LONGEST)
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    if not lines:
        raise RuntimeError(done.stderr.strip())
    return read(json.loads(lines[-1]), case.names)


def prepare(case):
    return None, 0


def infer(case, machine, _):
    return call(case, machine, case.model)


if __name__ == "__main__":
    answer_each(prepare, infer)
