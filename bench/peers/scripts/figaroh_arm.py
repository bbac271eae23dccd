"""FIGAROH's torque regression of the seven-joint arm: angles by splines, torques by the drives' law, a regressor of Pinocchio's.

Documentation: as figaroh_emps.py. Its regression finds base parameters from torques that are known. Here the gains of the drives are
parameters, and what has a prior is to be named: SciPy's least_squares takes the regressor to the 40 parameters, with priors as rows and
the noise of each joint from its residual. Tried: differences as in figaroh_emps.py and quintic splines; the latter are kept, as ten
samples a second are few for differences.
"""
import sys
import tempfile
from pathlib import Path

import numpy as np
from figaroh.tools.regressor import RegressorBuilder, RegressorConfig
from figaroh.tools.robot import Robot
from scipy.interpolate import make_interp_spline
from scipy.optimize import least_squares

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parent / "models")]
from harness import Answer, answer_each
from seven_joint_arm_figaroh import KD, KP, URDF, calc_reference, list_standard

#: Samples at either end, where splines are loose.
EDGE = 5


class Regression:
    """Rows of one machine: the drive's u less (Y theta(p) + b qd + f tanh(qd / 0.1)) / g, joint by joint.

    Over g, as a residual of torques g u would be least with all parameters small."""

    def __init__(self, case, machine):
        with tempfile.TemporaryDirectory() as folder:
            urdf = Path(folder) / "arm.urdf"
            urdf.write_text(URDF)
            robot = Robot(str(urdf), package_dirs=folder)
        builder = RegressorBuilder(robot, RegressorConfig())
        self.names, parts = case.names, []
        for trial, file in case.files(machine).items():
            table = np.loadtxt(file, delimiter=",", skiprows=1)
            t, angles = table[:, 0], make_interp_spline(table[:, 0], table[:, 1:], k=5)
            q, dq, ddq = (
                angles.derivative(order)(t)[EDGE:-EDGE] if order else angles(t)[EDGE:-EDGE] for order in range(3)
            )
            drive = np.array(KP) * (calc_reference(t[EDGE:-EDGE], trial) - q) - np.array(KD) * dq
            regressor = builder.build_basic_regressor(q, dq, ddq, {"act_idxv": list(range(7))})
            parts.append((regressor.reshape(7, len(q), -1), dq.T, drive.T))
        self.regressor, self.speed, self.drive = (np.concatenate(part, axis=1) for part in zip(*parts))

    def calc_residual(self, x):
        p = dict(zip(self.names, x))
        column = lambda name: np.array([p[f"{name}{i}"] for i in range(1, 8)])[:, None]
        friction = column("b") * self.speed + column("f") * np.tanh(self.speed / 0.1)
        return self.drive - (self.regressor @ list_standard(p) + friction) / column("g")


def prepare(case):
    return None, 0


def infer(case, machine, _):
    one, noise = Regression(case, machine), np.ones((7, 1))
    x = np.array(case.priors)[:, 0]
    for _ in range(3):
        rows = lambda x: np.append((one.calc_residual(x) / noise).ravel(), case.depart(x))
        best = least_squares(rows, x, bounds=(case.lower, case.upper), x_scale=case.upper - case.lower)
        x, noise = best.x, one.calc_residual(best.x).std(axis=1, keepdims=True)
    sd = np.sqrt(np.diag(np.linalg.inv(best.jac.T @ best.jac)))
    return Answer(x, sd, warnings=["at a bound"] if np.any(best.active_mask) else [])


if __name__ == "__main__":
    answer_each(prepare, infer)
