"""scikit-learn's Gaussian processes as a map: one a parameter, on 250 noisy simulations of twinmap.

Documentation: user guide 1.7 (Gaussian processes: RBF plus WhiteKernel, normalize_y, restarts), PCA and pipelines. Tried: one length
scale on standardised samples, and one a principal component of samples over their noise; the latter is kept.
"""
import sys
from pathlib import Path

import numpy as np
from scipy.stats import qmc
from sklearn.decomposition import PCA
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from harness import Answer, Simulations, answer_each

SAMPLES, COMPONENTS = 250, 10


def simulate(case):
    """Points and samples over their noise, with noise."""
    points = qmc.scale(qmc.LatinHypercube(len(case.lower), seed=1).random(SAMPLES), case.lower, case.upper)
    clean = Simulations(case)(points) / case.sds()
    return points, clean + np.random.default_rng(1).standard_normal(clean.shape)


def prepare(case):
    points, noisy = simulate(case)
    features = make_pipeline(PCA(COMPONENTS, random_state=1), StandardScaler())
    reduced, maps = features.fit_transform(noisy), []
    for column in points.T:
        kernel = ConstantKernel() * RBF(np.ones(COMPONENTS), (1e-2, 1e4)) + WhiteKernel(1e-2, (1e-8, 1e1))
        gp = GaussianProcessRegressor(kernel, normalize_y=True, n_restarts_optimizer=2, random_state=1)
        maps.append(gp.fit(reduced, column))
    return (features, maps), SAMPLES


def infer(case, machine, prepared):
    features, maps = prepared
    reduced = features.transform([case.read(machine) / case.sds()])
    found = [one.predict(reduced, return_std=True) for one in maps]
    return Answer(np.array([mean[0] for mean, _ in found]), np.array([sd[0] for _, sd in found]))


if __name__ == "__main__":
    answer_each(prepare, infer)
