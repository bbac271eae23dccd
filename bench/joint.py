"""How joint estimates of several trials hold: machines of parameters drawn from the prior, each trial recorded once.

    bench/joint.py TWINMAP FILE.yaml                     # 10 machines: the seven-joint arm takes a minute or two each
    bench/joint.py TWINMAP FILE.yaml --first 11 --machines 20

FILE has `trials:`. A line a machine: statuses, intervals that hold the truth, the largest error in standard deviations, the
squared errors in units of the covariance over their number (above 1 where few draws tell the covariance) with the probability
of more (Hotelling, with as many draws as the effective sample size), time, and the effective sample sizes together and of the
recordings alone; then the share of all intervals that hold. The intervals of a machine hold or fail together where parameters
share what is not determined (of an arm whose angles alone are measured, one factor of all forces and masses); the squared
errors do not.
"""
import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import yaml
from scipy.stats import f


def draw(parameter, rng):
    """From its prior; without one, within its bounds."""
    (kind, prior), *_ = [*parameter.get("prior", {}).items(), ("uniform", parameter.get("bounds"))]
    if kind == "lognormal":
        return float(prior["median"]) * float(prior["factor"]) ** rng.standard_normal()
    if kind == "normal":
        return float(prior["mean"]) + float(prior["stddev"]) * rng.standard_normal()
    if kind == "uniform":
        return rng.uniform(*map(float, prior))
    sys.exit(f"priors of kind {kind} are not drawn here")


def record(twinmap, file, trials, truth, seed, folder):
    """A recording of each trial, as arguments of infer."""
    arguments = []
    for i, trial in enumerate(trials):
        path = folder / f"{trial}.csv"
        values = [f"parameters.{name}={value!r}" for name, value in truth.items()]
        command = [
            twinmap,
            "simulate",
            file,
            f"trial={trial}",
            "--noise",
            "--csv",
            path,
            f"seed={10 * seed + i}",
            *values,
        ]
        subprocess.run(command, check=True)
        arguments += ["--trial", f"{trial}={path}"]
    return arguments


def describe(seed, estimate, truth, seconds):
    found = estimate["parameters"]
    held = sum(found[name]["lower"] <= value <= found[name]["upper"] for name, value in truth.items())
    alone = ", ".join(f"{trial['posterior']['effective_sample_size']:.0f}" for trial in estimate["trials"])
    apart = np.array([found[name]["mean"] - value for name, value in truth.items()])
    errors = apart / np.array([found[name]["sd"] for name in truth])
    squared = apart @ np.linalg.solve(np.array(estimate["covariance"]), apart)
    draws, n = estimate["effective_sample_size"], len(truth)
    chance = f.sf(squared * (draws - n) / (n * (draws - 1)), n, draws - n) if draws > n else float("nan")
    line = f"{seed}: {', '.join(estimate['statuses'])}; {held} of {n} hold; at most {np.abs(errors).max():.2f} sd"
    line += f"; squared errors {squared / n:.2f} (p {chance:.3f})"
    print(f"{line}; {seconds:.0f} s; worth {draws:.0f} draws, alone {alone}", flush=True)
    return held


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("twinmap")
    parser.add_argument("file")
    parser.add_argument("--machines", type=int, default=10)
    parser.add_argument("--first", type=int, default=1, help="seed of the first machine")
    arguments = parser.parse_args()
    spec = yaml.safe_load(Path(arguments.file).read_text())
    held = of = 0
    for seed in range(arguments.first, arguments.first + arguments.machines):
        rng = np.random.default_rng(seed)
        truth = {name: draw(parameter, rng) for name, parameter in spec["parameters"].items()}
        with tempfile.TemporaryDirectory(prefix="joint") as folder:
            recordings = record(arguments.twinmap, arguments.file, spec["trials"], truth, seed, Path(folder))
            start = time.perf_counter()
            command = [arguments.twinmap, "infer", arguments.file, *recordings, "--json"]
            done = subprocess.run(command, capture_output=True, text=True)
        estimate = json.loads(done.stdout.splitlines()[-1]) if done.stdout else {}
        if "parameters" not in estimate:
            sys.exit(f"{seed}: {done.stderr}")
        held += describe(seed, estimate, truth, time.perf_counter() - start)
        of += len(truth)
        print(f"  {held / of:.3f} of {of} intervals hold", flush=True)


if __name__ == "__main__":
    main()
