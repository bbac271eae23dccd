"""How near the information limit each kind of map comes, by the number of simulations: writes docs/benchmarks/map-study.md.

Usage: map_study.py TWINMAP [--threads N] [--tests N] [--results FOLDER] [--page] [--web FOLDER] [EXPERIMENT ...]
                    [--maps NAME ...] [--sizes N ...]
Each experiment (default: those of the page) runs with each map and number of simulations, without refinement. Runs stay in
FOLDER (default: results/map_study), so that a second call continues, or only writes the page, the table behind it
(results/published/map_study/study.csv) and its figures (docs/images). What is not run keeps its rows of that table, so that
--maps and --sizes renew a part of the study. --web: where the build's Vega-Lite is (default: build/release/framework/report/web).
"""
import argparse
import csv
import json
import math
import resource
import subprocess
import sys
from pathlib import Path

from vega import draw

ROOT = Path(__file__).parents[1]
FOUR = ["two_beam/best", "crane/crane", "mechanisms/double_pendulum", "mechanisms/spatial_arm"]
SIX = FOUR[:2] + ["mechanisms/double_pendulum_mild"] + FOUR[2:] + ["mechanisms/cubic_chain"]
TWO = ["two_beam/best", "mechanisms/double_pendulum"]
OTHERS = [
    f"mechanisms/{name}" for name in ("end_stops", "released_pendulum", "stiff_drive", "four_storeys", "spinning_top")
]
EXPERIMENTS = SIX + OTHERS
SIZES = [100, 250, 1000, 4000, 10000, 100000]

# Each map, for which numbers of simulations and which experiments: beyond them it takes tens of minutes, or is another one of
# the list. Of more than 2000 simulations a network learns from the simulations alone.
MAPS = [
    ("network", "network", SIZES, SIX),
    ("network", "network", [250, 4000, 10000], OTHERS),
    ("surrogate", "surrogate", [100, 250, 1000], SIX),
    ("surrogate", "surrogate", [250], OTHERS),
    ("gp", "gp", [100, 250, 1000], FOUR),
    ("sparse gp", "{gp: {approximation: sgpr}}", [1000, 4000, 10000], TWO),
    ("mixture", "{network: {head: mixture}}", [250], FOUR),
    ("bayesian last layer", "{network: {bayesian: last_layer}}", [250], FOUR),
    ("bayesian hamiltonian", "{network: {bayesian: hamiltonian}}", [100], FOUR[:1]),
    ("network, simulations alone", "{network: {samples_from: simulations}}", [250, 1000], FOUR),
]
BASELINES = {"linear_regression": ("linear regression", SIZES), "least_squares": ("least squares", [250])}
AS_GIVEN = {"least_squares": "{least_squares: {samples: 100}}"}
ORDER = list(dict.fromkeys(name for name, _, _, _ in MAPS)) + [name for name, _ in BASELINES.values()]


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("twinmap")
    parser.add_argument("experiments", nargs="*", default=EXPERIMENTS, help="as experiments/NAME.yaml")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--tests", type=int, default=1500)
    parser.add_argument("--results", type=Path, default=ROOT / "results/map_study")
    parser.add_argument("--page", action="store_true", help="run nothing, write the page from the runs that are there")
    parser.add_argument(
        "--maps", nargs="+", default=ORDER, help="of " + ", ".join(dict.fromkeys(name for name, _, _, _ in MAPS))
    )
    parser.add_argument("--sizes", nargs="+", type=int, default=SIZES, help="numbers of simulations")
    parser.add_argument("--web", type=Path, default=ROOT / "build/release/framework/report/web")
    return parser.parse_intermixed_args()


def make_title(experiment):
    folder, file = experiment.split("/")
    return file if folder == "mechanisms" else folder


def list_runs(experiments):
    """(experiment, simulations, map, as the experiment file has it)."""
    return [
        (experiment, size, name, map_spec)
        for name, map_spec, sizes, among in MAPS
        for size in reversed(sizes)
        for experiment in experiments
        if experiment in among
    ]


def list_keys():
    """(experiment, simulations, map) of all rows that the page has, baselines among them."""
    runs = [(experiment, size, name) for experiment, size, name, _ in list_runs(EXPERIMENTS)]
    return runs + [
        (experiment, size, BASELINES[key][0]) for experiment, size, name in runs for key in list_baselines(size, name)
    ]


def count_processor_seconds():
    times = resource.getrusage(resource.RUSAGE_CHILDREN)
    return times.ru_utime + times.ru_stime


def list_baselines(size, name):
    """Keys of those beside the network, which runs for all sizes."""
    return [key for key, (_, sizes) in BASELINES.items() if name == "network" and size in sizes]


