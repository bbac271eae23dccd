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


def read(file, spec):
    """Times and a column for each output, in the model's units."""
    if file.suffix == ".mat":
        loaded = {name: np.ravel(value) for name, value in loadmat(file).items() if name[0] != "_"}
        columns = {name: value.astype(float) for name, value in loaded.items() if value.dtype.kind in "iuf"}
    else:
        columns = {name: column.to_numpy() for name, column in pd.read_csv(file).items()}

    def take(name):
        plain, _, unit = name.partition(" ")
        values = columns[name] if name in columns else columns[plain]
        return values * UNITS.get(unit, 1.0)

    measurement = spec["measurement"]
    found = {output: take(name) for output, name in measurement["columns"].items()}
    if "sample_rate" in measurement:
        return np.arange(len(next(iter(found.values())))) / measurement["sample_rate"], found
    return take(measurement["time"]), found


class Fit:
    def __init__(self, folder, recording, starts):
        spec = yaml.safe_load((folder / "model.yaml").read_text())
        times, columns = read(folder / recording, spec)
        model = twinmap.Experiment.from_file(folder / "model.yaml")
        self.windows, self.measured, self.sds, self.count = [], [], [], 0
        for start in starts:
            moved = {f"excitation.{name}.tables[0].measured.start": start for name in spec.get("excitation", {})}
            self.windows.append(model.override(moved) if moved else model)
            for output in model.outputs:
                self.measured.append(np.interp(start + model.times, times, columns[output.name]))
                self.sds.append(np.full(len(model.times), float(spec["noise"]["stddev"][output.name])))
        self.measured, self.sds = np.concatenate(self.measured), np.concatenate(self.sds)
        self.shared, own = len(model.parameters), len(model.sampled) - len(model.parameters)
        spread = lambda kind: [getattr(one, kind) for one in model.sampled]
        repeat = lambda values: np.array(values[: self.shared] + values[self.shared :] * len(starts))
        self.lower, self.upper = repeat(spread("lower")), repeat(spread("upper"))
        self.names, self.own = [one.name for one in model.parameters], own

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

    def solve(self):
        starts = qmc.scale(qmc.LatinHypercube(len(self.lower), seed=1).random(STARTS), self.lower, self.upper)
        found = [
            least_squares(
                lambda x: self.simulate(x[None])[0],
                start,
                self.differentiate,
                (self.lower, self.upper),
                x_scale=self.upper - self.lower,
                max_nfev=100,
            )
            for start in starts
        ]
        best = min(found, key=lambda one: one.cost)
        sd = np.sqrt(np.diag(np.linalg.pinv(best.jac.T @ best.jac)))
        said = [] if best.success else [best.message]
        return best, sd, said + (["at a bound"] if np.any(best.active_mask) else [])


def main():
    folder, recording, out, *starts = sys.argv[1:]

    def act():
        fit = Fit(Path(folder), recording, [float(start) for start in starts])
        return fit, *fit.solve()

    (fit, best, sd, said), seconds, _, heard = listen(act)
    answer = {
        "values": dict(zip(fit.names, best.x.tolist())),
        "sds": dict(zip(fit.names, sd.tolist())),
        "warnings": said + heard,
        "simulations": fit.count,
        "seconds": seconds,
    }
    Path(out).write_text(json.dumps(answer))


if __name__ == "__main__":
    main()
