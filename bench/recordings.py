"""How estimates from recordings with faults hold, on mechanisms of different kinds.

Usage: recordings.py TWINMAP [--tests N] [--by-run | --together N] [--limits N] [--seed S] [--mechanisms NAME ...]
                     [--faults NAME ...]
Simulates measurements of random parameters (uniform within the bounds) with noise, disturbs each in one way, and infers them
from the experiment file, by a trained run (--by-run), or each machine from N recordings jointly (--together N). Prints for each mechanism and fault: the share of 95 % intervals that
hold the truth, their number, the median of the standard deviations over what the samples left allow (Fisher information at
the truth, of the parameters with the nuisance, uniform within their bounds; of the first tests), the share of estimates with each status, how many
called `ok` are more than 6 standard deviations off, how many are errors, and the time of an inference.
"""
import argparse
import collections
import csv
import io
import json
import subprocess
import sys
import tempfile
import time
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
    """Columns of a measurement by name, the times first; the noise of each output, and which samples say something."""

    def __init__(self, text, noise):
        rows = list(csv.reader(io.StringIO(text)))
        self.names = rows[0]
        self.values = np.array(rows[1:], dtype=float)
        self.noise = noise
        self.left = np.ones((len(self.values), len(self.names) - 1), dtype=bool)

    def outputs(self):
        for i, name in enumerate(self.names[1:], start=1):
            yield self.values[:, i], self.noise[name.split(" ")[0]], self.left[:, i - 1]

    def to_text(self):
        lines = [",".join(self.names)]
        lines += [",".join("" if np.isnan(x) else repr(x) for x in row) for row in self.values.tolist()]
        return "\n".join(lines) + "\n"


def keep(recording, rng):
    pass


def lose_tenth(recording, rng):
    for values, _, left in recording.outputs():
        left[:] = rng.random(len(values)) >= 0.1
        values[~left] = np.nan


