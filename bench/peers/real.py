"""The five real machines of bench/real: twinmap and peers infer the same windows, and `twinmap validate` predicts windows not used.

All give parameters; the prediction fits what each window leaves unknown besides (its initial state), for all alike.
"""
import json
import signal
import subprocess
import sys
from pathlib import Path

import yaml
from environments import run

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
MACHINES = ["fork", "pendulum", "drone", "emps", "double_pendulum"]
#: Name and title; how each is asked is RealMachine's method of that name.
ASKED = {
    "plain": "twinmap, `infer --joint`",
    "diagnosed": "twinmap, `diagnose`, its corrected model",
    "scipy": "SciPy `least_squares` on twinmap's simulations",
    "mujoco": "MuJoCo 4.0 `sysid`",
    "pypesto": "pyPESTO, profiles, on twinmap's simulations",
    "figaroh": "FIGAROH, torque regression with friction and offset",
}
#: Seconds of a processor that a peer's script may take; those that answer take 103 at most.
LONGEST = 600
#: What is asked about some machines alone.
ONLY = {"figaroh": ["emps"]}


def repeat(option, values):
    return [part for value in values for part in (option, value)]


def link(folder, *sources):
    folder.mkdir(parents=True, exist_ok=True)
    for path in (path for source in sources for path in source.iterdir()):
        if not (folder / path.name).exists():
            (folder / path.name).unlink(missing_ok=True)  # a link whose target was moved
            (folder / path.name).symlink_to(path.resolve())


class RealMachine:
    """Runs on one core in a folder with the model and the recordings; what is there already is taken."""

    def __init__(self, name, recordings, store, environments):
        self.protocol = yaml.safe_load((ROOT / "bench/real" / name / "protocol.yaml").read_text())
        self.folder, self.environments = store / "real" / name, environments
        link(self.folder, ROOT / "bench/real" / name, recordings / self.protocol["folder"])
        self.recording, self.windows = self.protocol["recording"], self.protocol["windows"]

    def ask(self, name):
        file = self.folder / f"answer_{name}.json"
        if not file.exists():
            answer = getattr(self, name)()
            if "predicted" not in answer:
                values = ",".join(f"{key}={value!r}" for key, value in answer["values"].items())
                answer["predicted"] = self.predict(answer.get("model", "model.yaml"), "--with", values)
            file.write_text(json.dumps(answer))
            print(f"{self.folder.name}: {name}", flush=True)
        return json.loads(file.read_text())

    def call(self, *arguments):
        """The last line of JSON that twinmap prints, with its seconds of a processor."""
        variables = self.environments.get_variables("plain")
        command = ["/usr/bin/time", "-f", "%U", variables["TWINMAP"], *map(str, arguments), "--json"]
        done = subprocess.run(command, cwd=self.folder, env=variables, capture_output=True, text=True)
        lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
        answer = json.loads(lines[-1]) if lines else {"error": done.stderr[-500:]}
        return {**answer, "seconds": float(done.stderr.strip().splitlines()[-1])}

    def predict(self, model, *source):
        against = repeat("--against-start", self.windows["predict"])
        answer = self.call("validate", model, *source, "--against", self.recording, *against)
        return [one["rms"] for one in answer.get("predictions", [])]

    def list_fitted(self):
        return [self.recording, *repeat("--start", self.windows["fit"])]

    def plain(self):
        answer = self.call("infer", "model.yaml", *self.list_fitted(), "--joint")
        found = answer["parameters"]
        return {
            "values": {name: one["mean"] for name, one in found.items()},
            "sds": {name: one["sd"] for name, one in found.items()},
            "warnings": [status for status in answer["statuses"] if status != "ok"],
            "seconds": answer["seconds"],
            "predicted": self.predict("model.yaml", *self.list_fitted()),
        }

    def diagnosed(self):
        answer = self.call("diagnose", "model.yaml", *self.list_fitted(), "--out", "corrected.yaml")
        found = answer.get("after", {}).get("parameters", {})
        return {
            "values": {name: one["mean"] for name, one in found.items()},
            "sds": {name: one["sd"] for name, one in found.items()},
            "warnings": [answer.get("status", "")] + [f"found {term}" for term in answer.get("found", [])],
            "seconds": answer["seconds"],
            "predicted": self.predict("corrected.yaml", *self.list_fitted()),
        }

    def scipy(self):
        return self.run_script("scipy", "plain", "real_scipy.py", self.folder, self.recording)

    def mujoco(self):
        return self.run_script("mujoco", "plain", "real_mujoco.py", self.folder, self.recording)

    def pypesto(self):
        return self.run_script("pypesto", "plain", "real_pypesto.py", self.folder, self.recording)

    def figaroh(self):
        answer = self.run_script("figaroh", "figaroh", "figaroh_emps.py", self.folder / self.recording)
        self.write_friction()
        return {**answer, "model": "friction.yaml"}

    def run_script(self, name, environment, script, *arguments):
        """What it wrote; a failure is an answer without values."""
        out, variables = self.folder / f"{name}.json", self.environments.get_variables(environment)
        command = [self.environments.get_python(environment), HERE / "scripts" / script, *arguments, out]
        if not out.exists():
            try:
                run("prlimit", f"--cpu={LONGEST}", *command, *self.windows["fit"], env=variables)
            except subprocess.CalledProcessError as error:
                is_late = error.returncode in (-signal.SIGXCPU, -signal.SIGKILL)
                why = f"stopped after {LONGEST} s" if is_late else f"ended with status {error.returncode}"
                return {"failed": why, "predicted": []}
        return json.loads(out.read_text())

    def write_friction(self):
        """The model of EMPS with the two terms that FIGAROH fits besides, for its prediction."""
        model = yaml.safe_load((self.folder / "model.yaml").read_text())
        model["parameters"].update({"Fc": {"bounds": [0, 60]}, "offset": {"bounds": [-20, 20]}})
        friction = {"coordinate": "q", "model": "regularised", "coulomb": "Fc", "onset_speed": 1e-3}
        model["system"].update(friction=[friction])
        model["system"]["force_laws"].append({"coordinate": "q", "force": "-offset"})
        (self.folder / "friction.yaml").write_text(yaml.safe_dump(model, sort_keys=False))


