"""Runs mechanisms of many kinds and writes docs/benchmarks/mechanisms.md: how near the information limit, and how calibrated, they are.

Usage: mechanisms.py TWINMAP [--threads N] [--tests N] [--page FILE] [--results FOLDER] [EXPERIMENT ...]
Each experiment (default: those listed in the page) runs with the default map, 250 training samples and 400 test samples.
The runs stay in FOLDER (default: results/mechanisms), so that a second call continues, or only writes the page.
"""
import argparse
import csv
import resource
import subprocess
import sys
import textwrap
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[1]

# What each shows, beyond the description in its file.
SHOWS = {
    "two_beam/best": "Nearly linear: the map alone is at the limit, and a refinement confirms it.",
    "three_mass_chain/frequency_response": "Linear, seen through frequency response functions instead of samples in time.",
    "crane/crane": "Masses, a length and a cubic stiffness at once. The response tells only the sum of two springs in parallel: the "
    "limit says so, and the answers keep the width that the bounds leave.",
    "mechanisms/double_pendulum_mild": "Smooth, so that values and slopes of 250 simulations suffice for the limit.",
    "mechanisms/double_pendulum": "Chaotic: late samples say much in principle and nothing to a map. Its intervals stay calibrated; "
    "the refinement finds the limit by growing windows of time, and says where it does not.",
    "mechanisms/cubic_chain": "Dry friction and a cubic spring bend the response so that 250 simulations do not teach it to "
    "the accuracy of the noise.",
    "mechanisms/spatial_arm": "Large rotations in space; parameters that act on each other.",
    "mechanisms/end_stops": "The moment of a contact is decided by the solution: no smooth function describes the response near "
    "a contact that is just missed.",
    "mechanisms/released_pendulum": "The initial state is unknown and not asked for: nuisance parameters, marginalised.",
    "mechanisms/stiff_drive": "Two time scales, four decades apart: the stiff gear costs steps, not accuracy.",
    "mechanisms/four_storeys": "Eight parameters that all act on all outputs.",
    "mechanisms/spinning_top": "Fast rotation; the damping of the lean is hardly seen beside that of the spin.",
    "mechanisms/servo_axis": "A controller hides mass and friction from the encoder; the motor's current and voltage tell them.",
    "mechanisms/slider_crank": "A closed loop, assembled anew for each sample; the crank's angle tells what the piston weighs.",
    "mechanisms/stick_slip": "Sticking and slipping by a bristle: 250 simulations do not teach when it slips, the simulator knows.",
    "mechanisms/imu_arm": "No encoder: accelerometer and gyroscope in their own frame, at a place and with a zero that nobody knows.",
    "mechanisms/motor_curve": "A static curve of six unknown knots, beside inertia and friction: the known load gives the scale.",
}


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("twinmap")
    parser.add_argument("experiments", nargs="*", default=list(SHOWS), help="as experiments/NAME.yaml")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--tests", type=int, default=400)
    parser.add_argument("--page", type=Path, default=ROOT / "docs/benchmarks/mechanisms.md")
    parser.add_argument("--results", type=Path, default=ROOT / "results/mechanisms")
    return parser.parse_intermixed_args()


def count_processor_seconds():
    """Of all processes that have ended; other than wall time it says something on a shared machine."""
    times = resource.getrusage(resource.RUSAGE_CHILDREN)
    return times.ru_utime + times.ru_stime


def run(arguments, name):
    """The folder of a finished run of an experiment."""
    folder = arguments.results / name.replace("/", "_")
    if not (folder / "report.html").exists():
        print(name, file=sys.stderr, flush=True)
        command = [
            arguments.twinmap,
            "run",
            ROOT / "experiments" / f"{name}.yaml",
            "inverse_map=automatic",
            "design.train.samples=250",
            f"design.test.samples={arguments.tests}",
            "--threads",
            arguments.threads,
            "--out",
            folder,
            "--quiet",
        ]
        before = count_processor_seconds()
        subprocess.run(list(map(str, command)), check=True, stdout=subprocess.DEVNULL)
        (folder / "processor_seconds.txt").write_text(f"{count_processor_seconds() - before}\n")
    return folder


def read_csv(file):
    with open(file, newline="") as stream:
        return list(csv.DictReader(stream))


def read_figures(folder):
    """Method -> its rows of methods.csv, "infer" -> those of metrics.csv; what is predicted; processor seconds; the experiment."""
    rows = read_csv(folder / "methods.csv")
    methods = {
        method: [row for row in rows if row["method"] == method]
        for method in dict.fromkeys(row["method"] for row in rows)
    }
    methods["infer"] = read_csv(folder / "metrics.csv")
    predicted = read_csv(folder / "cross_validation.csv") if (folder / "cross_validation.csv").exists() else []
    seconds = float((folder / "processor_seconds.txt").read_text())
    return methods, predicted, seconds, yaml.safe_load((folder / "resolved.yaml").read_text())


