"""FMUs and programs at batch scale, through the command.

Usage: models_from_elsewhere.py TWINMAP troubled|leaking fmu|program [SAMPLES]
       models_from_elsewhere.py TWINMAP scaling|waiting fmu|program [ROUNDS]
troubled: SAMPLES (default: 10000) of a model that crashes for 1 %, hangs for 0.1 %, gives NaN for 1 % and leaks 100 kB a
sample: fails unless every failure has its reason, nothing is left behind, and a run killed in the middle and continued
gives the same bits; prints the most memory that twinmap and a worker took. leaking:
the same memory where samples leak but never fail, so that only growth replaces a worker. scaling: 400 samples of 5 ms of processor time by
one worker and by two, in alternation, medians of ROUNDS (default: 5). waiting: the same with samples that wait 5 ms, so that what
else the machine does matters little: whether twinmap lets workers work at once. The FMU is compiled by cc.
"""
import csv
import json
import os
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import h5py

ROOT = Path(__file__).resolve().parent.parent
FMUS = ROOT / "tests/framework/models/fmu/fmus"
PROGRAMS = ROOT / "bench/framework/models/external"
sys.path.insert(0, str(FMUS))
import build_fmus  # noqa: E402

VARIABLES = [
    ("x", 0, "Real", "output", "continuous", {"start": "1", "initial": "exact"}),
    ("der(x)", 1, "Real", "local", "continuous", {"derivative": "x"}),
    ("a", 2, "Real", "parameter", "fixed", {"start": "1"}),
    ("work", 3, "Real", "parameter", "fixed", {"start": "0"}),
    ("trouble", 4, "Real", "parameter", "fixed", {"start": "0"}),
    ("wait", 5, "Real", "parameter", "fixed", {"start": "0"}),
]
EXPERIMENT = """
name: elsewhere
seed: 1
model: {{{model}}}
parameters:
  a: {{bounds: [1, 2.001]}}   # whose centre does not fail
constants: {{{constants}}}
outputs:
  x: {{variable: x}}
simulation: {{duration: 1, allowed_failures: 0.1{simulation}}}
features:
  - samples: {{outputs: [x], start: 0.1, interval: 0.1, count: 10}}
noise: {{stddev: {{x: 1e-3}}}}
design: {{train: {{samples: 50}}, test: {{samples: {samples}}}}}
refine: never
evaluation: {{limit: false}}
"""
TIMEOUT = 2  # s; far above a sample's own time, though the machine be busy


def write_experiment(folder, kind, samples, *, work=0.0, wait=0.0, trouble=0):
    """The experiment's file; `work` and `wait` are the seconds that a sample takes of the processor's time and beside it."""
    if kind == "fmu":
        library = folder / "troubled.so"
        subprocess.run(
            [
                "cc",
                "-shared",
                "-fPIC",
                "-O2",
                "-DFMI=2",
                f"-I{ROOT / 'framework/models/fmu/headers'}",
                f"-I{FMUS}",
                str(ROOT / "bench/framework/models/fmu/troubled.c"),
                str(FMUS / "wrapper.c"),
                "-o",
                str(library),
                "-lm",
            ],
            check=True,
        )
        build_fmus.write(
            folder / "troubled.fmu",
            {
                "modelDescription.xml": build_fmus.describe_2(VARIABLES, "troubled", 0, "true"),
                "binaries/linux64/troubled.so": library.read_bytes(),
            },
        )
        model, limit = "fmu: {file: troubled.fmu, kind: co_simulation}", f", max_wall_time: {TIMEOUT}"
    else:
        name = "troubled.py" if trouble else "working.py"
        model, limit = f"program: {{command: [/usr/bin/python3, {PROGRAMS / name}], timeout: {TIMEOUT}}}", ""
    values = {"work": work, "wait": wait, "trouble": trouble}
    constants = ", ".join(f"{name}: {{value: {value}, variable: {name}}}" for name, value in values.items())
    file = folder / "elsewhere.yaml"
    file.write_text(EXPERIMENT.format(model=model, constants=constants, simulation=limit, samples=samples - 50))
    return file


def list_processes(mark):
    """Ids of living processes that carry the mark in their environment."""
    found = []
    for entry in Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and mark in (entry / "environ").read_bytes():
                found.append(int(entry.name))
        except OSError:
            pass
    return found


def read_peak(process):
    """MB."""
    try:
        for line in Path(f"/proc/{process}/status").read_text().splitlines():
            if line.startswith("VmHWM"):
                return int(line.split()[1]) / 1024
    except OSError:
        pass
    return 0.0


class Watch(threading.Thread):
    """The most memory of a run's process and of its workers."""

    def __init__(self, process, mark):
        super().__init__(daemon=True)
        self.process, self.mark, self.own, self.workers, self.most_workers = process, mark, 0.0, 0.0, 0

    def run(self):
        while self.process.poll() is None:
            self.own = max(self.own, read_peak(self.process.pid))
            others = [pid for pid in list_processes(self.mark) if pid != self.process.pid]
            self.workers = max([self.workers, *map(read_peak, others)])
            self.most_workers = max(self.most_workers, len(others))
            time.sleep(0.1)


