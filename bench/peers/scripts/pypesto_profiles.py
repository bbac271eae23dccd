"""pyPESTO on twinmap's simulations: ten starts of least squares, then profile likelihoods, whose 95 and 50 % intervals it gives.

Documentation: notebooks getting_started, rosenbrock and profiles (Objective of functions, ScipyOptimizer, minimize,
parameter_profile, calculate_approximate_ci). Unknown noise is a parameter, as its noise-estimation examples do. Tried: optimizers
ls_trf on residuals and L-BFGS-B on the likelihood; the former is kept where the noise is known.
"""
import sys
from pathlib import Path

import numpy as np
import pypesto
from pypesto.optimize import ScipyOptimizer, minimize
from pypesto.profile import ProfileOptions, calculate_approximate_ci, chi2_quantile_to_ratio, parameter_profile

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from harness import SDS_95, Answer, Simulations, answer_each

STARTS = 10
#: Shares of the bounds: the defaults are 0.02 of a parameter's unit at least, wider than posteriors here.
STEPS = ProfileOptions(
    default_step_size_absolute=0,
    default_step_size_relative=1e-4,
    min_step_size_relative=1e-6,
    max_step_size_relative=5e-2,
    step_size_precheck_mode="off",
)
#: The defaults, for a profile that is flat up to the bounds: STEPS take some 10000 fits along it.
WIDE_STEPS = ProfileOptions(default_step_size_absolute=0, step_size_precheck_mode="off")


def prepare(case):
    return Simulations(case), 0


def make_known(case, simulate, measured):
    sds = case.sds()
    res = lambda x: (simulate(x) - measured) / sds
    sres = lambda x: simulate.differentiate(x) / sds[:, None]
    fun = lambda x: 0.5 * np.sum(res(x) ** 2)
    grad = lambda x: sres(x).T @ res(x)
    objective = pypesto.Objective(fun=fun, grad=grad, res=res, sres=sres)
    problem = pypesto.Problem(objective, lb=case.lower, ub=case.upper, x_names=case.names)
    return problem, ScipyOptimizer("ls_trf")


def make_unknown(case, simulate, measured):
    """The last parameter is the logarithm of the noise's sd."""
    spread = np.log(measured.std())

    def fun(x):
        rest = (simulate(x[:-1]) - measured) / np.exp(x[-1])
        return 0.5 * np.sum(rest**2) + len(measured) * x[-1]

    def grad(x):
        rest = (simulate(x[:-1]) - measured) / np.exp(x[-1])
        slopes = simulate.differentiate(x[:-1]) / np.exp(x[-1])
        return np.append(slopes.T @ rest, len(measured) - np.sum(rest**2))

    bounds = np.append(case.lower, spread - 12), np.append(case.upper, spread)
    objective = pypesto.Objective(fun=fun, grad=grad)
    return pypesto.Problem(objective, *bounds, x_names=[*case.names, "log_sd"]), ScipyOptimizer("L-BFGS-B")


def choose_steps(problem, best):
    """Of each parameter: wide where the Jacobian leaves its sd as wide as its bounds."""
    if best.sres is None:
        return [STEPS] * len(best.x)
    _, s, vt = np.linalg.svd(best.sres, full_matrices=False)
    sds = np.sqrt(np.diag((vt.T / s**2) @ vt))
    return [WIDE_STEPS if sd > width else STEPS for sd, width in zip(sds, problem.ub - problem.lb)]


def profile(problem, optimizer, names):
    """Best values, sds, intervals by level, and what is said, of the parameters that are named, which are the first."""
    result = minimize(problem, optimizer, n_starts=STARTS, progress_bar=False)
    count, steps = len(names), choose_steps(problem, result.optimize_result.list[0])
    for i in range(count):
        options = {"profile_index": np.array([i]), "profile_options": steps[i], "profile_list": 0 if i else None}
        result = parameter_profile(problem, result, optimizer, progress_bar=False, **options)
    intervals = {95: [], 50: []}
    for level, bounds in intervals.items():
        for i, one in enumerate(result.profile_result.list[0][:count]):
            ratio = chi2_quantile_to_ratio(level / 100)
            lower, upper = calculate_approximate_ci(one.x_path[i], one.ratio_path, ratio)
            bounds.append([[float(lower), float(upper)]])
    sd = np.diff(np.array(intervals[95])[:, 0], axis=1)[:, 0] / (2 * SDS_95)
    found = np.array(result.optimize_result.list[0].x)[:count]
    at = [name for name, x, a, b in zip(names, found, problem.lb, problem.ub) if not a < x < b]
    return found, sd, intervals, [f"{name} at a bound" for name in at]


def infer(case, machine, simulate):
    np.random.seed(machine)
    before, measured = simulate.count, case.read(machine)
    make = make_known if case.is_noise_known() else make_unknown
    problem, optimizer = make(case, simulate, measured)
    found, sd, intervals, said = profile(problem, optimizer, case.names)
    return Answer(found, sd, intervals[95], intervals[50], said, simulate.count - before)


if __name__ == "__main__":
    answer_each(prepare, infer)
