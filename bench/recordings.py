"""How estimates from recordings with faults hold, on mechanisms of different kinds.

Usage: recordings.py TWINMAP [--tests N] [--by-run] [--seed S] [--mechanisms NAME ...] [--faults NAME ...]
Simulates measurements of random parameters (uniform within the bounds) with noise, disturbs each in one way, and infers them
from the experiment file, or by a trained run (--by-run). Prints for each mechanism and fault: the share of 95 % intervals that
hold the truth, their number, the share of estimates with each status, and how many called `ok` are more than 6 standard
deviations off.
"""
import argparse
import collections
import csv
import io
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import yaml

EXPERIMENTS = Path(__file__).resolve().parent.parent / "experiments"
MECHANISMS = {
    "cart": "duffing/cart",
    "cubic_chain": "mechanisms/cubic_chain",
    "double_pendulum": "mechanisms/double_pendulum_mild",
    "end_stops": "mechanisms/end_stops",
    "four_storeys": "mechanisms/four_storeys",
    "released_pendulum": "mechanisms/released_pendulum",
    "servo_axis": "mechanisms/servo_axis",
    "spatial_arm": "mechanisms/spatial_arm",
    "spinning_top": "mechanisms/spinning_top",
    "stiff_drive": "mechanisms/stiff_drive",
}


class Recording:
    """Columns of a measurement by name, the times first; the noise of each output."""

    def __init__(self, text, noise):
        rows = list(csv.reader(io.StringIO(text)))
        self.names = rows[0]
        self.values = np.array(rows[1:], dtype=float)
        self.noise = noise

    def outputs(self):
        for i, name in enumerate(self.names[1:], start=1):
            yield self.values[:, i], self.noise[name.split(" ")[0]]

    def to_text(self):
        lines = [",".join(self.names)]
        lines += [",".join("" if np.isnan(x) else repr(x) for x in row) for row in self.values.tolist()]
        return "\n".join(lines) + "\n"


def keep(recording, rng):
    pass


def lose_tenth(recording, rng):
    for values, _ in recording.outputs():
        values[rng.random(len(values)) < 0.1] = np.nan


