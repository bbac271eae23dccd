#!/usr/bin/python3
"""Writes transform_golden.hpp: transforms of scikit-learn 1.2.1 and numpy (Debian 12) on a small data set.

    /usr/bin/python3 tests/framework/data/features/golden/make_transform_golden.py \
        > tests/framework/data/features/golden/transform_golden.hpp

40 simulations, two noise draws each (draw by draw), 6 features with correlated noise, 2 parameters. Matrices are
written sample by sample.
"""
import numpy as np
import sklearn
from sklearn.cross_decomposition import PLSRegression
from sklearn.decomposition import PCA
from sklearn.feature_selection import mutual_info_regression
from sklearn.preprocessing import StandardScaler

FEATURES, SIMULATIONS, REPLICATES = 6, 40, 2
COMPONENTS, FOLDS = 3, 5


def make_data():
    rng = np.random.default_rng(20220101)
    parameters = rng.uniform(size=(SIMULATIONS, 2)) * [2.0, 300.0] + [1.0, 500.0]
    a, b = parameters[:, 0] - 2.0, (parameters[:, 1] - 650.0) / 150.0
    clean = np.column_stack([np.sin(2 * a), a * b, 3 * b + 40.0, np.exp(b), a + 0.2 * b, np.zeros(SIMULATIONS)])
    factor = 0.05 * (np.eye(FEATURES) + 0.5 * np.tril(rng.normal(size=(FEATURES, FEATURES))))
    noise = rng.normal(size=(REPLICATES * SIMULATIONS, FEATURES)) @ factor.T
    return np.tile(clean, (REPLICATES, 1)) + noise, np.tile(parameters, (REPLICATES, 1)), factor @ factor.T


def braces(values):
    return "{" + ", ".join(repr(v) for v in np.ravel(values).tolist()) + "}"


def write(name, values, kind="double"):
    print(f"inline const std::vector<{kind}> {name} = {braces(values)};")


def write_scalings(x, noise_covariance):
    write("kStandardised", StandardScaler().fit_transform(x) * np.sqrt((len(x) - 1) / len(x)))
    write("kWhitenedByStddev", x / np.sqrt(np.diag(noise_covariance)))
    write("kWhitenedByCovariance", np.linalg.solve(np.linalg.cholesky(noise_covariance), x.T).T)


def write_principal_components(x):
    model = PCA(COMPONENTS, svd_solver="full").fit(x)
    write("kPrincipalComponents", model.transform(x))
    write("kPrincipalVariances", model.explained_variance_)


def fit_pls(x, targets, components):
    """Without scaling of the features; the tolerance is that of the power iteration."""
    return PLSRegression(components, scale=False, tol=1e-30, max_iter=100000).fit(x, targets)


def write_partial_least_squares(x, y):
    targets = StandardScaler().fit_transform(y) * np.sqrt((len(y) - 1) / len(y))
    model = fit_pls(x, targets, COMPONENTS)
    write("kPartialLeastSquares", model.transform(x))
    write("kLinearPrediction", model.predict(x))
    simulation = np.arange(len(x)) % SIMULATIONS
    errors = []
    for fold in range(FOLDS):
        out = (simulation >= fold * SIMULATIONS // FOLDS) & (simulation < (fold + 1) * SIMULATIONS // FOLDS)
        for components in range(1, COMPONENTS + 1):
            error = targets[out] - fit_pls(x[~out], targets[~out], components).predict(x[out])
            errors.append(np.sum(error**2) / out.sum())
    write("kHeldOutErrors", errors)  # fold by fold


def write_mutual_information(x, y):
    """Of the first draw; feature by feature with each parameter, then with feature 0."""
    x, y = x[:SIMULATIONS], y[:SIMULATIONS]
    for name, target in (("kWithParameter0", y[:, 0]), ("kWithParameter1", y[:, 1])):
        write(name, mutual_info_regression(x, target, n_neighbors=3, random_state=0))
    write("kWithFeature0", mutual_info_regression(x[:, 1:], x[:, 0], n_neighbors=3, random_state=0))
    relevance = sum(mutual_info_regression(x, target, n_neighbors=3, random_state=0) for target in y.T)
    selected = [int(np.argmax(relevance))]
    while len(selected) < COMPONENTS:
        redundancy = [
            np.mean([mutual_info_regression(x[:, [i]], x[:, s], n_neighbors=3, random_state=0)[0] for s in selected])
            for i in range(FEATURES)
        ]
        score = relevance - np.array(redundancy)
        score[selected] = -np.inf
        selected.append(int(np.argmax(score)))
    write("kSelected", selected, "int")


def main():
    x, y, noise_covariance = make_data()
    print(
        "// Written by make_transform_golden.py with scikit-learn",
        sklearn.__version__,
        "and numpy",
        np.__version__ + "; do not edit.",
    )
    print("#pragma once\n\n#include <vector>\n\nnamespace twinmap::golden {\n\n// clang-format off")
    print(
        f"constexpr int kFeatureCount = {FEATURES};\nconstexpr int kReplicates = {REPLICATES};\n"
        f"constexpr int kComponents = {COMPONENTS};\nconstexpr int kFolds = {FOLDS};\n"
    )
    write("kFeatures", x)
    write("kParameters", y)
    write("kNoiseCovariance", noise_covariance)
    print()
    write_scalings(x, noise_covariance)
    write_principal_components(x)
    write_partial_least_squares(x, y)
    write_mutual_information(x, y)
    print("// clang-format on\n\n}  // namespace twinmap::golden")


main()
