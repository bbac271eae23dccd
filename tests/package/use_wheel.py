"""What a user does with the wheel, in a root that has Python and numpy alone (try_release): run there, in the user's folder."""
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import twinmap

HOME = Path.cwd()
COMMAND = HOME / "venv/bin/twinmap"


def run(*arguments):
    done = subprocess.run([COMMAND, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 0, f"{arguments}: {done.stdout}{done.stderr}"
    return done.stdout


def read_digits(table):
    """Parameter and bias, sd, MARE of each row, as they are printed."""
    rows = re.findall(r"^\| *(\w+) +\|(.*)\|$", table, re.MULTILINE)
    return {name: [cell.strip() for cell in cells.split("|")][3:6] for name, cells in rows if name != "parameter"}


def check_table():
    results = twinmap.Experiment.from_file("experiments/two_beam/table1.yaml").run("table1")
    assert read_digits(results.to_markdown()) == read_digits(Path("table.md").read_text()), results.to_markdown()
    assert list(results.metrics.index) == ["d_y", "d_theta", "k_y", "k_theta"]


def check_map():
    """Trained elsewhere; the command and the package say the same."""
    experiment = twinmap.Experiment.from_file("experiments/two_beam/table1.yaml")
    measured = experiment.simulate({"k_y": 8}, noise=True, seed=2).to_frame()
    measured.to_csv("measured.csv", index=False)
    estimate = twinmap.Map.load("map").infer("measured.csv")
    printed = json.loads(run("infer", "map", "measured.csv", "--json"))
    assert np.isfinite(estimate.mean).all() and abs(estimate["k_y"][0] - 8) < 0.3, estimate
    assert printed["parameters"]["k_y"]["mean"] == estimate["k_y"][0], printed


def check_diagnosis():
    experiment = twinmap.Experiment.from_file("experiments/duffing/cart.yaml")
    diagnosis = experiment.diagnose("cart.csv")
    assert diagnosis.complete and diagnosis.after().loc["k", "stddev"] > 0, diagnosis


def check_fmus():
    responses = twinmap.Experiment.from_file("experiments/fmu/oscillator.yaml").simulate({})
    assert responses.ok.all() and np.isfinite(responses.rows).all(), responses.reasons
    run("export", "map", "--fmu", "map.fmu")
    assert "k_y" in run("variables", "map.fmu")


def check_notebook():
    os.chdir("experiments/two_beam")
    sys.path.insert(0, "")
    cells = json.loads(Path("two_beam.ipynb").read_text())["cells"]
    names = {}
    for cell in cells:
        if cell["cell_type"] == "code":
            exec("".join(cell["source"]), names)
    assert "k_theta" in repr(names["answer"])
    os.chdir(HOME)


def main():
    assert "pandas" not in sys.modules
    check_table()
    check_map()
    check_diagnosis()
    check_fmus()
    check_notebook()
    assert f"twinmap {twinmap.__version__}" in run("--version")


main()