def lose_block(recording, rng):
    n = len(recording.values)
    first = rng.integers(0, n - n // 5)
    recording.values = np.delete(recording.values, slice(first, first + n // 5), axis=0)


def add_spikes(recording, rng):
    for values, noise in recording.outputs():
        hit = rng.random(len(values)) < 0.01
        hit[rng.integers(len(values))] = True
        values[hit] += noise * rng.uniform(20, 500, hit.sum()) * rng.choice([-1, 1], hit.sum())


def thin_first(recording, rng):
    values, _ = next(recording.outputs())
    values[np.arange(len(values)) % 3 != 0] = np.nan


def add_noise(recording, rng, rho, factor=1.0):
    """Replaces nothing: the file was simulated without noise."""
    for values, noise in recording.outputs():
        e = rng.standard_normal(len(values))
        for i in range(1, len(e)):
            e[i] = rho * e[i - 1] + np.sqrt(1 - rho**2) * e[i]
        values += factor * noise * e


FAULTS = {
    "none": keep,
    "tenth_missing": lose_tenth,
    "block_missing": lose_block,
    "spikes": add_spikes,
    "third_of_the_rate": thin_first,
    "noise_twice": keep,
    "noise_third": keep,
    "noise_unknown": keep,
    "clipped": keep,
    "rho_0.5": lambda recording, rng: add_noise(recording, rng, 0.5),
    "rho_0.9": lambda recording, rng: add_noise(recording, rng, 0.9),
}
NOISE_SCALE = {"noise_twice": 2.0, "noise_third": 1.0 / 3.0}


def jitter(grid, rng):
    """Steps of 0.7 to 1.4 of those that were meant."""
    stamps = np.cumsum(np.diff(grid, prepend=0.0) * rng.uniform(0.7, 1.4, len(grid)) / 1.05)
    return stamps, stamps


def slip(grid, rng):
    """Half a step late from the middle on."""
    step = grid[1] - grid[0]
    return grid, grid - 0.5 * step * (grid >= grid[int(rng.uniform(0.3, 0.7) * len(grid))])


# Stamps of the samples, and the times at which they are taken, where these are not the times of the features.
CLOCKS = {
    "between_samples": lambda grid, rng: (grid - 0.37 * grid[0], grid - 0.37 * grid[0]),
    "jittered": jitter,
    "clock_late": lambda grid, rng: (grid, grid - 2.3 * (grid[1] - grid[0])),
    "clock_fast": lambda grid, rng: (grid, grid / 1.003),
    "clock_slips": slip,
}
FAULTS.update({name: keep for name in CLOCKS})
FAULTS["spikes_noise_unknown"] = add_spikes


def draw(parameters, rng):
    return {name: rng.uniform(*map(float, spec["bounds"])) for name, spec in (parameters or {}).items()}


def call(twinmap, *arguments, text=None, may_fail=False):
    done = subprocess.run([twinmap, *map(str, arguments)], input=text, capture_output=True, text=True)
    if done.returncode != 0 and not may_fail:
        sys.exit(done.stderr)
    return done.stdout


def describe_times(spec, fault, rng):
    """Stamps, and the features that are simulated there, as an override."""
    (samples,) = [feature["samples"] for feature in spec["features"]]
    grid = samples["start"] + samples["interval"] * np.arange(samples["count"])
    stamps, times = CLOCKS[fault](grid, rng)
    kept = (times > 0) & (times <= float(spec["simulation"]["duration"]))
    one = "{{samples: {{outputs: [{}], start: {!r}, interval: 1, count: 1}}}}"
    blocks = [one.format(", ".join(samples["outputs"]), float(round(t, 12))) for t in times[kept]]
    return stamps[kept], f"features=[{', '.join(blocks)}]"


def simulate(twinmap, file, spec, fault, rng):
    """A recording and the parameters that it is of."""
    truth = draw(spec["parameters"], rng)
    values = [f"parameters.{name}={value!r}" for name, value in truth.items()]
    values += [f"nuisance.{name}={value!r}" for name, value in draw(spec.get("nuisance"), rng).items()]
    values += [f"seed={rng.integers(1 << 31)}", f"noise.scale={NOISE_SCALE.get(fault, 1.0)}"]
    noise = [] if fault.startswith("rho") else ["--noise"]
    stamps, features = describe_times(spec, fault, rng) if fault in CLOCKS else (None, None)
    text = call(twinmap, "simulate", file, *noise, *values, *([features] if features else []))
    noise_sizes = {name: float(value) for name, value in spec["noise"]["stddev"].items()}
    recording = Recording(text, noise_sizes)
    if stamps is not None:
        recording.values[:, 0] = stamps
    return recording, truth


def describe_sensors(spec, fault, recordings):
    """What the file says of the sensors, as overrides."""
    if fault.endswith("noise_unknown"):
        return [f"noise.stddev.{name}=unknown" for name in spec["noise"]["stddev"]]
    if fault != "clipped":
        return []
    ranges = []
    for i, name in enumerate(recordings[0].names[1:], start=1):
        limit = 0.8 * max(np.abs(recording.values[:, i]).max() for recording in recordings)
        for recording in recordings:
            recording.values[:, i] = recording.values[:, i].clip(-limit, limit)
        ranges.append(f"measurement.range.{name.split(' ')[0]}=[{-limit!r}, {limit!r}]")
    return ranges


def make_source(twinmap, file, overrides, by_run, folder):
    if by_run:
        call(twinmap, "run", file, *overrides, "evaluation.limit=false", "--quiet", "--out", folder / "run")
        return folder / "run"
    resolved = Path(file).parent / f".recordings-{Path(file).name}"
    resolved.write_text(call(twinmap, "check", "--full", file, *overrides))
    return resolved


def measure(twinmap, file, fault, arguments):
    rng = np.random.default_rng(arguments.seed)
    spec = yaml.safe_load(Path(file).read_text())
    simulated = [simulate(twinmap, file, spec, fault, rng) for _ in range(arguments.tests)]
    overrides = describe_sensors(spec, fault, [recording for recording, _ in simulated])
    for recording, _ in simulated:
        FAULTS[fault](recording, rng)
    with tempfile.TemporaryDirectory() as folder:
        source = make_source(twinmap, file, overrides, arguments.by_run, Path(folder))
        texts = "\n".join(recording.to_text() for recording, _ in simulated)
        lines = call(twinmap, "infer", source, "--follow", text=texts, may_fail=True).splitlines()
        if not arguments.by_run:
            source.unlink()
    return [(json.loads(line), truth) for line, (_, truth) in zip(lines, simulated)]


def summarise(results):
    held, statuses, wrong, errors = [], collections.Counter(), 0, 0
    for estimate, truth in results:
        if "error" in estimate:
            errors += 1
            continue
        statuses.update(estimate["statuses"])
        for name, found in estimate["parameters"].items():
            if found["mean"] is None:
                continue
            held.append(any(low <= truth[name] <= high for low, high in found["intervals95"]))
            wrong += estimate["statuses"] == ["ok"] and abs(found["mean"] - truth[name]) > 6 * found["sd"]
    shares = ", ".join(f"{name} {count / len(results):.3g}" for name, count in statuses.most_common())
    return np.mean(held), len(held), shares, wrong, errors


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("twinmap")
    parser.add_argument("--tests", type=int, default=40)
    parser.add_argument("--by-run", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--mechanisms", nargs="+", choices=MECHANISMS, default=list(MECHANISMS))
    parser.add_argument("--faults", nargs="+", choices=FAULTS, default=list(FAULTS))
    arguments = parser.parse_args()
    print("| fault | mechanism | coverage95 | intervals | statuses | ok and wrong | errors |")
    print("|---|---|--:|--:|---|--:|--:|")
    for fault in arguments.faults:
        for name in arguments.mechanisms:
            file = EXPERIMENTS / f"{MECHANISMS[name]}.yaml"
            coverage, count, shares, wrong, errors = summarise(measure(arguments.twinmap, file, fault, arguments))
            print(f"| {fault} | {name} | {coverage:.3f} | {count} | {shares} | {wrong} | {errors} |", flush=True)


if __name__ == "__main__":
    main()