def measure(machine, recordings, store, environments):
    for name in ASKED:
        is_ready = environments.is_ready("figaroh" if name == "figaroh" else "plain")
        if is_ready and machine in ONLY.get(name, MACHINES):
            RealMachine(machine, recordings, store, environments).ask(name)


def show(value):
    return "-" if value is None or value != value else f"{value:.3g}"


def describe(store):
    """Tables of what the store has; "" where it has nothing."""
    text = ""
    for machine in MACHINES:
        rows = ""
        for name, title in ASKED.items():
            file = store / "real" / machine / f"answer_{name}.json"
            if file.exists():
                rows += make_row(title, json.loads(file.read_text()))
        if rows:
            protocol = yaml.safe_load((ROOT / "bench/real" / machine / "protocol.yaml").read_text())
            windows = ", ".join(map(str, protocol["windows"]["predict"]))
            text += (
                f"### {protocol['source']}\n\n| peer | parameters | rms at {windows} s | seconds | words of warning |\n"
            )
            text += f"|---|---|---|--:|---|\n{rows}\n"
    return text


def make_row(title, answer):
    if "failed" in answer:
        return f"| {title} | {answer['failed']} | - | - | - |\n"
    sds = answer.get("sds", {})
    values = ", ".join(
        f"{name} {value:.4g}({show(sds.get(name))})" for name, value in answer["values"].items() if value
    )
    predicted = ", ".join(map(show, answer.get("predicted", []))) or "-"
    words = ", ".join(f"`{word}`" for word in answer["warnings"] if word) or "none"
    return f"| {title} | {values} | {predicted} | {answer['seconds']:.1f} | {words} |\n"


if __name__ == "__main__":
    sys.exit("bench/peers/run.py --real FOLDER calls this")
