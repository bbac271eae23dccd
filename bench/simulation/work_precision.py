"""Work against precision, in lanes and by MuJoCo: measures, and writes docs/benchmarks/simulation.md with its picture.

Usage: work_precision.py [BUILD] [--rounds N] [--debian] [--rows FILE]
BUILD (default: build/release) is a configured build folder. MuJoCo is the newest that the Python package index has for this
machine, of which headers and library are taken out of the wheel into BUILD/mujoco; where the index cannot be reached, or with
--debian, the one that is installed (scripts/install-dependencies bench). --rows: rows of an earlier measurement instead.
"""
import argparse
import csv
import io
import math
import subprocess
import sys
import zipfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from vega import draw  # noqa: E402

BENCHMARK = "work_precision_benchmark"
ERRORS = [1e-3, 1e-4, 3e-5, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10]
START, END = "<!-- measured -->", "<!-- end of what was measured -->"


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", type=Path, default=ROOT / "build/release")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--debian", action="store_true")
    parser.add_argument("--rows", type=Path)
    return parser.parse_args()


def fetch_wheel(folder):
    """The wheel with MuJoCo's library: since version 4 it is a package of its own."""
    for package in ("mujoco-core", "mujoco"):
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--only-binary", ":all:"]
        if subprocess.run([*command, "--dest", folder, package]).returncode == 0:
            for wheel in sorted(folder.glob(package.replace("-", "_") + "-*.whl")):
                if any("libmujoco.so" in name for name in zipfile.ZipFile(wheel).namelist()):
                    return wheel
    return None


def unpack_mujoco(build):
    """Settings of CMake that name the wheel's headers and library; none where there is no wheel."""
    folder = build / "mujoco"
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.whl"):
        old.unlink()
    wheel = fetch_wheel(folder)
    if wheel is None:
        return []
    with zipfile.ZipFile(wheel) as archive:
        names = [n for n in archive.namelist() if n.startswith("mujoco/include/") or "/libmujoco.so" in n]
        archive.extractall(folder, names)
    library = next(folder / name for name in names if "/libmujoco.so" in name)
    return [f"-DMUJOCO_INCLUDE_DIR={folder / 'mujoco/include'}", f"-DMUJOCO_LIBRARY={library}"]


def measure(arguments):
    build = arguments.build.resolve()
    settings = [] if arguments.debian else unpack_mujoco(build)
    if not settings:
        settings = ["-UMUJOCO_INCLUDE_DIR", "-UMUJOCO_LIBRARY"]
    subprocess.run(["cmake", *settings, build], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", build, "--target", BENCHMARK], check=True, stdout=subprocess.DEVNULL)
    program = [build / "bench/simulation" / BENCHMARK, str(arguments.rounds)]
    return subprocess.run(program, check=True, stdout=subprocess.PIPE, text=True).stdout


def read_curves(text):
    """Points (error, us, setting) of each mechanism and method, in the order of the rows."""
    curves = {}
    for row in csv.DictReader(io.StringIO(text)):
        point = (float(row["error"]), float(row["us"]), float(row["setting"]))
        curves.setdefault(row["mechanism"], {}).setdefault(row["method"], []).append(point)
    return curves


def keep_best(points):
    """Those than which none is both nearer and cheaper, from the largest error on."""
    best = [p for p in points if not any(q[0] <= p[0] and q[1] <= p[1] and q[:2] != p[:2] for q in points)]
    return sorted(best, reverse=True)


def interpolate(points, error):
    """Time at an error, between the points in logarithms; NaN beyond them."""
    best = keep_best(points)
    for (coarse, less, _), (fine, more, _) in zip(best, best[1:]):
        if coarse >= error >= fine:
            share = math.log(coarse / error) / math.log(coarse / fine)
            return less ** (1.0 - share) * more**share
    return math.nan


def make_table(curves):
    names = list(curves)
    lines = ["| error, of the range | " + " | ".join(names) + " |", "|---|" + "--:|" * len(names)]
    for error in ERRORS:
        cells = []
        for methods in curves.values():
            ours, theirs = (interpolate(points, error) for points in methods.values())
            cells.append(f"{ours:.0f} us, {theirs:.0f}: **{theirs / ours:.0f}**" if theirs > 0 and ours > 0 else "")
        lines.append(f"| {error:.0e} | ".replace("e-0", "e-") + " | ".join(cells) + " |")
    return "\n".join(lines)


def make_figure(curves):
    """A Vega-Lite specification: a panel for each mechanism, a line for each method."""
    data = [
        {"mechanism": mechanism, "method": method, "error": error, "time": us}
        for mechanism, methods in curves.items()
        for method, points in methods.items()
        for error, us, _ in points
        if 1e-11 < error < 1e-1
    ]
    scale = {"type": "log", "nice": False}
    axis = {"format": ".0e", "labelOverlap": True}
    return {
        "$schema": "https://vega.github.io/schema/vega-lite/v5.json",
        "data": {"values": data},
        "background": "white",
        "facet": {"field": "mechanism", "title": None, "sort": list(curves)},
        "columns": 2,
        "spec": {
            "width": 300,
            "height": 200,
            "mark": {"type": "line", "point": True},
            "encoding": {
                "x": {
                    "field": "error",
                    "type": "quantitative",
                    "scale": {**scale, "reverse": True},
                    "axis": axis,
                    "title": "largest error, of the range",
                },
                "y": {"field": "time", "type": "quantitative", "scale": scale, "title": "us a sample"},
                "color": {"field": "method", "scale": {"scheme": "tableau10"}, "legend": {"title": None}},
            },
        },
    }


def write_page(page, curves):
    """Between the marks; what a person has written around them stays."""
    text = page.read_text()
    before, after = text[: text.index(START) + len(START)], text[text.index(END) :]
    methods = " and ".join(next(iter(curves.values())))
    page.write_text(
        f"{before}\nMicroseconds a sample, {methods}, and their **ratio**:\n\n{make_table(curves)}\n\n{after}"
    )


def main():
    arguments = parse_arguments()
    text = arguments.rows.read_text() if arguments.rows else measure(arguments)
    print(text)
    curves = read_curves(text)
    print(make_table(curves))
    draw(arguments.build / "framework/report/web", make_figure(curves), ROOT / "docs/images/work-precision.svg")
    write_page(ROOT / "docs/benchmarks/simulation.md", curves)


if __name__ == "__main__":
    main()
