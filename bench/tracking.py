#!/usr/bin/python3
"""Holds `twinmap track` to its bars and writes a page: lives of machines, false alarms, delays, changes that are none.

    bench/tracking.py BUILD STORE --out docs/benchmarks/tracking.md [--machines 200] [--elsewhere 8] [--confounded 40] [--seed 1]

BUILD is the folder of a build with bench/all (kernels_tracking_lives, machine_lives and twinmap). STORE is a folder: runs of the
mechanisms in bench/framework/tracking, and each figure that is finished (figures.jsonl), so that another call goes on. Delete it
after a change of the tracker. With --machines 200 lives of 300 measurements it takes some two hours of a processor, most of it
inference of simulated measurements; lives that are drawn directly take ten minutes.
"""
import argparse
import json
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
from scipy.stats import binom

ROOT = Path(__file__).resolve().parent.parent
MECHANISMS = {"swing": "constants.friction=0.06", "ring": "constants.hardening=9000", "rotor": "constants.drag=0.01"}
WEAR = {"swing": 1, "ring": 0, "rotor": 0}  # number of the parameter that steps
WALK = "{random_walk: unknown}"
TREND = "{trend: unknown}"
#: Lives that are drawn directly; sizes in sds of a measurement. told: the tracker's walk; -1: it learns it.
LIVES = {
    "constant": {"told": 0},
    "four constants": {"told": 0, "parameters": 4, "lives": 50},
    "constant, taken for a walk": {"told": -1},
    "walk of .05, unknown": {"told": -1, "walk": 0.05},
    "walk of .1, known": {"told": 0.1, "walk": 0.1},
    "walk of .1, unknown": {"told": -1, "walk": 0.1},
    "walk of .316, known": {"told": 0.316, "walk": 0.316},
    "walk of .316, unknown": {"told": -1, "walk": 0.316},
    "walk of 1, known": {"told": 1, "walk": 1},
    "walk of 1, unknown": {"told": -1, "walk": 1},
    "walk of .316, one in five missing": {"told": -1, "walk": 0.316, "dropout": 0.2},
    "walk of .316, one in twenty bad": {"told": -1, "walk": 0.316, "bad": 0.05},
    "constant, one in twenty bad": {"told": 0, "bad": 0.05},
    "slope of -.2": {"told": 0, "trend": 1, "slope": -0.2, "limit": 20},
    "slope of -.2, walk of .1": {"told": 0.1, "trend": 1, "walk": 0.1, "slope": -0.2, "limit": 20},
    "step of 1": {"told": 0, "step": 1},
    "step of 2": {"told": 0, "step": 2},
    "step of 5": {"told": 0, "step": 5},
}
FORECAST = {"walk of .316, known": 5, "walk of .316, unknown": 5, "walk of 1, unknown": 15}
ALARMS = ["constant", "walk of .1, known", "walk of .316, known", "walk of 1, known", "constant, taken for a walk",
          "walk of .1, unknown", "walk of .316, unknown", "walk of 1, unknown"]  # fmt: skip
LEVELS = {1e-2: 30, 1e-3: 200, 1e-4: 1000}  # false alarms a measurement, lives
DELAYS = [1, 2, 5, 9, 30]
MACHINES = {
    "constant": {},
    "walk of .5": {"drift": WALK, "walk": 0.5},
    "slope of .1": {"drift": TREND, "slope": 0.1},
    "step of 5": {"step": 5},
    "one in five missing": {"dropout": 0.2},
    "one in twenty another machine": {"bad": 0.05},
}


#: Machines of other kinds, below experiments/.
EXPERIMENTS = {
    "two_beam": "two_beam/best",
    "cart": "duffing/cart",
    "double_pendulum": "mechanisms/double_pendulum_mild",
    "released_pendulum": "mechanisms/released_pendulum",
    "stick_slip": "mechanisms/stick_slip",
    "end_stops": "mechanisms/end_stops",
    "cubic_chain": "mechanisms/cubic_chain",
    "spinning_top": "mechanisms/spinning_top",
}


