"""mujoco.sysid for windows of a real recording: parameters shared, initial states a window's own, which it starts from the recording.

`real_mujoco.py FOLDER RECORDING OUT START...`, as real_scipy.py; models are real_*_mujoco.py. As mujoco_sysid.py; initial states that
are parameters are set in a custom_rollout.
"""
import importlib
import logging
import sys
from pathlib import Path

import mujoco
import numpy as np
from mujoco import sysid

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parent / "models")]
from harness import SDS_95
from mujoco_sysid import STEP, States
from real_scipy import answer


class Windows:
    def __init__(self, fit):
        self.fit, self.model = fit, importlib.import_module(f"real_{fit.folder.name}_mujoco")
        self.spec = mujoco.MjSpec.from_string(self.model.XML)
        self.spec.option.timestep, self.spec.option.integrator = STEP, mujoco.mjtIntegrator.mjINT_RK4
        self.rows = np.round(np.array(fit.times) / STEP).astype(int)
        samples = np.split(fit.measured, len(fit.starts))
        self.measured = [sample.reshape(-1, len(fit.times)) for sample in samples]
        self.sds = fit.sds[: len(samples[0])].reshape(-1, len(fit.times)).T

    def list_values(self, parameters, window):
        x = np.array([one.value[0] for one in parameters.values()])
        begin = self.fit.shared + window * self.fit.own
        return dict(zip(self.fit.sampled, np.append(x[: self.fit.shared], x[begin : begin + self.fit.own])))

    def make_parameters(self):
        fit, parameters = self.fit, sysid.ParameterDict()
        own = np.concatenate([self.model.guess(np.array(fit.times), *outputs) for outputs in self.measured])
        middle = (fit.lower + fit.upper)[: fit.shared] / 2
        starts = np.clip(np.append(middle, own), fit.lower, fit.upper)
        for i, (first, lower, upper) in enumerate(zip(starts, fit.lower, fit.upper)):
            parameters.add(sysid.Parameter(str(i), first, lower, upper))
        return parameters

    def build(self, parameters, spec):
        spec = spec.copy()
        self.model.modify(spec, self.list_values(parameters, 0))
        return spec.compile()

    def make_state(self, model, parameters, window):
        """Its time is the recording's, by which a window is known."""
        q, v = self.model.start(self.list_values(parameters, window))
        state = sysid.create_initial_state(model, np.array(q, float), np.array(v, float))
        state[0] = self.fit.starts[window]
        return state

    def find_window(self, time):
        return int(np.argmin(np.abs(np.array(self.fit.starts) - time)))

    def make_sequence(self, window):
        start, model = self.fit.starts[window], self.spec.compile()
        names = [(name, sysid.SignalType.CustomObs) for name in self.fit.outputs]
        mapping = {name: (kind, np.array([i])) for i, (name, kind) in enumerate(names)}
        measured = sysid.TimeSeries(start + np.array(self.fit.times), self.measured[window].T, mapping)
        times = np.arange(self.rows[-1] + 2) * STEP
        control = sysid.TimeSeries(times, self.model.control(self.fit.recording, start + times + STEP / 2))
        return str(window), self.make_state(model, self.make_parameters(), window), control, measured

    def roll(self, models, initial_states, param_dicts, **rest):
        """From initial states that are parameters; each of param_dicts goes with as many models as there are sequences."""
        count = len(models) // len(param_dicts)
        moved = [
            self.make_state(model, param_dicts[i // count], self.find_window(state[0]))
            for i, (model, state) in enumerate(zip(models, initial_states))
        ]
        return sysid.sysid_rollout(models=models, initial_states=moved, **rest)

    def calc_residual(self, parameters, _, measured, model, return_all, state=None, **rest):
        window = self.find_window(state[0, 0])
        states = np.vstack([self.make_state(model, parameters, window), state])[self.rows]
        time, *parts = np.split(states, np.cumsum([1, model.nq, model.nv, model.na]), axis=1)
        shown, values = States(time[:, 0], *parts[:3]), self.list_values(parameters, window)
        driven = self.model.control(self.fit.recording, shown.t)
        predicted = np.stack(self.model.observe(shown, values, driven), axis=1)
        self.fit.count += 1
        series = sysid.TimeSeries(measured.times, predicted, measured.signal_mapping)
        return (predicted - measured.data) / self.sds, series, measured


def solve(fit):
    one = Windows(fit)
    sequences = [one.make_sequence(window) for window in range(len(fit.starts))]
    logging.disable(logging.WARNING)  # that the model has no sensors
    measured = sysid.ModelSequences(fit.folder.name, one.spec, *zip(*sequences), allow_missing_sensors=True)
    logging.disable(logging.NOTSET)
    residual = sysid.build_residual_fn(
        models_sequences=[measured],
        build_model=one.build,
        modify_residual=one.calc_residual,
        custom_rollout=one.roll,
        resample_true=False,
        n_threads=1,
    )
    found, result = sysid.optimize(one.make_parameters(), residual, verbose=False)
    _, intervals = sysid.calculate_intervals(residual(result.x, found)[0], result.jac)
    return result.x[: fit.shared], intervals[: fit.shared] / SDS_95, []


if __name__ == "__main__":
    answer(solve)
