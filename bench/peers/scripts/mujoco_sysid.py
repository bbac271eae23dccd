"""mujoco.sysid of MuJoCo 4.0: parameters with modifiers, ModelSequences, build_residual_fn, optimize, calculate_intervals.

Documentation: the system identification page of MuJoCo and mujoco.sysid's docstrings and tests. modify_residual weighs each sample by its noise
and reads the state, since the sensors of a rollout are those before the step that their times follow. Forces are those in the
middle of a step, as MuJoCo holds them over it. Tried: RK4 with steps of 2 and of 1 ms, and implicitfast; RK4 at 1 ms is kept where a
model names no STEP, from the middle of the bounds, as its examples start, or from the middle of the priors, which are rows of the residual.
What MJCF has no element for stands in a model's act (mjcb_control) and rub (mjcb_passive).
"""
import collections
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
#: What a model observes: rows of the state.
States = collections.namedtuple("States", "t q v act")
#: Of a normal distribution: the half width of a 50 % interval over that of a 95 % one.
HALF = 0.674490 / SDS_95


class Identification:
    def __init__(self, case):
        self.case, self.model, self.count = case, importlib.import_module(f"{case.name}_mujoco"), 0
        self.spec = mujoco.MjSpec.from_string(self.model.XML)
        self.step = getattr(self.model, "STEP", STEP)
        self.spec.option.timestep = self.step
        self.spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4
        self.rows = np.round(np.array(case.times) / self.step).astype(int) - 1  # the first state is that after a step

    def make_parameters(self):
        parameters = sysid.ParameterDict()
        for name, lower, upper, prior in zip(self.case.names, self.case.lower, self.case.upper, self.case.priors):
            parameters.add(sysid.Parameter(name, prior[0] if prior else (lower + upper) / 2, lower, upper))
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
        times = np.arange(self.rows[-1] + 3) * self.step
        control = sysid.TimeSeries(times, self.model.control(times + self.step / 2, trial))
        state = sysid.create_initial_state(model, np.array(self.model.start(trial), float), np.zeros(model.nv))
        return str(trial), state, control, measured

    def roll(self, param_dicts, **rest):
        """With the model's callbacks, which MuJoCo's compiler must not meet."""
        mujoco.set_mjcb_control(getattr(self.model, "act", None))
        mujoco.set_mjcb_passive(getattr(self.model, "rub", None))
        try:
            return sysid.sysid_rollout(**rest)
        finally:
            mujoco.set_mjcb_control(None)
            mujoco.set_mjcb_passive(None)

    def calc_residual(self, parameters, _, measured, model, return_all, state=None, **rest):
        values = {name: float(one.value[0]) for name, one in parameters.items()}
        shown = np.split(state[self.rows], np.cumsum([1, model.nq, model.nv, model.na]), axis=1)
        predicted = np.stack(self.model.observe(States(shown[0][:, 0], *shown[1:4]), values), axis=1)
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
    simulated = sysid.build_residual_fn(
        models_sequences=[measured],
        build_model=one.build,
        modify_residual=one.calc_residual,
        custom_rollout=one.roll,
        resample_true=False,
        n_threads=1,
    )

    def residual(x, parameters, **options):
        rows, *rest = simulated(x, parameters, **options)
        return [*rows, case.depart(x)], *rest

    found, result = sysid.optimize(one.make_parameters(), residual, verbose=False)
    _, intervals = sysid.calculate_intervals(residual(result.x, found)[0], result.jac)
    mean = result.x
    bounds = lambda share: [[[m - share * w, m + share * w]] for m, w in zip(mean, intervals)]
    return Answer(mean, intervals / SDS_95, bounds(1), bounds(HALF), simulations=one.count - before)


if __name__ == "__main__":
    answer_each(prepare, infer)
