#!/usr/bin/env python3
"""What right answers could hide: the term that may move a parameter most without being noticed, of one recording alone.

Usage: bench/unnoticed.py TWINMAP FOLDER [--machines 4] [--mechanism NAME ...] --out FILE

Machines are drawn from the bounds of the mechanisms of bench/diagnosis.py, whose models lack nothing, and each is recorded once
with its noise. FOLDER keeps what `infer` says, a line of JSON each: another call goes on.
"""
import argparse
import json
import subprocess
from collections import Counter
from pathlib import Path

import numpy as np
import yaml
from diagnosis import MECHANISMS, ROOT

LEFT_OUT = ["spatial_arm"]  # minutes each


def draw(file, machine):
    """Values of all that is unknown, as overrides of `simulate`."""
    spec = yaml.safe_load(file.read_text())
    rng = np.random.default_rng([machine, len(file.stem)])
    return [
        f"{kind}.{name}={rng.uniform(*map(float, one['bounds']))!r}"
        for kind in ("parameters", "nuisance")
        for name, one in spec.get(kind, {}).items()
    ]


def answer(twinmap, file, machine, folder):
    recording = folder / "recording.csv"
    truth = draw(file, machine)
    subprocess.run(
        [twinmap, "simulate", file, "--noise", f"seed={machine}", "--csv", recording, *truth],
        check=True,
        capture_output=True,
    )
    done = subprocess.run(
        [twinmap, "infer", file, recording, "--json", "--threads", "1"], capture_output=True, text=True
    )
    found = json.loads(done.stdout.splitlines()[-1])
    return {
        "mechanism": file.stem,
        "machine": machine,
        "statuses": found["statuses"],
        "unnoticed": found.get("unnoticed"),
    }


def make_row(name, answers):
    spots = [one["unnoticed"] for one in answers if one["statuses"] == ["ok"] and one["unnoticed"]]
    shifts = [spot["shift"] for spot in spots]
    terms = Counter(f"`{spot['term']}`" for spot in spots)
    named = ", ".join(f"{term} {count}" for term, count in terms.most_common())
    between = f"{min(shifts):.0f} - {max(shifts):.0f}" if shifts else "-"
    return f"| {name} | {len(spots)} of {len(answers)} | {between} | {named or '-'} |\n"


HEAD = """# What right answers could hide

Written by `bench/unnoticed.py TWINMAP FOLDER`. Models that lack nothing, one recording each. Of answers that are `ok`: by how many sds a
parameter moves at most with a term that is not noticed yet, and which term that is. `infer` prints both below `ok` (`unnoticed` in JSON).

| mechanism | ok | sds | term |
|---|--:|--:|---|
"""


def make_page(answers):
    names = dict.fromkeys(one["mechanism"] for one in answers)
    rows = "".join(make_row(name, [one for one in answers if one["mechanism"] == name]) for name in names)
    shifts = [one["unnoticed"]["shift"] for one in answers if one["statuses"] == ["ok"] and one["unnoticed"]]
    above = ", ".join(f"{sum(shift > sds for shift in shifts)} above {sds}" for sds in (4, 20, 50, 100))
    return f"{HEAD}{rows}\nOf all {len(shifts)}: {above}.\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("twinmap")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--machines", type=int, default=4)
    parser.add_argument("--mechanism", nargs="*", default=[], help="only these, by the names of their files")
    parser.add_argument("--out", type=Path, required=True, help="the page, Markdown")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    kept = options.folder / "answers.jsonl"
    answers = [json.loads(line) for line in kept.read_text().splitlines()] if kept.exists() else []
    done = {(one["mechanism"], one["machine"]) for one in answers}
    files = [ROOT / file for file in MECHANISMS if Path(file).stem not in LEFT_OUT]
    for file in (file for file in files if not options.mechanism or file.stem in options.mechanism):
        for machine in range(1, options.machines + 1):
            if (file.stem, machine) not in done:
                answers.append(answer(options.twinmap, file, machine, options.folder))
                with kept.open("a") as stream:
                    stream.write(json.dumps(answers[-1]) + "\n")
    options.out.write_text(make_page(answers))


if __name__ == "__main__":
    main()