class Store:
    """Figures by the command that makes them."""

    def __init__(self, folder, build):
        self.folder, self.build = folder, build
        folder.mkdir(parents=True, exist_ok=True)
        self.path = folder / "figures.jsonl"
        lines = self.path.read_text().splitlines() if self.path.exists() else []
        self.kept = dict(json.loads(line) for line in lines)

    def get(self, key, command):
        if key not in self.kept:
            done = subprocess.run(command, capture_output=True, text=True, env={"OMP_NUM_THREADS": "1"})
            if done.returncode != 0:
                sys.exit(f"{' '.join(map(str, command))} failed:\n{done.stderr[-1000:]}")
            self.kept[key] = json.loads(done.stdout)
            with self.path.open("a") as stream:
                stream.write(json.dumps([key, self.kept[key]]) + "\n")
        return self.kept[key]

    def live(self, **options):
        words = [f"{name}={value}" for name, value in options.items()]
        return self.get("lives " + " ".join(words), [self.build / "bench/kernels/kernels_tracking_lives", *words])

    def train(self, mechanism):
        folder = self.folder / mechanism
        if not (folder / "maps.h5").exists():
            command = [self.build / "framework/cli/twinmap", "run", find_file(mechanism), "refine=never"]
            subprocess.run([*command, "--out", folder, "--quiet"], check=True, stdout=subprocess.DEVNULL)
        return folder

    def simulate(self, mechanism, lives, *machine, **options):
        """Lives of simulated machines, ten at a time; their figures together."""
        words = [f"{name}={value}" for name, value in options.items()]
        together = None
        for first in range(0, lives, 10):
            key = " ".join(["machine", mechanism, f"first={first}", *machine, *words])
            command = [self.build / "bench/framework/machine_lives", self.train(mechanism),
                       find_file(mechanism), self.folder / "states",
                       f"first={first}", f"lives={min(10, lives - first)}", *machine, *words]  # fmt: skip
            together = add(together, self.get(key, command))
        return together


def find_file(mechanism):
    if mechanism in EXPERIMENTS:
        return ROOT / f"experiments/{EXPERIMENTS[mechanism]}.yaml"
    return ROOT / f"bench/framework/tracking/{mechanism}.yaml"


def add(one, other):
    """Figures of two sets of lives: numbers and counts are summed, lists joined."""
    if one is None or other is None:
        return other if one is None else one
    if isinstance(one, dict):
        return {key: add(one.get(key), other.get(key)) for key in {**one, **other}}
    if isinstance(one, list) and len(one) == 2 and all(isinstance(value, int) for value in one):
        return [one[0] + other[0], one[1] + other[1]]
    return one + other


def share(held):
    return f"{held[0] / held[1]:.3f}" if isinstance(held, list) else f"{held:.3f}"


def quantiles(values, probabilities):
    return [float(value) for value in np.quantile(values, probabilities)] if values else []


def describe_ratios(ratios):
    if not ratios:
        return "| - | - |"
    low, high = quantiles(ratios, [0.025, 0.975])
    within = np.mean([0.5 < ratio < 2 for ratio in ratios])
    return f"| {low:.2f} - {high:.2f} | {within:.2f} |"


def describe_delays(delays):
    return "{:.0f} | {:.0f}".format(*quantiles(delays, [0.5, 0.95])) if delays else "- | -"


def find_band(stated, measurements):
    return [int(bound) for bound in binom.interval(0.99, measurements, stated)]


def write_lives(store, seed):
    yield "## Lives of the tracker's own model\n"
    yield "200 lives of 300 measurements (four constants: 50); sizes in standard deviations of one measurement. Share of truths within"
    yield "the filtered and the smoothed 95 % band, quantiles of the estimated rate over the true one, share within a factor of two,"
    yield "share of crossings of a limit within the forecast interval.\n"
    yield "| | filtered | smoothed | rate, 2.5 - 97.5 % | within 2 | forecast |\n|---|--:|--:|--:|--:|--:|"
    for name, options in LIVES.items():
        options = {**options, "seed": seed, **({"limit": FORECAST[name]} if name in FORECAST else {})}
        figures = store.live(**options)
        forecast = f"{figures['forecast']:.3f}" if figures["forecasts"] else "-"
        ratios = describe_ratios(figures["ratios"])
        yield f"| {name} | {figures['filtered']:.3f} | {figures['smoothed']:.3f} {ratios} {forecast} |"


