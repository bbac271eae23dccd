"""mujoco.sysid of MuJoCo 4.0: parameters with modifiers, ModelSequences, build_residual_fn, optimize, calculate_intervals.

Documentation: the system identification page of MuJoCo and mujoco.sysid's docstrings and tests. modify_residual weighs each sample by its noise
and reads the state, since the sensors of a rollout are those before the step that their times follow. Forces are those in the
middle of a step, as MuJoCo holds them over it. Tried: RK4 with steps of 2 and of 1 ms, and implicitfast; RK4 at 1 ms is kept, from
the middle of the bounds, as its examples start.
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
from harness import SDS_95, Answer, answer_each

STEP = 1e-3
#: Of a normal distribution: the half width of a 50 % interval over that of a 95 % one.
HALF = 0.674490 / SDS_95


class Identification:
    def __init__(self, case):
        self.case, self.model, self.count = case, importlib.import_module(f"{case.name}_mujoco"), 0
        self.spec = mujoco.MjSpec.from_string(self.model.XML)
        self.spec.option.timestep = STEP
        self.spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4
        self.rows = np.round(np.array(case.times) / STEP).astype(int) - 1  # the first state is that after a step

    def make_parameters(self):
        parameters = sysid.ParameterDict()
        for name, lower, upper in zip(self.case.names, self.case.lower, self.case.upper):
            parameters.add(sysid.Parameter(name, (lower + upper) / 2, lower, upper))
        return parameters

    def build(self, parameters, spec):
        spec = spec.copy()
        self.model.modify(spec, {name: float(one.value[0]) for name, one in parameters.items()})
        return spec.compile()

    def make_sequence(self, trial, machine):
        model = self.spec.compile()
        table = np.loadtxt(self.case.files(machine)[trial], delimiter=",", skiprows=1)
        names = [(name, sysid.SignalType.CustomObs) for name in self.case.outputs]
        mapping = {name: (kind, np.array([i])) for i, (name, kind) in enumerate(names)}
        measured = sysid.TimeSeries(table[:, 0], table[:, 1:], mapping)
        times = np.arange(self.rows[-1] + 3) * STEP
        control = sysid.TimeSeries(times, self.model.control(times + STEP / 2, trial))
        state = sysid.create_initial_state(model, np.array(self.model.start(trial), float), np.zeros(model.nv))
        return str(trial), state, control, measured

    def calc_residual(self, parameters, _, measured, model, return_all, state=None, **rest):
        values = {name: float(one.value[0]) for name, one in parameters.items()}
        q, v = np.split(state[self.rows, 1 : 1 + 2 * model.nq], 2, axis=1)
        predicted = np.stack(self.model.observe(q, v, values), axis=1)
        self.count += 1
        sds = [1.0 if sd is None else sd for sd in self.case.noise]
        shown = sysid.TimeSeries(measured.times, predicted, measured.signal_mapping)
        return (predicted - measured.data) / sds, shown, measured


def prepare(case):
    return Identification(case), 0


def infer(case, machine, one):
    before = one.count
    sequences = [one.make_sequence(trial, machine) for trial in case.trials]
    logging.disable(logging.WARNING)  # that the model has no sensors
    measured = sysid.ModelSequences(case.name, one.spec, *zip(*sequences), allow_missing_sensors=True)
    logging.disable(logging.NOTSET)
    residual = sysid.build_residual_fn(
        models_sequences=[measured],
        build_model=one.build,
        modify_residual=one.calc_residual,
        resample_true=False,
        n_threads=1,
    )
    found, result = sysid.optimize(one.make_parameters(), residual, verbose=False)
    rest = residual(result.x, found)[0]
    _, intervals = sysid.calculate_intervals(rest, result.jac)
    mean = result.x
    bounds = lambda share: [[[m - share * w, m + share * w]] for m, w in zip(mean, intervals)]
    return Answer(mean, intervals / SDS_95, bounds(1), bounds(HALF), simulations=one.count - before)


if __name__ == "__main__":
    answer_each(prepare, infer)
