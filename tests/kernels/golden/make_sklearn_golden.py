#!/usr/bin/python3
"""Writes sklearn_golden.hpp: values of scikit-learn 1.2.1 (Debian 12, python3-sklearn) for small problems.

    /usr/bin/python3 tests/kernels/golden/make_sklearn_golden.py > tests/kernels/golden/sklearn_golden.hpp

scikit-learn has no integrated-out mean: for those cases the same kernel matrices go through the formulas of
Rasmussen and Williams section 2.7 in plain numpy, with explicit inverses (the problems are well conditioned).
"""
import numpy as np
import sklearn
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, DotProduct, Matern, RationalQuadratic, WhiteKernel

D, N, M = 3, 12, 5
SIGNAL, NOISE, LINEAR, SHAPE = 1.3, 0.25, 0.4, 0.8


def stationary(name, scales):
    scale = scales if len(scales) > 1 else scales[0]
    return {
        "kSquaredExponential": lambda: RBF(scale),
        "kMatern32": lambda: Matern(scale, nu=1.5),
        "kMatern52": lambda: Matern(scale, nu=2.5),
        "kRationalQuadratic": lambda: RationalQuadratic(scales[0], SHAPE),
    }[name]()


def kernel_of(name, scales, linear):
    kernel = ConstantKernel(SIGNAL**2) * stationary(name, scales)
    if linear:
        kernel = kernel + ConstantKernel(LINEAR**2) * DotProduct(0.0, sigma_0_bounds="fixed")
    return kernel + WhiteKernel(NOISE**2)


def reorder(kernel, gradient, linear):
    """scikit-learn's order to length scales, signal, noise, shape, linear; variances to stddevs (factor 2)."""
    names = [h.name for h in kernel.hyperparameters if not h.fixed for _ in range(h.n_elements)]
    of = lambda end: [g for n, g in zip(names, gradient) if n.endswith(end)]
    constants = of("constant_value")
    result = of("length_scale") + [2 * constants[0]] + [2 * g for g in of("noise_level")]
    return result + of("alpha") + ([2 * constants[1]] if linear else [])


def basis(mean, x):
    columns = {"kZero": [], "kConstant": [np.ones(len(x))], "kLinear": [np.ones(len(x)), *x.T]}[mean]
    return np.array(columns).reshape(-1, len(x))  # p x n


def explicit(kernel, mean, x, y, z, linear):
    covariance, derivative = kernel(x, eval_gradient=True)
    inverse = np.linalg.inv(covariance)
    h, hz, p = basis(mean, x), basis(mean, z), len(basis(mean, x))
    a = h @ inverse @ h.T
    correction = inverse @ h.T @ np.linalg.inv(a) @ h @ inverse
    projector = inverse - correction
    alpha = projector @ y
    nlml = 0.5 * (
        y @ alpha + np.linalg.slogdet(covariance)[1] + np.linalg.slogdet(a)[1] + (len(y) - p) * np.log(2 * np.pi)
    )
    gradient = [
        0.5 * np.sum((projector - np.outer(alpha, alpha)) * derivative[:, :, i]) for i in range(derivative.shape[2])
    ]
    cross = kernel(z, x)
    b = np.linalg.solve(a, h @ inverse @ y)
    error = hz - h @ inverse @ cross.T
    variance = (
        kernel.diag(z) - np.sum(cross @ inverse * cross, axis=1) + np.sum(error * np.linalg.solve(a, error), axis=0)
    )
    return nlml, reorder(kernel, gradient, linear), cross @ alpha + hz.T @ b, np.sqrt(variance)


def from_sklearn(kernel, x, y, z, linear):
    model = GaussianProcessRegressor(kernel, alpha=0.0, optimizer=None).fit(x, y)
    value, gradient = model.log_marginal_likelihood(kernel.theta, eval_gradient=True, clone_kernel=False)
    mean, stddev = model.predict(z, return_std=True)
    return -value, reorder(kernel, -gradient, linear), mean, stddev


def braces(values):
    return "{" + ", ".join(repr(float(v)) for v in np.ravel(values)) + "}"


def main():
    rng = np.random.default_rng(20220101)
    x = rng.normal(size=(N, D))
    z = rng.normal(size=(M, D)) - x.mean(axis=0)
    x = x - x.mean(axis=0)
    y = np.sin(x[:, 0]) + 0.5 * x[:, 1] ** 2 - 0.3 * x[:, 2] + 0.1 * rng.normal(size=N)
    print(
        "// Written by make_sklearn_golden.py with scikit-learn",
        sklearn.__version__,
        "and numpy",
        np.__version__ + "; do not edit.",
    )
    print('#pragma once\n\n#include <vector>\n\n#include "kernels/gp/model.hpp"\n')
    print("namespace twinmap::gp::golden {\n")
    print(
        "struct Case {\n  const char* name;\n  CovarianceFunction covariance;\n  MeanFunction mean;\n"
        "  bool linear_term;\n  std::vector<int> groups;\n  std::vector<double> length_scales;\n"
        "  double nlml;\n  std::vector<double> gradient;\n  std::vector<double> predicted_mean;\n"
        "  std::vector<double> predicted_stddev;\n};\n"
    )
    print(f"constexpr int kFeatures = {D};\nconstexpr int kSamples = {N};\nconstexpr int kTests = {M};")
    print(
        f"constexpr double kSignalStddev = {SIGNAL};\nconstexpr double kNoiseStddev = {NOISE};\n"
        f"constexpr double kShape = {SHAPE};\nconstexpr double kLinearStddev = {LINEAR};\n"
    )
    for name, values in (("kInputs", x), ("kTestInputs", z), ("kTarget", y)):
        print(f"inline const std::vector<double> {name} = {braces(values)};")
    print("\n// clang-format off\ninline const std::vector<Case> kCases = {")
    for covariance in ("kSquaredExponential", "kMatern32", "kMatern52", "kRationalQuadratic"):
        for scales in ([1.7], [0.9, 1.4, 2.3]):
            if covariance == "kRationalQuadratic" and len(scales) > 1:
                continue  # scikit-learn has only the shared length scale
            for linear in (False, True):
                kernel = kernel_of(covariance, scales, linear)
                for mean in ("kZero", "kConstant", "kLinear"):
                    result = (
                        from_sklearn(kernel, x, y, z, linear)
                        if mean == "kZero"
                        else explicit(kernel, mean, x, y, z, linear)
                    )
                    groups = "{0, 1, 2}" if len(scales) > 1 else "{}"
                    label = f"{covariance}_{len(scales)}_{'linear' if linear else 'plain'}_{mean}"
                    print(
                        f'  {{"{label}", CovarianceFunction::{covariance}, MeanFunction::{mean}, '
                        f"{str(linear).lower()}, {groups}, {braces(scales)},\n   {float(result[0])!r}, "
                        f"{braces(result[1])},\n   {braces(result[2])},\n   {braces(result[3])}}},"
                    )
    print("};\n// clang-format on\n\n}  // namespace twinmap::gp::golden")


main()
