"""How the numbers hold that `infer` gives of what is determined where the rest is not.

    bench/determined.py TWINMAP FILE.yaml                          # 20 machines from the middle half of the bounds
    bench/determined.py TWINMAP FILE.yaml --machines 40 --noise 30 # with so many times the noise
    bench/determined.py TWINMAP FILE.yaml --first 101              # others

A line a machine: the status, and the error of every stated number in its sds: combinations (`identified`), and parameters
where the posterior is unreliable. Then of each of them the share of 95 % intervals that hold the truth, and how often its
number was withheld.
"""
import argparse
import json
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

import numpy as np
import yaml


def call(*command):
    return subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True).stdout


def draw(bounds, rng):
    """From the middle half, of logarithms where there are some: the ridge goes on at either side."""
    lower, upper = map(float, bounds)
    if lower > 0:
        return float(lower * (upper / lower) ** rng.uniform(0.25, 0.75))
    return float(rng.uniform(lower + 0.25 * (upper - lower), upper - 0.25 * (upper - lower)))


def list_numbers(answer, truth):
    """Name, answer and truth of each number; an answer without a mean is withheld."""
    for one in answer.get("identified", []):
        yield one["expression"], one, eval(one["expression"].replace("^", "**"), {}, truth)
    if "unreliable" in answer["statuses"]:
        for name, one in answer.get("parameters", {}).items():
            yield name, one, truth[name]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("twinmap")
    parser.add_argument("file", type=Path)
    parser.add_argument("--machines", type=int, default=20)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--noise", type=float, default=1.0)
    arguments = parser.parse_args()
    tree = yaml.safe_load(arguments.file.read_text())
    for output, stddev in tree["noise"]["stddev"].items():
        tree["noise"]["stddev"][output] = arguments.noise * float(stddev)
    held, withheld = defaultdict(list), defaultdict(int)
    with tempfile.TemporaryDirectory() as folder:
        file, recording = Path(folder) / "machine.yaml", Path(folder) / "m.csv"
        file.write_text(yaml.safe_dump(tree))
        for seed in range(arguments.first, arguments.first + arguments.machines):
            rng = np.random.default_rng(seed)
            truth = {name: draw(one["bounds"], rng) for name, one in tree["parameters"].items()}
            values = [f"parameters.{name}={value!r}" for name, value in truth.items()]
            call(arguments.twinmap, "simulate", file, "--noise", "--csv", recording, f"seed={seed}", *values)
            answer = json.loads(call(arguments.twinmap, "infer", file, recording, "--json"))
            errors = []
            for name, one, true in list_numbers(answer, truth):
                if "mean" in one:
                    held[name].append(one["lower"] <= true <= one["upper"])
                    errors.append(f"{name} {(one['mean'] - true) / one['sd']:+.1f}")
                else:
                    withheld[name] += 1
            print(seed, answer["status"], ", ".join(errors), flush=True)
    for name in {**held, **withheld}:
        print(f"{name}: {sum(held[name])} of {len(held[name])} held, {withheld[name]} withheld")
    everything = [one for of_one in held.values() for one in of_one]
    print(f"all: {sum(everything)} of {len(everything)} held, {sum(withheld.values())} withheld")


if __name__ == "__main__":
    sys.exit(main())
