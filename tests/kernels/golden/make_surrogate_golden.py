"""Writes surrogate_golden.hpp: processes with a trend, every point left out by fitting the others anew (numpy)."""
import numpy as np

NUGGET = 1e-3
LENGTH_SCALES = np.array([0.8, 1.7])


def covariance(kind, a, b):
    s = (((a[:, :, None] - b[:, None, :]) / LENGTH_SCALES[:, None, None]) ** 2).sum(axis=0)
    if kind == "kSquaredExponential":
        return np.exp(-s / 2)
    d = np.sqrt(5 * s)
    return (1 + d + 5 * s / 3) * np.exp(-d)


def terms(trend, points):
    rows = [np.ones(points.shape[1]), points[0], points[1]]
    if trend == "kQuadratic":
        rows += [points[0] ** 2, points[0] * points[1], points[1] ** 2]
    return np.array(rows)


def predict(kind, trend, points, values, at):
    """Mean (r) and variance, of a process of unit variance, of a new point with its nugget."""
    K = covariance(kind, points, points) + NUGGET * np.eye(points.shape[1])
    H, h, k = terms(trend, points), terms(trend, at)[:, 0], covariance(kind, points, at)[:, 0]
    Ki = np.linalg.inv(K)
    A = H @ Ki @ H.T
    beta = np.linalg.solve(A, H @ Ki @ values)
    rest = h - H @ Ki @ k
    mean = h @ beta + k @ Ki @ (values - H.T @ beta)
    return mean, 1 + NUGGET - k @ Ki @ k + rest @ np.linalg.solve(A, rest)


def leave_out(kind, trend, points, values):
    residual, variance = np.zeros_like(values), np.zeros(len(values))
    for i in range(len(values)):
        kept = np.arange(len(values)) != i
        mean, variance[i] = predict(kind, trend, points[:, kept], values[kept], points[:, [i]])
        residual[i] = values[i] - mean
    return residual, variance


def make(kind, trend, points, values, at):
    residual, variance = leave_out(kind, trend, points, values)
    amplitude = (residual**2 / variance[:, None]).mean(axis=0)
    total = 1 + np.outer(variance, amplitude)
    density = 0.5 * (np.log(total) + residual**2 / total).sum()
    mean, latent = predict(kind, trend, points, values, at)
    s = (((points - at) / LENGTH_SCALES[:, None]) ** 2).sum(axis=0)
    near = np.exp(-s / np.sort(s)[min(16, len(s)) - 1])
    ratio = (residual**2 / amplitude).mean(axis=1) / variance
    factor = ((near * ratio).sum() + 4) / (near.sum() + 4)
    return residual, variance, density, mean, np.sqrt(latent * factor * amplitude)


def show(values):
    return "{" + ", ".join(repr(float(v)) for v in np.ravel(values)) + "}"


def main():
    random = np.random.default_rng(7)
    points = random.uniform(-1, 1, (2, 20))
    at = np.array([[0.3], [-0.4]])
    values = np.array([3 * np.sin(2 * points[0] + points[1]), points[0] * points[1] ** 2, np.exp(points[1])]).T
    print("#pragma once\n\n// Written by make_surrogate_golden.py (numpy " + np.__version__ + "); matrices by rows.\n")
    print(
        '#include <vector>\n\n#include "kernels/surrogate/shared_covariance.hpp"\n\nnamespace twinmap::gp::golden {\n'
    )
    print(
        "struct SharedCase {\n  SharedStructure structure;\n  std::vector<double> residual, variance;\n"
        "  double density;\n  std::vector<double> mean, stddev;\n};\n"
    )
    print(f"inline const std::vector<double> kPoints{show(points)};\ninline const std::vector<double> kAt{show(at)};")
    print(f"inline const std::vector<double> kLengthScales{show(LENGTH_SCALES)};")
    print(f"constexpr double kNugget = {NUGGET!r};\ninline const std::vector<double> kValues{show(values)};")
    print("inline const std::vector<SharedCase> kCases{")
    for kind in ("kSquaredExponential", "kMatern52"):
        for trend in ("kLinear", "kQuadratic"):
            residual, variance, density, mean, stddev = make(kind, trend, points, values, at)
            print(
                f"{{{{SmoothCovariance::{kind}, Trend::{trend}}}, {show(residual)}, {show(variance)},\n"
                f" {float(density)!r}, {show(mean)}, {show(stddev)}}},"
            )
    print("};\n\n}  // namespace twinmap::gp::golden")


if __name__ == "__main__":
    main()
