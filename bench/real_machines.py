#!/usr/bin/env python3
"""Fits, diagnoses and predicts recordings of a real machine that others made and published, and writes its page.

Usage: bench/real_machines.py TWINMAP FOLDER MACHINE ... --out DIR [--keep DIR]

MACHINE is a folder of bench/real: model.yaml, and protocol.yaml, which says what was chosen and when. FOLDER holds the
recordings as they were published; they are not part of the project. What twinmap prints is kept in --keep, and what is
there already is taken.
"""
import argparse
import json
import os
import re
import subprocess
import tempfile
from collections import Counter
from pathlib import Path

import yaml

MACHINES = Path(__file__).resolve().parent / "real"


class Runner:
    """Runs twinmap on one core in a folder with the model and the recordings."""

    def __init__(self, twinmap, folder):
        self.twinmap, self.folder = twinmap, folder

    def call(self, name, *arguments):
        """The last line of JSON that it prints, or {}, with the seconds of a processor as "cpu"."""
        kept = self.folder / f"{name}.json"
        if not kept.exists():
            before = os.times().children_user
            done = subprocess.run(
                [self.twinmap, *map(str, arguments), "--json"],
                cwd=self.folder,
                capture_output=True,
                text=True,
                env={**os.environ, "OMP_NUM_THREADS": "1"},
            )
            seconds = os.times().children_user - before
            lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
            (self.folder / f"{name}.txt").write_text(done.stdout + done.stderr)
            kept.write_text(json.dumps({**(json.loads(lines[-1]) if lines else {}), "cpu": seconds}))
            print(f"{self.folder.name}: {name} in {seconds:.0f} s", flush=True)
        return json.loads(kept.read_text())

    def look(self, recording):
        """What look prints of the columns that the model reads."""
        model = (self.folder / "model.yaml").read_text()
        measurement = yaml.safe_load(model).get("measurement", {})
        options = ["--rate", str(measurement["sample_rate"])] if "sample_rate" in measurement else []
        options += ["--time", measurement["time"]] if "time" in measurement else []
        command = [self.twinmap, "look", recording, *options]
        head, columns = subprocess.run(command, cwd=self.folder, capture_output=True, text=True).stdout.split("\n\n", 1)
        lines = columns.splitlines()
        read = [line for line in lines[1:] if line and re.search(rf"\b{re.escape(line.split()[0])}\b", model)]
        return "\n".join(line.rstrip() for line in [*head.splitlines(), "", lines[0], *read])


def repeat(option, values):
    return [part for value in values for part in (option, value)]


def measure(runner, protocol):
    recording, windows = protocol["recording"], protocol["windows"]
    starts, against = repeat("--start", windows["fit"]), repeat("--against-start", windows["predict"])
    result = {
        "look": runner.look(recording),
        "alone": [
            runner.call(f"alone_{start}", "infer", "model.yaml", recording, "--start", start)
            for start in windows["fit"] + windows["predict"]
        ],
        "together": runner.call("together", "infer", "model.yaml", recording, *starts, "--joint"),
        "diagnosis": runner.call("diagnosis", "diagnose", "model.yaml", recording, *starts, "--out", "corrected.yaml"),
    }
    predict = [recording, *starts, "--against", recording, *against]
    result["predicted"] = {
        "plain": runner.call("predicted_plain", "validate", "model.yaml", *predict),
        "corrected": runner.call("predicted_corrected", "validate", "corrected.yaml", *predict),
    }
    model = "model.yaml"
    if protocol["published_terms"]:
        model = "published.yaml"
        terms = ",".join(protocol["published_terms"])
        result["given"] = runner.call(
            "given", "diagnose", "model.yaml", recording, *starts, "--accept", terms, "--out", model
        )
        result["predicted"]["terms given"] = runner.call("predicted_given", "validate", model, *predict)
    values = {**protocol["published"], **protocol.get("supposed", {})}
    result["predicted"]["published"] = runner.call(
        "predicted_published",
        "validate",
        model,
        "--with",
        ",".join(f"{name}={value}" for name, value in values.items()),
        *predict[len(starts) + 1 :],
    )
    return result


def show(one):
    mean, sd = (one or {}).get("mean"), (one or {}).get("sd")
    return f"{mean:.4g} +- {sd:.2g}" if mean is not None and sd is not None and sd > 0 else "-"


def describe_alone(alone):
    counts = Counter(", ".join(one.get("statuses", ["no answer"])) for one in alone)
    found = Counter((one.get("missing") or {}).get("term", "none") for one in alone)
    seconds = sorted(one["cpu"] for one in alone)
    return (
        "- Each window alone: "
        + "; ".join(f"`{statuses}` {count}" for statuses, count in counts.most_common())
        + ". Missing by its name: "
        + ", ".join(f"`{term}` {count}" if term != "none" else f"none {count}" for term, count in found.most_common())
        + f". {seconds[len(seconds) // 2]:.1f} s, {seconds[-1]:.1f} s at most.\n"
    )


