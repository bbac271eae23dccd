#!/usr/bin/python3
"""Compares the kernels with scikit-learn on the two-beam data, in alternation, and prints the ratios.

    OMP_NUM_THREADS=1 /usr/bin/python3 bench/compare_sklearn.py build/release/bench/kernels/kernels_compare_server

Both work on the same numbers (z-scored features, targets of zero mean and unit variance, zero prior mean) from
the same start. OMP_NUM_THREADS bounds the BLAS under NumPy; --threads sets both sides' threads for training.
"""
import argparse
import os
import statistics
import subprocess
import tempfile
import time
import warnings

import numpy as np
import sklearn
from sklearn.exceptions import ConvergenceWarning
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel


class Kernels:
    """The compare server, one command a line."""

    def __init__(self, program):
        self.process = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def ask(self, *words):
        self.process.stdin.write(" ".join(map(str, words)) + "\n")
        self.process.stdin.flush()
        return [float(word) for word in self.process.stdout.readline().split()]

    def data(self, n, features):
        with tempfile.NamedTemporaryFile() as file:
            self.ask("data", file.name, n, features)
            values = np.fromfile(file.name)
        return values[: n * features].reshape(n, features), values[n * features :].reshape(n, 4)


def make_kernel(scale):
    return ConstantKernel(1.0, (1e-4, 1e6)) * RBF(scale, (1e-2, 1e5)) + WhiteKernel(0.3**2, (1e-10, 1e1))


def time_evaluation(x, y, ard, repeats):
    scale = np.sqrt(1.5 * x.shape[1])
    kernel = make_kernel(np.full(x.shape[1], scale) if ard else scale)
    model = GaussianProcessRegressor(kernel, alpha=0.0, optimizer=None).fit(x, y[:, 0])
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        value, _ = model.log_marginal_likelihood(kernel.theta, eval_gradient=True, clone_kernel=False)
        times.append(1e3 * (time.perf_counter() - start))
    return statistics.median(times), -value


def time_training(x, y):
    sample = x[:: max(1, len(x) // 128)]
    distances = np.sqrt(((sample[:, None, :] - sample[None, :, :]) ** 2).sum(-1))
    scale = np.median(distances[np.triu_indices(len(sample), 1)])
    start = time.perf_counter()
    models = [GaussianProcessRegressor(make_kernel(scale), alpha=0.0).fit(x, y[:, t]) for t in range(4)]
    return time.perf_counter() - start, [-m.log_marginal_likelihood_value_ for m in models], models


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    warnings.simplefilter("ignore", ConvergenceWarning)
    kernels = Kernels(options.program)
    print(
        f"scikit-learn {sklearn.__version__}, NumPy {np.__version__}, "
        f"OMP_NUM_THREADS={os.environ.get('OMP_NUM_THREADS', 'unset')}, {os.cpu_count()} CPUs"
    )

    print("\nNLML + gradient, one thread [ms]      twinmap   scikit-learn   ratio")
    for n, ard, repeats in ((250, 0, 20), (250, 1, 3), (1000, 0, 3), (1000, 1, 1)):
        x, y = kernels.data(n, 200)
        ours, theirs = [], []
        for _ in range(options.rounds if n == 250 else 2):
            ours.append(kernels.ask("evaluate", n, 200, ard, 5 * repeats))
            theirs.append(time_evaluation(x, y, ard, repeats))
        assert abs(ours[0][1] - theirs[0][1]) < 1e-7 * abs(theirs[0][1]), "the NLMLs differ"
        a, b = (statistics.median(value[0] for value in side) for side in (ours, theirs))
        print(
            f"n = {n:4}, {'200 length scales' if ard else 'isotropic        '}         {a:9.3f}   {b:12.2f}   {b / a:5.1f}"
        )

    x, y = kernels.data(250, 200)
    ours, theirs = [], []
    for _ in range(options.rounds):
        ours.append(kernels.ask("train", 250, 200, 1, options.threads))
        theirs.append(time_training(x, y))
    a, b = (statistics.median(value[0] for value in side) for side in (ours, theirs))
    print(f"\nTraining four maps, n = 250, isotropic, one start, {options.threads} thread(s) [s]")
    print(f"{a:.4f} against {b:.3f}: ratio {b / a:.1f}")
    many = []
    for _ in range(options.rounds):
        many.append(kernels.ask("train", 250, 200, 2, options.threads))
    default = statistics.median(value[0] for value in many)
    print(f"(with the default two starts {default:.4f}: ratio {b / default:.1f})")
    for t in range(4):
        print(
            f"  NLML of target {t}: one start {ours[0][1 + t]:.4f}, two starts {many[0][1 + t]:.4f}, "
            f"scikit-learn {theirs[0][1][t]:.4f}"
        )

    models = theirs[0][2]
    times = []
    for i in range(200):
        start = time.perf_counter()
        for model in models:
            model.predict(x[i : i + 1], return_std=True)
        times.append(1e6 * (time.perf_counter() - start))
    theirs_online = statistics.median(times)
    print("\nFour means and stddevs from one feature vector, n = 250 [us]   median     p99")
    for features, ard in ((15, 0), (15, 1), (200, 0), (200, 1)):
        median, p99 = kernels.ask("online", 250, features, ard, 20000)
        print(
            f"twinmap, {features:3} features, {'per feature' if ard else 'shared     '}                        {median:9.1f} {p99:9.1f}"
        )
    print(f"scikit-learn, 200 features, shared                     {theirs_online:14.1f}")


main()
