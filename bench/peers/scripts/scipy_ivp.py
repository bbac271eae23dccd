"""scipy.optimize.least_squares on scipy.integrate.solve_ivp, the equations of motion in Python, from three starts.

Documentation: solve_ivp (LSODA switches between stiff and not; rtol and atol below the noise; restarted where a force jumps),
least_squares (bounds, x_scale, differences of 2 points), curve_fit (covariance). Tried: RK45 and LSODA, the latter is kept, as
friction and windings are stiff. Outliers and unknown noise as in scipy_twinmap.py.
"""
import importlib
import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares
from scipy.stats import median_abs_deviation, qmc

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parent / "models")]
from harness import Answer, answer_each

STARTS, RELATIVE, ABSOLUTE = 3, 1e-8, 1e-10


class Simulate:
    def __init__(self, case):
        self.case, self.model, self.count = case, importlib.import_module(f"{case.name}_ode"), 0

    def integrate(self, p, trial):
        """From break to break of the forces."""
        model, times, state = self.model, np.array(self.case.times), self.model.start(p, trial)
        ends = [0.0, *model.BREAKS, times[-1] + 1e-9]
        states = []
        for begin, end in zip(ends, ends[1:]):
            here = times[(times > begin) & (times <= end)]
            found = solve_ivp(
                model.derive,
                (begin, end),
                state,
                "LSODA",
                t_eval=np.append(here[here < end], end),
                args=(p, trial),
                rtol=RELATIVE,
                atol=ABSOLUTE,
                max_step=0.05,
            )
            if not found.success:
                raise RuntimeError(found.message)
            states.append(found.y[:, : len(here)])
            state = found.y[:, -1]
        return np.hstack(states)

    def __call__(self, x):
        self.count += 1
        p, times = dict(zip(self.case.names, x)), np.array(self.case.times)
        rows = []
        for trial in self.case.trials:
            states = self.integrate(p, trial)
            rows += zip(*[self.model.observe(t, s, p) for t, s in zip(times, states.T)])
        return np.concatenate(rows)


def prepare(case):
    starts = qmc.scale(qmc.LatinHypercube(len(case.lower), seed=1).random(STARTS), case.lower, case.upper)
    return (Simulate(case), starts), 0


def fit(simulate, measured, sds, starts, case, loss="linear"):
    """The best of all starts."""
    found = [
        least_squares(
            lambda x: (simulate(x) - measured) / sds,
            start,
            bounds=(case.lower, case.upper),
            x_scale=case.upper - case.lower,
            diff_step=1e-5,
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