def run(arguments, experiment, size, name, map_spec):
    """The folder of a finished run; none if there is none, as where the map could not be trained."""
    folder = arguments.results / experiment.split("/")[1] / str(size) / name.replace(",", "").replace(" ", "_")
    finished = (folder / "processor_seconds.txt").exists()
    if (folder / "failed.txt").exists() or (arguments.page and not finished):
        return None
    if not finished:
        print(experiment, size, name, file=sys.stderr, flush=True)
        command = [
            arguments.twinmap,
            "run",
            ROOT / "experiments" / f"{experiment}.yaml",
            "refine=never",
            f"inverse_map={map_spec}",
            f"design.train.samples={size}",
            "design.train.method=latin_hypercube",
            f"design.test.samples={arguments.tests}",
            f"noise.replicates={max(1, min(4, 1000 // size))}",
            f"evaluation.baselines=[{', '.join(AS_GIVEN.get(key, key) for key in list_baselines(size, name))}]",
            "--threads",
            arguments.threads,
            "--store",
            arguments.results / "store",
            "--out",
            folder,
            "--quiet",
        ]
        before = count_processor_seconds()
        done = subprocess.run(list(map(str, command)), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if done.returncode != 0:
            print(done.stderr, file=sys.stderr)
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "failed.txt").write_text(done.stderr)
            return None
        (folder / "processor_seconds.txt").write_text(f"{count_processor_seconds() - before}\n")
    return folder


def read_csv(file):
    if not file.exists():
        return []
    with open(file, newline="") as stream:
        return list(csv.DictReader(stream))


COLUMNS = [
    "experiment",
    "simulations",
    "map",
    "parameter",
    "sd_pct",
    "limit_pct",
    "ratio_to_limit",
    "nats_above_limit",
    "coverage50",
    "coverage95",
    "processor_seconds",
    "online_us",
    "bytes",
]


def read_rows(folder, experiment, size, name):
    """One for each parameter, of the map and of the baselines beside it."""
    provenance = json.loads((folder / "provenance.json").read_text())
    common = {"experiment": experiment, "simulations": size}
    metrics, baselines = read_csv(folder / "metrics.csv"), read_csv(folder / "baselines.csv")
    seconds = float((folder / "processor_seconds.txt").read_text())
    of_baselines = sum(
        {
            row["method"]: float(row["samples"]) * float(row["seconds_per_update"])
            for row in baselines
            if row["method"] in BASELINES
        }.values()
    )
    of_run = {
        "map": name,
        "processor_seconds": seconds - of_baselines,
        "online_us": provenance["online"]["median_us"],
        "bytes": (folder / "maps.h5").stat().st_size,
    }
    rows = [{**row, **common, **of_run} for row in metrics]
    limits = {row["parameter"]: float(row["limit_pct"]) for row in metrics}
    for row in baselines:
        if row["method"] in BASELINES:
            ratio = float(row["sd_pct"]) / limits[row["parameter"]]
            rows.append(
                {
                    **row,
                    **common,
                    "map": BASELINES[row["method"]][0],
                    "limit_pct": limits[row["parameter"]],
                    "ratio_to_limit": ratio,
                    "online_us": 1e6 * float(row["seconds_per_update"]),
                }
            )
    return [{column: row.get(column, "") for column in COLUMNS} for row in rows]


def get_key(row):
    return row["experiment"], int(row["simulations"]), row["map"]


def merge(published, found):
    """Rows of runs before, but for those that are found anew or have left the study; in its order."""
    keys, renewed = list_keys(), set(map(get_key, found))
    rows = [row for row in published if get_key(row) in keys and get_key(row) not in renewed] + found
    return sorted(rows, key=lambda row: keys.index(get_key(row)))


def number(row, column):
    return float(row[column]) if row[column] not in ("", "nan") else math.nan


def summarise(rows):
    """A row for each experiment, size and map: means over the parameters, geometric of the ratios."""
    groups = {}
    for row in rows:
        groups.setdefault(get_key(row), []).append(row)
    points = []
    for (experiment, size, name), found in groups.items():
        ratios = [number(row, "ratio_to_limit") for row in found]
        point = {
            "experiment": make_title(experiment),
            "simulations": size,
            "map": name,
            "ratio": math.exp(sum(map(math.log, ratios)) / len(ratios)),
            "worst_ratio": max(ratios),
            "nats": sum(number(row, "nats_above_limit") for row in found) / len(found),
        }
        for level in ("50", "95"):
            coverages = [number(row, f"coverage{level}") for row in found]
            point[f"coverage{level}"] = (min(coverages), max(coverages))
        for column in ("processor_seconds", "online_us", "bytes"):
            point[column] = number(found[0], column)
        points.append(point)
    titles = list(map(make_title, EXPERIMENTS))
    return sorted(
        points, key=lambda point: (titles.index(point["experiment"]), ORDER.index(point["map"]), point["simulations"])
    )