def lose_block(recording, rng):
    n = len(recording.values)
    first = rng.integers(0, n - n // 5)
    recording.left[first : first + n // 5] = False
    recording.values = np.delete(recording.values, slice(first, first + n // 5), axis=0)


def add_spikes(recording, rng):
    for values, noise, left in recording.outputs():
        hit = rng.random(len(values)) < 0.01
        hit[rng.integers(len(values))] = True
        values[hit] += noise * rng.uniform(20, 500, hit.sum()) * rng.choice([-1, 1], hit.sum())
        left[hit] = False


def thin_first(recording, rng):
    values, _, left = next(recording.outputs())
    left[:] = np.arange(len(values)) % 3 == 0
    values[~left] = np.nan


def add_noise(recording, rng, rho, factor=1.0):
    """Replaces nothing: the file was simulated without noise."""
    for values, noise, _ in recording.outputs():
        e = rng.standard_normal(len(values))
        for i in range(1, len(e)):
            e[i] = rho * e[i - 1] + np.sqrt(1 - rho**2) * e[i]
        values += factor * noise * e


def add_offset(recording, rng, size):
    """Of so many standard deviations of the noise, of each output."""
    for values, noise, _ in recording.outputs():
        values += size * noise * rng.choice([-1, 1])


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
    "delay_unknown": keep,
    "offset": lambda recording, rng: add_offset(recording, rng, 2.0),
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


def get_bounds(spec, kind):
    return {name: tuple(map(float, one["bounds"])) for name, one in (spec.get(kind) or {}).items()}


def draw(spec, rng):
    """Of parameters and nuisance, as overrides."""
    return {
        f"{kind}.{name}": rng.uniform(*bounds)
        for kind in ("parameters", "nuisance")
        for name, bounds in get_bounds(spec, kind).items()
    }


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


def list_overrides(values):
    return [f"{name}={value!r}" for name, value in values.items()]


def simulate(twinmap, file, spec, fault, rng, machine=None):
    """A recording, and the parameters and nuisance that it is of. machine: parameters that are given."""
    truth = {**draw(spec, rng), **(machine or {})}
    values = [*list_overrides(truth), f"seed={rng.integers(1 << 31)}", f"noise.scale={NOISE_SCALE.get(fault, 1.0)}"]
    noise = [] if fault.startswith("rho") else ["--noise"]
    stamps, features = describe_times(spec, fault, rng) if fault in CLOCKS else (None, None)
    text = call(twinmap, "simulate", file, *noise, *values, *([features] if features else []))
    noise_sizes = {name: float(value) for name, value in spec["noise"]["stddev"].items()}
    recording = Recording(text, noise_sizes)
    if stamps is not None:
        recording.values[:, 0] = stamps
    return recording, truth


def whiten(jacobian, rho):
    """Of autoregressive noise of unit variance, whose samples are the first axis."""
    later = (jacobian[1:] - rho * jacobian[:-1]) / np.sqrt(1 - rho**2)
    return np.concatenate([jacobian[:1], later])


class Limit:
    """What samples allow, by mechanism and point (derivatives are taken once)."""

    STEP = 1e-4  # of the bounds
    EXACTLY = ["simulation.relative_tolerance=1e-11", "simulation.absolute_tolerance=1e-13"]

    def __init__(self, twinmap):
        self.twinmap = twinmap
        self.jacobians = {}

    def simulate(self, file, point):
        rows = csv.reader(io.StringIO(call(self.twinmap, "simulate", file, *self.EXACTLY, *list_overrides(point))))
        return np.array(list(rows)[1:], dtype=float)[:, 1:]

    def differentiate(self, file, spec, point):
        """times x outputs x unknown, each in its bounds' width"""
        columns = []
        for kind in ("parameters", "nuisance"):
            for name, (low, high) in get_bounds(spec, kind).items():
                key, step = f"{kind}.{name}", self.STEP * (high - low)
                ends = [self.simulate(file, {**point, key: point[key] + side * step}) for side in (1, -1)]
                columns.append((ends[0] - ends[1]) / (2 * self.STEP))
        return np.stack(columns, axis=2)

    def calc(self, file, spec, fault, recording, truth):
        """Standard deviation of each parameter"""
        key = tuple(truth.items())
        if key not in self.jacobians:
            self.jacobians[key] = self.differentiate(file, spec, truth)
        noise = np.array([recording.noise[name.split(" ")[0]] for name in recording.names[1:]])
        scaled = self.jacobians[key] / (NOISE_SCALE.get(fault, 1.0) * noise)[:, None]
        if fault.startswith("rho"):
            scaled = whiten(scaled, float(fault[4:]))
        scaled = scaled[recording.left]
        uniform = 12.0  # information, in widths of the bounds
        covariance = np.linalg.inv(scaled.T @ scaled + uniform * np.eye(scaled.shape[1]))
        widths = [high - low for low, high in get_bounds(spec, "parameters").values()]
        return dict(zip(get_bounds(spec, "parameters"), np.sqrt(np.diag(covariance))[: len(widths)] * widths))


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
            recording.left[:, i - 1] = np.abs(recording.values[:, i]) < limit
            recording.values[:, i] = recording.values[:, i].clip(-limit, limit)
        ranges.append(f"measurement.range.{name.split(' ')[0]}=[{-limit!r}, {limit!r}]")
    return ranges


def write_variant(twinmap, file, overrides, folder):
    """The file with overrides, beside links to the other files of its own folder."""
    place = Path(tempfile.mkdtemp(dir=folder))
    for other in Path(file).resolve().parent.iterdir():
        (place / other.name).symlink_to(other)
    resolved = place / f"variant-of-{Path(file).name}"
    resolved.write_text(call(twinmap, "check", "--full", file, *overrides))
    return resolved


def describe_variant(spec, fault):
    """What is unknown beside, as overrides."""
    if fault != "delay_unknown":
        return []
    (samples,) = [feature["samples"] for feature in spec["features"]]
    most = 5 * samples["interval"]
    late = f"{{late: {{bounds: [{-most!r}, {most!r}], unit: s}}}}"
    nuisance = [f"nuisance.late={late[7:-1]}"] if spec.get("nuisance") else [f"nuisance={late}"]
    end = samples["start"] + (samples["count"] - 1) * samples["interval"] + most
    duration = max(float(spec["simulation"]["duration"]), round(end, 9))
    return [*nuisance, f"outputs.{samples['outputs'][0]}.sensor.delay=late", f"simulation.duration={duration!r}"]


def make_source(twinmap, file, overrides, by_run, folder):
    if by_run:
        call(twinmap, "run", file, *overrides, "evaluation.limit=false", "--quiet", "--out", folder / "run")
        return folder / "run"
    return write_variant(twinmap, file, overrides, folder)


def infer(twinmap, source, texts, together, folder):
    """Answers as lines of JSON: one a recording, or of so many together."""
    if together == 1:
        return call(twinmap, "infer", source, "--follow", text="\n".join(texts), may_fail=True).splitlines()
    files = []
    for i, text in enumerate(texts):
        files.append(folder / f"{i}.csv")
        files[-1].write_text(text)
    groups = [files[first : first + together] for first in range(0, len(files), together)]
    return [call(twinmap, "infer", source, *group, "--joint", "--json") for group in groups]


def measure(twinmap, file, fault, arguments, limit):
    """Of each recording the answer, the truth and the limit; s of an inference."""
    rng = np.random.default_rng(arguments.seed)
    spec = yaml.safe_load(Path(file).read_text())
    with tempfile.TemporaryDirectory(prefix="recordings") as name:
        folder = Path(name)
        variant = write_variant(twinmap, file, describe_variant(spec, fault), folder)
        spec = yaml.safe_load(variant.read_text())
        simulated = []
        for _ in range(arguments.tests):
            machine = {key: value for key, value in draw(spec, rng).items() if key.startswith("parameters.")}
            own = machine if arguments.together > 1 else None
            simulated += [simulate(twinmap, variant, spec, fault, rng, own) for _ in range(arguments.together)]
        overrides = describe_sensors(spec, fault, [recording for recording, _ in simulated])
        for recording, _ in simulated:
            FAULTS[fault](recording, rng)
        limits = [
            None
            if fault in CLOCKS or arguments.together > 1 or i >= arguments.limits
            else limit.calc(variant, spec, fault, recording, truth)
            for i, (recording, truth) in enumerate(simulated)
        ]
        (folder / "source").mkdir()
        source = make_source(twinmap, variant, overrides, arguments.by_run, folder / "source")
        texts = [recording.to_text() for recording, _ in simulated]
        start = time.perf_counter()
        lines = infer(twinmap, source, texts, arguments.together, folder)
        seconds = (time.perf_counter() - start) / arguments.tests
    of_each = simulated[:: arguments.together]
    truths = [{key.split(".")[1]: value for key, value in truth.items()} for _, truth in of_each]
    return list(zip(map(json.loads, lines), truths, limits)), seconds


class Cell:
    """Of one mechanism and fault."""

    def __init__(self, results):
        self.held, self.ratios, self.statuses = [], [], collections.Counter()
        self.tests, self.wrong, self.errors = len(results), 0, 0
        for estimate, truth, limits in results:
            if "error" in estimate:
                self.errors += 1
                continue
            if "parameters" not in estimate:
                self.statuses.update(estimate["statuses"])
                continue
            self.statuses.update(estimate["statuses"])
            for name, found in estimate["parameters"].items():
                if found["mean"] is not None:
                    self.add(estimate["statuses"], found, truth[name], limits[name] if limits else None)

    def add(self, statuses, found, truth, limit):
        intervals = found.get("intervals95") or [(found["lower"], found["upper"])]
        self.held.append(any(low <= truth <= high for low, high in intervals))
        self.ratios += [found["sd"] / limit] if limit else []
        self.wrong += statuses == ["ok"] and abs(found["mean"] - truth) > 6 * found["sd"]

    def describe(self, seconds):
        shares = ", ".join(f"{name} {count / self.tests:.3g}" for name, count in self.statuses.most_common())
        ratio = f"{np.median(self.ratios):.3f}" if self.ratios else ""
        return (
            f"{np.mean(self.held):.3f} | {len(self.held)} | {ratio} | {shares} | {self.wrong} "
            f"| {self.errors} | {seconds:.2f} s"
        )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("twinmap")
    parser.add_argument("--tests", type=int, default=40)
    way = parser.add_mutually_exclusive_group()
    way.add_argument("--by-run", action="store_true")
    way.add_argument("--together", type=int, default=1, help="recordings of a machine, each with nuisance of its own")
    parser.add_argument("--limits", type=int, default=20, help="tests whose limit is computed")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--mechanisms", nargs="+", choices=MECHANISMS, default=list(MECHANISMS))
    parser.add_argument("--faults", nargs="+", choices=FAULTS, default=list(FAULTS))
    arguments = parser.parse_args()
    limit = Limit(arguments.twinmap)
    print("| fault | mechanism | coverage95 | intervals | sd over limit | statuses | ok and wrong | errors | time |")
    print("|---|---|--:|--:|--:|---|--:|--:|--:|")
    for fault in arguments.faults:
        for name in arguments.mechanisms:
            file = EXPERIMENTS / f"{MECHANISMS[name]}.yaml"
            results, seconds = measure(arguments.twinmap, file, fault, arguments, limit)
            print(f"| {fault} | {name} | {Cell(results).describe(seconds)} |", flush=True)


if __name__ == "__main__":
    main()
