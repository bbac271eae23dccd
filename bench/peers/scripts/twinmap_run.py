"""`twinmap run FILE.yaml` once, then `twinmap infer RUN measurement.csv` of each machine: a trained map, refined on the simulator.

With the setting `map` it is not refined: what scikit-learn and GPyTorch are to be compared with.
"""
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parent))
import yaml
from harness import answer_each
from twinmap_infer import TWINMAP, call

OPTIONS = ["--no-refine"] if sys.argv[4:] == ["map"] else []


def prepare(case):
    run = case.folder / f"run{len(OPTIONS)}"
    subprocess.run([TWINMAP, "run", case.model, "--out", run], check=True, capture_output=True)
    design = yaml.safe_load(case.model.read_text()).get("design", {})
    return run, sum(one.get("samples", 0) for one in design.values())


def infer(case, machine, run):
    return call(case, machine, run, *OPTIONS)


if __name__ == "__main__":
    answer_each(prepare, infer)