def describe_found(diagnosis):
    texts = []
    for step in (step for step in diagnosis["steps"] if step["found"]):
        tied = " or ".join(f"`{c['term']}`" for c in step["candidates"][: step["tied"]])
        partner = step.get("partner") or {}
        texts.append(tied + (f" with `{partner['term']}`" if partner else ""))
    return "; then ".join(texts) or "nothing"


def describe_diagnosis(diagnosis):
    if "steps" not in diagnosis:
        return "- Diagnosis: none.\n"
    before, after = diagnosis["before"], diagnosis["after"]
    kept = ", ".join(f"`{term}`" for term in diagnosis["found"]) or "nothing"
    return (
        f"- Diagnosis of those fitted: chi-square {before['chi_square']:.4g} of {before['degrees']:.0f}; found {describe_found(diagnosis)}; "
        f"in the end {kept}: `{diagnosis['status']}`, chi-square {after['chi_square']:.4g} of {after['degrees']:.0f}. {diagnosis['cpu']:.0f} s.\n"
    )


def make_parameters(result, protocol):
    together, diagnosis = result["together"].get("parameters", {}), result["diagnosis"]
    after = {**diagnosis.get("after", {}).get("parameters", {}), **diagnosis.get("parameters", {})}
    given = result.get("given", {}).get("after", {}).get("parameters", {})
    names = dict.fromkeys([*together, *after, *given, *protocol["published"]])
    rows = "| parameter | plain | windows' scatter / sd | corrected | terms given | published |\n|---|--:|--:|--:|--:|--:|\n"
    for name in names:
        scatter = together.get(name, {}).get("scatter_over_sd")
        rows += f"| {name} | {show(together.get(name))} | {'' if scatter is None else f'{scatter:.3g}'} | {show(after.get(name))} | {show(given.get(name))} | {protocol['published'].get(name, '')} |\n"
    return rows


def make_predictions(result, protocol):
    outputs = [one.get("predictions", []) for one in result["predicted"].values()]
    outputs = list(next((p[0]["rms_in_units"] for p in outputs if p), {}))
    rows = (
        f"| model | {' | '.join(f'{start} s' for start in protocol['windows']['predict'])} | {' | '.join(outputs)} |\n"
    )
    rows += "|---|" + "--:|" * (len(protocol["windows"]["predict"]) + len(outputs)) + "\n"
    for name, one in result["predicted"].items():
        predictions = one.get("predictions", [])
        if not predictions:
            rows += f"| {name} |" + " - |" * (len(protocol["windows"]["predict"]) + len(outputs)) + "\n"
            continue
        mean = {o: (sum(p["rms_in_units"][o] ** 2 for p in predictions) / len(predictions)) ** 0.5 for o in outputs}
        cells = [f"{p['rms']:.3g}" for p in predictions] + [f"{mean[o]:.2g}" for o in outputs]
        rows += f"| {name} | {' | '.join(cells)} |\n"
    return rows


def make_page(name, protocol, result):
    windows = protocol["windows"]
    text = f"# {protocol['source']}\n\nWritten by `bench/real_machines.py` from [its protocol](../../../bench/real/{name}/protocol.yaml). "
    text += f"Fitted: windows from {', '.join(map(str, windows['fit']))} s. Predicted: from {', '.join(map(str, windows['predict']))} s. {protocol['chosen'].strip()}\n\n"
    text += f"What `look` says of it:\n\n```\n{result['look']}\n```\n\n"
    text += describe_alone(result["alone"])
    text += f"- Those fitted together: `{', '.join(result['together'].get('statuses', ['no answer']))}`. {result['together']['cpu']:.0f} s.\n"
    text += describe_diagnosis(result["diagnosis"]) + "\n" + make_parameters(result, protocol)
    text += "\nResiduals of windows not used, in sds of the stated noise, and their root mean square in units:\n\n"
    return text + make_predictions(result, protocol)


def link(folder, *sources):
    for path in (path for source in sources for path in source.rglob("*") if path.is_file()):
        target = folder / path.name
        if not target.exists():
            target.symlink_to(path.resolve())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("twinmap", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("machines", nargs="+")
    parser.add_argument("--out", type=Path, required=True, help="folder of the pages, Markdown")
    parser.add_argument("--keep", type=Path, help="folder for what twinmap prints; results that are there are used")
    arguments = parser.parse_args()
    for name in arguments.machines:
        protocol = yaml.safe_load((MACHINES / name / "protocol.yaml").read_text())
        with tempfile.TemporaryDirectory() as temporary:
            work = (arguments.keep or Path(temporary)) / name
            work.mkdir(parents=True, exist_ok=True)
            link(work, MACHINES / name, arguments.folder / protocol["folder"])
            result = measure(Runner(arguments.twinmap.resolve(), work), protocol)
        arguments.out.mkdir(parents=True, exist_ok=True)
        (arguments.out / f"{name}.md").write_text(make_page(name, protocol, result))


if __name__ == "__main__":
    main()