def span(rows, column, decimals):
    """'1.0 - 1.7' of a column's smallest and largest number."""
    numbers = [float(row[column]) for row in rows if row[column] != ""]
    if not numbers:
        return ""
    low, high = (f"{pick(numbers):.{decimals}f}" for pick in (min, max))
    return low if low == high else f"{low} - {high}"


def describe_seconds(seconds):
    return f"{seconds:.0f} s" if seconds >= 10 else f"{seconds:.1f} s"


def make_title(name):
    folder, file = name.split("/")
    return file if folder == "mechanisms" else folder


def make_row(name, figures):
    methods, predicted, seconds, _ = figures
    of_map = next(iter(methods.values()))
    refined = methods.get("refined", [])
    share = f"{100 * float(refined[0]['accepted']):.1f} %" if refined else "not refined"
    answers = methods["infer"]
    not_ok = f"{100 * float(answers[0]['not_ok']):.1f} %" if refined else ""
    cells = [
        f"[{make_title(name)}](#{make_title(name)})",
        span(of_map, "ratio_to_limit", 1),
        span(predicted, "limit_ratio", 1),
        span(of_map, "coverage95", 2),
        share,
        span(answers, "ratio_to_limit", 2),
        span(answers, "coverage95", 2),
        not_ok,
        describe_seconds(seconds),
    ]
    return "| " + " | ".join(cells) + " |"


def make_section(name, figures):
    methods, predicted, _, experiment = figures
    of_map = next(iter(methods.values()))
    answers = {row["parameter"]: row for row in methods["infer"]}
    told = {row["parameter"]: row for row in predicted}
    lines = [
        f"## {make_title(name)}",
        "",
        f"`experiments/{name}.yaml`: {experiment.get('description', '')}.",
        textwrap.fill(SHOWS.get(name, ""), 140),
        "",
        "| parameter | limit % | map: sd % | ratio | predicted | coverage | infer: sd % | ratio | coverage |",
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|",
    ]
    for row in of_map:
        parameter, answer = row["parameter"], answers[row["parameter"]]
        cells = [
            parameter,
            number(row["limit_pct"], 3),
            number(row["sd_pct"], 3),
            number(row["ratio_to_limit"], 3),
            number(told.get(parameter, {}).get("limit_ratio", ""), 3),
            number(row["coverage95"], 3),
            number(answer.get("sd_pct", ""), 3),
            number(answer.get("ratio_to_limit", ""), 3),
            number(answer.get("coverage95", ""), 3),
        ]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def number(text, digits):
    return f"{float(text):#.{digits}g}".rstrip(".") if text != "" else ""


HEAD = """# Mechanisms of many kinds

Written by `bench/mechanisms.py TWINMAP`: {count} mechanisms, each with its own experiment file, 250 training samples, {tests} test
samples, the default map (a surrogate) and defaults otherwise, {threads}. Ratio: standard deviation of the errors
over the information limit ([the experiment file](../reference/experiment-file/evaluation.md)), smallest and largest over the parameters. Predicted: the same as the map predicts it
without the simulator. Coverage: share of true values within the 95 % intervals. Accepted: share of the test samples whose
refinement on the simulator passed its test ([refinement](../explanation/refinement.md)). Infer: what `twinmap infer` gives, refined or sampled
([what the tables judge](../explanation/refinement.md#what-a-runs-tables-judge)); not ok: of which share it says so. Time: of a processor, for
the whole run.

```sh
twinmap run experiments/mechanisms/released_pendulum.yaml inverse_map=automatic design.train.samples=100 --out results/pendulum
```

| mechanism | map: ratio | predicted | coverage | refined: accepted | infer: ratio | coverage | not ok | time |
|---|--:|--:|--:|--:|--:|--:|--:|--:|
"""


def main():
    arguments = parse_arguments()
    figures = {name: read_figures(run(arguments, name)) for name in arguments.experiments}
    threads = "one thread" if arguments.threads == 1 else f"{arguments.threads} threads"
    page = HEAD.format(count=len(figures), tests=arguments.tests, threads=threads)
    page += "\n".join(make_row(name, found) for name, found in figures.items()) + "\n\n"
    page += "\n".join(make_section(name, found) for name, found in figures.items())
    arguments.page.write_text(page)


if __name__ == "__main__":
    main()