def filter_exactly(values, q, variance, prior):
    """Kalman's filter and the smoother of Rauch, Tung and Striebel of one walk: means and sds of each."""
    n = len(values)
    m, p, before_m, before_p = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    mean, spread = 0.0, prior
    for i, value in enumerate(values):
        before_m[i], before_p[i] = mean, spread + (q if i else 0.0)
        gain = before_p[i] / (before_p[i] + variance)
        mean, spread = before_m[i] + gain * (value - before_m[i]), (1 - gain) * before_p[i]
        m[i], p[i] = mean, spread
    smooth_m, smooth_p = m.copy(), p.copy()
    for i in range(n - 2, -1, -1):
        gain = p[i] / before_p[i + 1]
        smooth_m[i] += gain * (smooth_m[i + 1] - before_m[i + 1])
        smooth_p[i] += gain**2 * (smooth_p[i + 1] - before_p[i + 1])
    return m, np.sqrt(p), smooth_m, np.sqrt(smooth_p)


def write_exact(store, seed):
    yield "\n## Against the exact filter and smoother\n"
    yield "A life without alarms (they are switched off) in which nothing is left out as bad, against numpy: largest difference of means"
    yield "in sds, and of sds in parts. Left out: lives of ten with a measurement that is, beyond 3.3 sds.\n"
    yield "| walk | filtered mean | sd | smoothed mean | sd | filtered sd at the end | left out |\n|---|--:|--:|--:|--:|--:|--:|"
    for walk in (0.0, 0.1, math.sqrt(0.1), 1.0):
        options = {"told": walk, "walk": walk, "lives": 1, "dump": 1, "false_alarms": 1e-30}
        lives = [store.live(**options, seed=seed + life) for life in range(10)]
        whole = [life for life in lives if life["left_out"] == 0]
        exact = filter_exactly(0.01 * np.array(whole[0]["values"]), (0.01 * walk) ** 2, 1e-4, 1 / 3)
        names = ("filtered_mean", "filtered_sd", "smoothed_mean", "smoothed_sd")
        ours = [np.array(whole[0][name]) for name in names]
        off = [np.max(np.abs(ours[i] - exact[i]) / exact[i | 1]) for i in range(4)]
        cells = " | ".join(f"{value:.1e}" for value in off)
        yield f"| {walk:.3g} | {cells} | {100 * ours[1][-1]:.3f} | {10 - len(whole)} |"


def write_alarms(store, seed):
    yield "\n## False alarms\n"
    yield "Alarms of lives without a change, and the 99 % band of what is stated.\n"
    yield "| | " + " | ".join(f"1 in {round(1 / level)}" for level in LEVELS) + " |\n|---|" + "--:|" * len(LEVELS)
    bands = [find_band(level, 300 * lives) for level, lives in LEVELS.items()]
    yield "| band | " + " | ".join(f"{low} - {high}" for low, high in bands) + " |"
    rows = {name: LIVES[name] for name in ALARMS}
    rows["constant, one in twenty bad"] = LIVES["constant, one in twenty bad"]
    rows["walk of .316, one in twenty bad"] = LIVES["walk of .316, one in twenty bad"]
    rows["four constants"] = {"told": 0, "parameters": 4}
    for name, options in rows.items():
        cells = []
        for (level, lives), (low, high) in zip(LEVELS.items(), bands):
            chosen = {**options, "lives": lives, "false_alarms": level, "courses": 0, "seed": seed + 1}
            alarms = store.live(**chosen)["alarms"]
            cells.append(f"{alarms}" if low <= alarms <= high else f"**{alarms}**")
        yield f"| {name} | " + " | ".join(cells) + " |"