class Bench:
    def __init__(self, twinmap, folder):
        self.twinmap, self.folder, self.tmp = twinmap, folder, folder / "tmp"
        self.tmp.mkdir()
        self.mark = f"TMPDIR={self.tmp}".encode()
        self.shared = set(os.listdir("/dev/shm"))

    def start(self, file, out, *more):
        return subprocess.Popen(
            [self.twinmap, "run", file, "--out", out, "--quiet", *more],
            env=dict(os.environ, TMPDIR=str(self.tmp)),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
        )

    def finish(self, process):
        errors = process.communicate()[1].decode()
        if process.returncode != 0:
            sys.exit(f"the run failed: {errors}")

    def check_nothing_is_left(self):
        deadline = time.time() + 10
        while time.time() < deadline and (list_processes(self.mark) or os.listdir(self.tmp)):
            time.sleep(0.05)
        left = [*list_processes(self.mark), *os.listdir(self.tmp), *(set(os.listdir("/dev/shm")) - self.shared)]
        if left:
            sys.exit(f"left behind: {left}")


def read_samples(path):
    found = {}
    with h5py.File(path) as file:
        file.visititems(
            lambda name, item: found.update(
                {name: item[()].tobytes() if item.dtype.kind == "f" else repr(item[()].tolist())}
            )
            if hasattr(item, "dtype")
            else None
        )
    return found


def name_fate(a):
    fate = a * 1e6 % 1000
    return "crashed: Aborted" if fate < 10 else "not" if fate < 11 else "not finite" if fate < 21 else ""


def check_reasons(out):
    """Every failure's reason is that of its parameter, and every parameter that must fail has one. Returns their counts."""
    counts = {}
    with open(out / "failures.csv", newline="") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            expected = name_fate(float(next(value for key, value in row.items() if key == "a" or key.startswith("a "))))
            if not expected or expected not in row["reason"]:
                sys.exit(f"not the reason of {expected!r}: {row}")
            counts[row["reason"]] = counts.get(row["reason"], 0) + 1
    with h5py.File(out / "samples.h5") as file:
        points = []
        file.visititems(lambda name, item: points.extend(item[:, 0]) if name.endswith("/parameters") else None)
    expected = sum(bool(name_fate(a)) for a in points)
    if sum(counts.values()) != expected:
        sys.exit(f"{sum(counts.values())} failures are listed, {expected} must be")
    return counts


def measure_troubled(bench, kind, samples):
    file = write_experiment(bench.folder, kind, samples, trouble=1)
    begin = time.time()
    process = bench.start(file, bench.folder / "whole", "--threads", "2")
    watch = Watch(process, bench.mark)
    watch.start()
    bench.finish(process)
    watch.join()
    wall = time.time() - begin
    bench.check_nothing_is_left()
    counts = check_reasons(bench.folder / "whole")
    process = bench.start(file, bench.folder / "broken", "--threads", "2")
    time.sleep(0.4 * wall)
    killed = process.poll() is None
    process.kill()
    process.communicate()
    bench.check_nothing_is_left()
    bench.finish(bench.start(file, bench.folder / "broken", "--threads", "1"))
    bench.check_nothing_is_left()
    same = read_samples(bench.folder / "whole/samples.h5") == read_samples(bench.folder / "broken/samples.h5")
    print(
        json.dumps(
            {
                "samples": samples,
                "wall_s": round(wall, 1),
                "failures": counts,
                "twinmap_peak_MB": round(watch.own),
                "worker_peak_MB": round(watch.workers),
                "processes_at_once": watch.most_workers,
                "killed_in_the_middle": killed,
                "same_bits": same,
            },
            indent=1,
        )
    )
    if not (same and killed):
        sys.exit("killed and continued, the run differs, or it had ended before")


def measure_leaking(bench, kind, samples):
    file = write_experiment(bench.folder, kind, samples, trouble=1)
    file.write_text(file.read_text().replace("[1, 2.001]", "[1.0005, 1.0009]"))  # where no sample fails
    process = bench.start(file, bench.folder / "whole", "--threads", "1")
    watch = Watch(process, bench.mark)
    watch.start()
    bench.finish(process)
    watch.join()
    bench.check_nothing_is_left()
    print(
        json.dumps(
            {"samples": samples, "twinmap_peak_MB": round(watch.own), "worker_peak_MB": round(watch.workers)}, indent=1
        )
    )


def find_stage(provenance):
    """Wall time of the simulation of the test samples, s."""
    for key, value in provenance.items():
        if key.startswith("simulate") and key.endswith("test samples"):
            return value
        if isinstance(value, dict) and find_stage(value) is not None:
            return find_stage(value)
    return None


def measure_scaling(bench, kind, rounds, **load):
    samples = 400
    file = write_experiment(bench.folder, kind, samples + 50, **load)
    times = {1: [], 2: []}
    for index in range(rounds):
        for workers in (1, 2):
            out = bench.folder / f"run{index}_{workers}"
            bench.finish(bench.start(file, out, "--threads", str(workers)))
            times[workers].append(find_stage(json.loads((out / "provenance.json").read_text())))
            print(workers, times[workers][-1], os.getloadavg()[0], flush=True)
    one, two = statistics.median(times[1]), statistics.median(times[2])
    print(
        json.dumps(
            {
                "rounds": rounds,
                "one_worker_s": one,
                "two_workers_s": two,
                "ratio": one / two,
                "ratio_of_the_best": min(times[1]) / min(times[2]),
                "load": os.getloadavg(),
            },
            indent=1,
        )
    )


def main():
    twinmap, job, kind = sys.argv[1:4]
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(twinmap, Path(folder))
        count = int(sys.argv[4]) if len(sys.argv) > 4 else 10000 if job in ("troubled", "leaking") else 5
        if job == "troubled":
            measure_troubled(bench, kind, count)
        elif job == "leaking":
            measure_leaking(bench, kind, count)
        else:
            measure_scaling(bench, kind, count, **{"work" if job == "scaling" else "wait": 5e-3})


if __name__ == "__main__":
    main()
