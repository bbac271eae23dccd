"""How often `twinmap infer` distrusts good and bad measurements of the two-beam case.

Usage: trust.py TWINMAP [EXPERIMENT] [MEASUREMENTS]
Trains EXPERIMENT (default: experiments/two_beam/best.yaml), then infers fresh simulated measurements (default: 1000) as
they are and disturbed: another mass m1, a trigger one sample late or early, a sensor stuck from some sample on, a spike and
a drift of 10 noise standard deviations. Prints the share that is called model_mismatch, of those disturbances that change
some feature by more than 3 standard deviations of its noise.
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

NOISE = np.array([5e-5, 0.015])[:, None]
OUTPUTS = ["y", "theta"]


def run(twinmap, experiment, folder, *overrides):
    subprocess.run(
        [twinmap, "run", experiment, "evaluation.limit=false", *overrides, "--out", folder, "--quiet"],
        check=True,
        capture_output=True,
    )


def simulate(twinmap, experiment, folder, count, *overrides):
    """Clean responses (count x 2 x times) of points that no training has seen, and the times."""
    run(twinmap, experiment, folder, "seed=4711", "design.train.samples=30", f"design.test.samples={count}", *overrides)
    with h5py.File(folder / "samples.h5") as file:
        return file["test/responses"][:], file["times"][:]


def infer(twinmap, folder, times, responses):
    """The statuses of each response."""
    header = ",".join(["t", *OUTPUTS]) + "\n"
    text = header + "\n".join(
        "".join(f"{t!r},{y!r},{theta!r}\n" for t, y, theta in zip(times.tolist(), *response.tolist()))
        for response in responses
    )
    result = subprocess.run(
        [twinmap, "infer", folder, "--follow"], input=text, capture_output=True, text=True, check=True
    )
    return [json.loads(line)["statuses"] for line in result.stdout.splitlines()]


def stick(responses, output, rng):
    stuck = responses.copy()
    for response, first in zip(stuck, rng.integers(1, responses.shape[2] - 1, len(responses))):
        response[output, first:] = response[output, first]
    return stuck


def spike(responses, rng):
    spiked = responses.copy()
    for response, output, at in zip(
        spiked, rng.integers(0, 2, len(spiked)), rng.integers(0, responses.shape[2], len(spiked))
    ):
        response[output, at] += 10 * NOISE[output, 0]
    return spiked


def disturb(measured, clean, rng):
    """Name -> disturbed measurements; a late or early trigger shifts the clean response beneath the same noise."""
    noise = measured - clean
    late = np.concatenate([np.zeros_like(clean[:, :, :1]), clean[:, :, :-1]], axis=2) + noise
    early = np.concatenate([clean[:, :, 1:], clean[:, :, -1:]], axis=2) + noise
    return {
        "one sample late": late,
        "one sample early": early,
        "y stuck": stick(measured, 0, rng),
        "theta stuck": stick(measured, 1, rng),
        "spike of 10 sd": spike(measured, rng),
        "drift of 10 sd": measured + 10 * NOISE * np.linspace(0, 1, clean.shape[2]),
    }


def main():
    twinmap = sys.argv[1]
    experiment = sys.argv[2] if len(sys.argv) > 2 else str(Path(__file__).parents[1] / "experiments/two_beam/best.yaml")
    count = int(sys.argv[3]) if len(sys.argv) > 3 else 1000
    rng = np.random.default_rng(1)
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        run(twinmap, experiment, folder / "map")
        clean, times = simulate(twinmap, experiment, folder / "good", count)
        heavy, _ = simulate(twinmap, experiment, folder / "heavy", count, "constants.m1.value=3.465")
        measured = clean + NOISE * rng.standard_normal(clean.shape)
        statuses = infer(twinmap, folder / "map", times, measured)
        for status in sorted({s for found in statuses for s in found}):
            print(f"good measurements: {status:17s} {100 * np.mean([status in found for found in statuses]):6.2f} %")
        cases = {"m1 +5 %": heavy + (measured - clean), **disturb(measured, clean, rng)}
        for name, disturbed in cases.items():
            chosen = (np.abs(disturbed - measured) / NOISE).max(axis=(1, 2)) > 3
            found = infer(twinmap, folder / "map", times, disturbed[chosen])
            print(f"{name:17s} found {100 * np.mean(['model_mismatch' in f for f in found]):6.2f} % of {chosen.sum()}")


if __name__ == "__main__":
    main()