def write_delays(store, seed):
    yield "\n## Delays\n"
    yield "Measurements from a step of one parameter to its alarm, that one included: median and 95 %, of 200 lives, one in 1000 false;"
    yield "and how many were missed within 200 measurements.\n"
    sizes = " | | | ".join(f"step of {step}" for step in DELAYS)
    yield f"| | {sizes} | | |\n|---|" + "--:|" * 3 * len(DELAYS)
    rows = {
        "one constant": {},
        "four constants": {"parameters": 4},
        "walk of .1, known": {"told": 0.1, "walk": 0.1},
        "walk of .316, unknown (60 lives)": {"told": -1, "walk": 0.316, "lives": 60},
        "constant under a temperature effect of 10": {"temperature": 10},
    }
    for name, options in rows.items():
        cells = []
        for step in DELAYS:
            figures = store.live(**{**options, "step": step, "courses": 0, "seed": seed + 2})
            cells.append(f"{describe_delays(figures['delays'])} | {figures['missed']}")
        yield f"| {name} | " + " | ".join(cells) + " |"
    pair = [store.live(step=3, courses=0, seed=seed + 3, **more)["delays"] for more in ({}, {"temperature": 10})]
    yield "\nA step of 3 under a temperature effect of 10: median {:.0f}, without it {:.0f}.".format(
        np.median(pair[1]), np.median(pair[0])
    )


def write_machines(store, machines):
    yield "\n## Lives of simulated machines\n"
    yield f"Three mechanisms of `bench/framework/tracking`, two parameters each and an initial state that is not known; {machines} machines of"
    yield "300 measurements a row, each simulated, inferred by the run's estimator and tracked as by `twinmap track`. Updates: share of"
    yield "measurements that update. Alarms: of lives without a step. Smoothed bands of what is constant hold or fail whole lives long, so that"
    yield f"their shares are those of {2 * machines} numbers.\n"
    yield "| mechanism | life | filtered | smoothed | rate, 2.5 - 97.5 % | within 2 | alarms in 1000 | delay, median | 95 % | updates |"
    yield "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|"
    for mechanism in MECHANISMS:
        for name, options in MACHINES.items():
            figures = store.simulate(
                mechanism, machines, **options, **({"worn": WEAR[mechanism]} if "step" in options else {})
            )
            alarms = sum(len(life) for life in figures["alarms"])
            rate = "-" if "step" in options else f"{1000 * alarms / figures['measurements']:.1f}"
            yield (
                f"| {mechanism} | {name} | {share(figures['filtered'])} | {share(figures['smoothed'])} "
                f"{describe_ratios(figures['ratios'])} {rate} | {describe_delays(figures['delays'])} | "
                f"{figures['updates'] / figures['measurements']:.2f} |"
            )


def write_elsewhere(store, lives):
    yield "\n## Machines of other kinds\n"
    yield f"{lives} lives of 80 measurements of the machines in `experiments/`, whose parameters are constant: by the run's estimator alone, whose"
    yield "own error does not average out, and refined on the simulator, as `twinmap track` does by itself.\n"
    yield "| mechanism | by the estimator: filtered | smoothed | refined: filtered | smoothed | alarms | a step of 5: delays |"
    yield "|---|--:|--:|--:|--:|--:|---|"
    for mechanism in EXPERIMENTS:
        quick, refined, step = (
            store.simulate(mechanism, lives, measurements=80, **options)
            for options in ({}, {"refine": 1}, {"refine": 1, "step": 5, "at": 40})
        )
        alarms = sum(map(len, quick["alarms"] + refined["alarms"]))
        yield (
            f"| {mechanism} | {share(quick['filtered'])} | {share(quick['smoothed'])} | {share(refined['filtered'])} | "
            f"{share(refined['smoothed'])} | {alarms} | {', '.join(f'{delay:.0f}' for delay in step['delays'])} |"
        )


def is_named(alarms, begin):
    """Whether a change was announced, without a rival, from a time on."""
    return any(not alarm.get("rivals") for alarm in alarms if alarm["announced"] >= begin)