def make_figure(points, value, title):
    """A Vega-Lite specification: a panel for each experiment, a line for each map."""
    scale = {"type": "log", "nice": False} if value == "ratio" else {}  # nats may be below 0
    data = [
        {key: point[key] for key in ("experiment", "simulations", "map", value)}
        for point in points
        if math.isfinite(point[value])
    ]
    return {
        "$schema": "https://vega.github.io/schema/vega-lite/v5.json",
        "data": {"values": data},
        "background": "white",
        "facet": {"field": "experiment", "title": None, "sort": list(dict.fromkeys(p["experiment"] for p in points))},
        "columns": 3,
        "spec": {
            "width": 250,
            "height": 180,
            "mark": {"type": "line", "point": True},
            "encoding": {
                "x": {"field": "simulations", "type": "quantitative", "scale": {"type": "log", "nice": False}},
                "y": {"field": value, "type": "quantitative", "title": title, "scale": scale},
                "color": {"field": "map", "sort": ORDER, "scale": {"scheme": "tableau10"}, "legend": {"title": None}},
            },
        },
        "resolve": {"scale": {"y": "independent"}},
    }


def span(pair):
    low, high = (f"{value:.2f}" for value in pair)
    return low if low == high else f"{low} - {high}"


def describe(value, unit):
    return "" if math.isnan(value) else f"{float(f'{value:.2g}'):g} {unit}"


def show_ratio(value):
    return f"{value:.2f}" if value < 10 else f"{value:.3g}"


def make_table(points):
    lines = [
        "| map | simulations | ratio, mean | worst | nats | coverage 50 % | 95 % | processor time | a measurement | size |",
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|",
    ]
    for point in points:
        cells = [
            point["map"],
            point["simulations"],
            show_ratio(point["ratio"]),
            show_ratio(point["worst_ratio"]),
            f"{point['nats']:.2g}" if math.isfinite(point["nats"]) else "",
            span(point["coverage50"]),
            span(point["coverage95"]),
            describe(point["processor_seconds"], "s"),
            describe(point["online_us"], "us"),
            describe(point["bytes"] / 1024, "kB"),
        ]
        lines.append("| " + " | ".join(map(str, cells)) + " |")
    return "\n".join(lines)


HEAD = """# Which map for how many simulations

Written by `bench/map_study.py TWINMAP`: {count} mechanisms, {tests} test samples each, every map alone (`refine=never`), one seed. Ratio: standard
deviation of the errors over the information limit, geometric mean over the parameters and the worst of them. Nats: how much the logarithmic
density of the true parameters is below that of normal distributions as narrow as the limit, a parameter on average. Coverage: smallest and largest
over the parameters. Processor time: of the whole run, simulation, training, trust and evaluation, but for baselines. A measurement: median time from features to an
answer with its judgement, on a busy machine (a network alone takes 1 to 2 us). What they are: [choosing an estimator](../how-to/choose-an-estimator.md), [neural estimators](../explanation/networks.md).

One of them, smaller:

```sh
common="experiments/mechanisms/double_pendulum_mild.yaml design.train.samples=100 design.test.samples=200 refine=never"
twinmap run $common inverse_map=surrogate "evaluation.maps=[gp, {{network: {{samples_from: simulations, steps: 500}}}}]" --out results/which
cat results/which/maps.csv
```

![ratio to the limit against the number of simulations](../images/map-study-ratio.svg)

![nats above the limit against the number of simulations](../images/map-study-nats.svg)

{findings}
"""


def write_page(arguments, found):
    table = ROOT / "results/published/map_study/study.csv"
    rows = merge(read_csv(table), found)
    points = summarise(rows)
    table.parent.mkdir(parents=True, exist_ok=True)
    with open(table, "w", newline="") as stream:
        writer = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    arguments.results.mkdir(parents=True, exist_ok=True)
    draw(arguments.web, make_figure(points, "ratio", "errors over the limit"), ROOT / "docs/images/map-study-ratio.svg")
    draw(arguments.web, make_figure(points, "nats", "nats above the limit"), ROOT / "docs/images/map-study-nats.svg")
    page = ROOT / "docs/benchmarks/map-study.md"
    experiments = list(dict.fromkeys(point["experiment"] for point in points))
    text = HEAD.format(count=len(experiments), tests=arguments.tests, findings=read_findings(page))
    for experiment in experiments:
        text += (
            f"\n## {experiment}\n\n"
            + make_table([point for point in points if point["experiment"] == experiment])
            + "\n"
        )
    page.write_text(text)


def read_findings(page):
    """What a person has written between the figures and the tables stays."""
    start = "## What it says\n"
    text = page.read_text() if page.exists() else ""
    if start not in text:
        return start
    return text[text.index(start) :].split("\n## ")[0].rstrip() + "\n"


def main():
    arguments = parse_arguments()
    rows = []
    for experiment, size, name, map_spec in list_runs(arguments.experiments):
        if name not in arguments.maps or size not in arguments.sizes:
            continue
        folder = run(arguments, experiment, size, name, map_spec)
        rows += read_rows(folder, experiment, size, name) if folder else []
    write_page(arguments, rows)


if __name__ == "__main__":
    main()
