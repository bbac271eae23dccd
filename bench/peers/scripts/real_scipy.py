"""scipy.optimize.least_squares on twinmap's simulations for windows of a real recording: parameters shared, initial states a window's own.

`real_scipy.py FOLDER RECORDING OUT START...`: FOLDER has model.yaml beside the recording. As scipy_twinmap.py, from eight starts.
"""
import json
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import twinmap
import yaml
from scipy.io import loadmat
from scipy.optimize import least_squares
from scipy.stats import qmc

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from harness import listen

STARTS = 8
UNITS = {"[ms]": 1e-3, "[deg]": np.pi / 180}


class Recording:
    """Columns of a file by the names of a model, in its units."""

    def __init__(self, file):
        if file.suffix == ".mat":
            loaded = {name: np.ravel(value) for name, value in loadmat(file).items() if name[0] != "_"}
            self.columns = {name: value.astype(float) for name, value in loaded.items() if value.dtype.kind in "iuf"}
        else:
            self.columns = {name: column.to_numpy() for name, column in pd.read_csv(file).items()}

    def take(self, name):
        plain, _, unit = name.partition(" ")
        values = self.columns[name] if name in self.columns else self.columns[plain]
        return values * UNITS.get(unit, 1.0)

    def read(self, measurement):
        """Times and a column for each output."""
        found = {output: self.take(name) for output, name in measurement["columns"].items()}
        if "sample_rate" in measurement:
            return np.arange(len(next(iter(found.values())))) / measurement["sample_rate"], found
        return self.take(measurement["time"]), found


class Fit:
    def __init__(self, folder, recording, starts):
        spec = yaml.safe_load((folder / "model.yaml").read_text())
        self.folder, self.recording, self.starts = folder, Recording(folder / recording), starts
        times, columns = self.recording.read(spec["measurement"])
        model = twinmap.Experiment.from_file(folder / "model.yaml")
        self.times, self.outputs = model.times, [output.name for output in model.outputs]
        self.windows, self.measured, self.sds, self.count = [], [], [], 0
        for start in starts:
            moved = {f"excitation.{name}.tables[0].measured.start": start for name in spec.get("excitation", {})}
            self.windows.append(model.override(moved) if moved else model)
            for output in model.outputs:
                self.measured.append(np.interp(start + model.times, times, columns[output.name]))
                self.sds.append(np.full(len(model.times), float(spec["noise"]["stddev"][output.name])))
        self.measured, self.sds = np.concatenate(self.measured), np.concatenate(self.sds)
        self.shared, self.own = len(model.parameters), len(model.sampled) - len(model.parameters)
        spread = lambda kind: [getattr(one, kind) for one in model.sampled]
        repeat = lambda values: np.array(values[: self.shared] + values[self.shared :] * len(starts))
        self.lower, self.upper = repeat(spread("lower")), repeat(spread("upper"))
        self.sampled = [one.name for one in model.sampled]
        self.names = self.sampled[: self.shared]

    def simulate(self, rows):
        self.count += len(rows)
        parts = []
        for i, window in enumerate(self.windows):
            begin = self.shared + i * self.own
            points = np.hstack([rows[:, : self.shared], rows[:, begin : begin + self.own]])
            parts.append(window.simulate(points).rows)
        return np.nan_to_num((np.hstack(parts) - self.measured) / self.sds, nan=1e6)

    def differentiate(self, x):
        steps = 1e-5 * (self.upper - self.lower)
        ends = [np.clip(x + sign * np.diag(steps), self.lower, self.upper) for sign in (1, -1)]
        above, below = np.split(self.simulate(np.vstack(ends)), 2)
        return ((above - below) / np.diagonal(ends[0] - ends[1])[:, None]).T


def solve(fit):
    """The best parameters of all windows, the sds of the shared ones, and what is said against them."""
    starts = qmc.scale(qmc.LatinHypercube(len(fit.lower), seed=1).random(STARTS), fit.lower, fit.upper)
    found = [
        least_squares(
            lambda x: fit.simulate(x[None])[0],
            start,
            fit.differentiate,
            (fit.lower, fit.upper),
            x_scale=fit.upper - fit.lower,
            max_nfev=100,
        )
        for start in starts
    ]
    best = min(found, key=lambda one: one.cost)
    sd = np.sqrt(np.diag(np.linalg.pinv(best.jac.T @ best.jac)))
    said = [] if best.success else [best.message]
    return best.x, sd, said + (["at a bound"] if np.any(best.active_mask) else [])


def answer(solve):
    """By solve(fit), as the arguments of the command say."""
    folder, recording, out, *starts = sys.argv[1:]

    def act():
        fit = Fit(Path(folder), recording, [float(start) for start in starts])
        return fit, *solve(fit)

    (fit, found, sd, said), seconds, _, heard = listen(act)
    line = {
        "values": dict(zip(fit.names, np.array(found, float).tolist())),
        "sds": dict(zip(fit.names, np.array(sd, float).tolist())),
        "warnings": said + heard,
        "simulations": fit.count,
        "seconds": seconds,
    }
    Path(out).write_text(json.dumps(line))


if __name__ == "__main__":
    answer(solve)
