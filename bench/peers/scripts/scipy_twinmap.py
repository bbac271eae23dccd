"""scipy.optimize.least_squares on twinmap's simulations, from eight starts, with the covariance of its Jacobian.

Priors are rows of the residual; where all have one, their means are the one start.

Documentation: least_squares (bounds, x_scale, method trf), curve_fit (covariance by the Jacobian), the cookbook's robust regression
(loss soft_l1). Unknown noise: its scale is the residual's median absolute deviation, and the fit is repeated with it twice.
Tried: losses linear and soft_l1 where the noise is unknown (the latter is kept), one start and eight.
"""
import sys
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import median_abs_deviation, qmc

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from harness import Answer, Simulations, answer_each

STARTS = 8


def prepare(case):
    starts = qmc.scale(qmc.LatinHypercube(len(case.lower), seed=1).random(STARTS), case.lower, case.upper)
    if all(case.priors):
        starts = [np.array(case.priors)[:, 0]]
    return (Simulations(case), starts), 0


def fit(simulate, measured, sds, starts, case, loss="linear"):
    """The best of all starts."""
    priors = case.depart(np.eye(len(case.lower))) - case.depart(np.zeros((len(case.lower), 1)))
    found = [
        least_squares(
            lambda x: np.append((simulate(x) - measured) / sds, case.depart(x)),
            start,
            lambda x: np.asfortranarray(np.vstack([simulate.differentiate(x) / sds[:, None], priors])),
            (case.lower, case.upper),
            x_scale=case.upper - case.lower,
            loss=loss,
        )
        for start in starts
    ]
    return min(found, key=lambda one: one.cost)


def infer(case, machine, prepared):
    simulate, starts = prepared
    before, measured, sds = simulate.count, case.read(machine), case.sds()
    best = fit(simulate, measured, sds, starts, case)
    for _ in range(0 if case.is_noise_known() else 2):
        sds = np.full_like(sds, median_abs_deviation(simulate(best.x) - measured, scale="normal"))
        best = fit(simulate, measured, sds, [best.x], case, "soft_l1")
    _, s, vt = np.linalg.svd(best.jac, full_matrices=False)
    said = [] if best.success else [best.message]
    said += ["at a bound"] if np.any(best.active_mask) else []
    sd = np.sqrt(np.diag((vt.T / s**2) @ vt))
    return Answer(best.x, sd, warnings=said, simulations=simulate.count - before)


if __name__ == "__main__":
    answer_each(prepare, infer)
