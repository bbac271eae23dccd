"""pyPESTO on twinmap's simulations for windows of a real recording: ten starts of least squares, profiles of the shared parameters.

`real_pypesto.py FOLDER RECORDING OUT START...`, as real_scipy.py; settings are those of pypesto_profiles.py.
"""
import numpy as np
import pypesto
from pypesto.optimize import ScipyOptimizer
from pypesto_profiles import profile
from real_scipy import answer


def solve(fit):
    np.random.seed(1)
    res = lambda x: fit.simulate(x[None])[0]
    fun = lambda x: 0.5 * np.sum(res(x) ** 2)
    sres = lambda x: fit.differentiate(x)  # a method would be copied with all that it knows
    grad = lambda x: sres(x).T @ res(x)
    objective = pypesto.Objective(fun=fun, grad=grad, res=res, sres=sres)
    problem = pypesto.Problem(objective, lb=fit.lower, ub=fit.upper)
    found, sd, _, said = profile(problem, ScipyOptimizer("ls_trf"), fit.names)
    return found, sd, said


if __name__ == "__main__":
    answer(solve)