def write_confounded(store, lives):
    yield "\n## A change, or a model that lacks a term\n"
    yield f"{lives} lives of 150 measurements whose amplitude decays to a twentieth, by constants and an alarm of one in 1000. Lacking: the machine"
    yield "has Coulomb friction, a spring that hardens or quadratic drag, the model has not. Wear: the model is right, one parameter steps by"
    yield "5 sds at the 75th. Nothing: neither. Named: lives with a change that is announced without a rival.\n"
    yield "| mechanism | lacking: alarms | named | wear: found | named | nothing: named |\n|---|--:|--:|--:|--:|--:|"
    common = {"measurements": 150, "decay": 1, "at": 75}
    for mechanism, term in MECHANISMS.items():
        lacking = store.simulate(mechanism, lives, term, **common)["alarms"]
        wear = store.simulate(mechanism, lives, **common, step=5, worn=WEAR[mechanism])["alarms"]
        nothing = store.simulate(mechanism, lives, **common)["alarms"]
        found = [any(alarm["announced"] >= 75 for alarm in alarms) for alarms in wear]
        named = [
            sum(is_named(alarms, begin) for alarms in kind) for kind, begin in ((lacking, 0), (wear, 75), (nothing, 0))
        ]
        yield f"| {mechanism} | {sum(map(bool, lacking))} | {named[0]} | {sum(found)} | {named[1]} | {named[2]} |"


INTRODUCTION = """# Tracking, measured

Written by `bench/tracking.py BUILD STORE --out docs/benchmarks/tracking.md`: `twinmap track` ([how](../how-to/track-a-machine.md)) on lives of
machines whose parameters are known. Bold: outside of the 99 % band. What follows from it:

- Thresholds of alarms (`calcThreshold`) are interpolated between rates and levels at which lives without a change raise .85 of the
  alarms that are stated, so that one in twenty measurements may be bad. At 1 in 10000 two bad ones that agree by chance are too many.
- One measurement alone speaks for a change by a factor of 2 at most: with 20, bad ones raise more alarms, and steps are found no sooner.
- At its threshold an alarm is as likely false as true. The belief becomes a mixture of both: the constant's band held .926 where an
  alarm was believed, and smoothed .922 before later measurements could take a change back.
- A map errs alike in all measurements of one machine. Until its error without noise was added to the belief, filtered bands of constants by
  the estimator alone held .54 (stick-slip), .72 (cubic chain), .84 (two beams) and .85 (double pendulum) after 120 measurements.
- A posterior within bounds is what they cut off of the likelihood. While a normal distribution of the bounds' variance was divided out
  instead, the refined top's held .75, for of some machines half of the estimates are posteriors near the bounds of `c_lean`.
- Alarms are held against terms that the model lacks since the last table was made. Of 24 lives each that lack friction, hardening and drag 0
  of 72 are named, and each has the term among its rivals. Of wear 28 of 32, 24 of 24 and 23 of 24 are named.
- A rate that is unknown has the prior `sqrt(r) exp(-r / 2)` over the logarithm of r, the walk's sd over a measurement's. A constant
  that is taken for a walk then holds too often, for walks of .05 cannot be excluded from 300 measurements. Of 100 lives each:

| prior | constant | walk of .02 | of .05 | of .1 | of .2 |
|---|--:|--:|--:|--:|--:|
| sqrt(r) | .998 | .980 | .947 | .936 | .941 |
| r^.25 | .996 | .967 | .929 | .923 | .934 |
| uniform | .993 | .947 | .898 | .898 | .918 |
| sqrt(r), a fifth at 0 | .992 | .930 | .891 | .904 | .928 |
| sqrt(r), half at 0 | .977 | .863 | .821 | .856 | .907 |
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path)
    parser.add_argument("store", type=Path)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--machines", type=int, default=200)
    parser.add_argument("--elsewhere", type=int, default=8)
    parser.add_argument("--confounded", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--parts", default="lives,exact,alarms,delays,machines,elsewhere,confounded")
    arguments = parser.parse_args()
    store = Store(arguments.store.resolve(), arguments.build.resolve())
    parts = {
        "lives": lambda: write_lives(store, arguments.seed),
        "exact": lambda: write_exact(store, arguments.seed),
        "alarms": lambda: write_alarms(store, arguments.seed),
        "delays": lambda: write_delays(store, arguments.seed),
        "machines": lambda: write_machines(store, arguments.machines),
        "elsewhere": lambda: write_elsewhere(store, arguments.elsewhere),
        "confounded": lambda: write_confounded(store, arguments.confounded),
    }
    lines = [INTRODUCTION]
    for name in arguments.parts.split(","):
        for line in parts[name]():
            print(line, flush=True)
            lines.append(line)
    if arguments.out:
        arguments.out.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
