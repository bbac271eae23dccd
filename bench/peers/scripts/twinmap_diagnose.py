"""`twinmap diagnose FILE.yaml measurement.csv --out corrected.yaml`: what the model lacks is named and added, and inferred with it."""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parent))
from harness import answer_each
from twinmap_infer import TWINMAP, call


def prepare(case):
    return None, 0


def infer(case, machine, _):
    with tempfile.TemporaryDirectory() as folder:
        corrected = Path(folder) / "corrected.yaml"
        command = [TWINMAP, "diagnose", case.model, *case.files(machine).values(), "--json", "--out", corrected]
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
        found = json.loads([line for line in done.stdout.splitlines() if line.startswith("{")][-1])["found"]
        answer = call(case, machine, corrected if found else case.model)
    answer.warnings += [f"found {' and '.join(found)}"] if found else []
    return answer


if __name__ == "__main__":
    answer_each(prepare, infer)
