#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>

#include "kernels/gp/fit.hpp"
#include "kernels/gp/online/online_predictor.hpp"
#include "tests/kernels/support/random_data.hpp"

namespace twinmap::gp {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::randomMatrix;

struct Problem {
  MatrixXd inputs;
  VectorXd target;
  MatrixXd tests;
  ModelStructure structure;
  Hyperparameters hyperparameters;
};

Problem arbitraryProblem() {
  const int d = *rc::gen::inRange(2, 7);
  const int n = *rc::gen::inRange(12, 60);
  const auto seed = *rc::gen::arbitrary<std::uint32_t>();
  Problem problem;
  problem.inputs = randomMatrix(d, n, seed);
  problem.target = test::smoothTarget(problem.inputs, 0.1, seed + 1);
  problem.tests = 2.0 * randomMatrix(d, 20, seed + 2);
  problem.structure.covariance = static_cast<CovarianceFunction>(*rc::gen::inRange(0, 4));
  problem.structure.mean = static_cast<MeanFunction>(*rc::gen::inRange(0, 3));
  problem.structure.linear_term = *rc::gen::arbitrary<bool>();
  const int groups = *rc::gen::inRange(1, d + 1);
  problem.structure.length_scale_groups = test::cyclicGroups(d, groups);
  problem.hyperparameters.length_scales = 1.2 * VectorXd::Ones(groups) + randomMatrix(groups, 1, seed + 3);
  problem.hyperparameters.signal_stddev = 0.1 * *rc::gen::inRange(1, 30);
  problem.hyperparameters.noise_stddev = 0.01 * *rc::gen::inRange(1, 100);
  problem.hyperparameters.shape = 0.1 * *rc::gen::inRange(1, 50);
  return problem;
}

Prediction predict(const Problem& problem) {
  return fit(problem.inputs, problem.target, problem.structure, problem.hyperparameters)
      ->predict(problem.tests);
}

RC_GTEST_PROP(GaussianProcess, VarianceLiesBetweenZeroAndThePrior, ()) {
  Problem problem = arbitraryProblem();
  problem.structure.mean = MeanFunction::kZero;  // a flat mean's prior variance is infinite
  const Hyperparameters& h = problem.hyperparameters;
  const VectorXd center = problem.inputs.rowwise().mean();
  const Prediction prediction = predict(problem);
  for (Eigen::Index i = 0; i < problem.tests.cols(); ++i) {
    double prior = h.signal_stddev * h.signal_stddev;
    if (problem.structure.linear_term) {
      prior += h.linear_stddev * h.linear_stddev * (problem.tests.col(i) - center).squaredNorm();
    }
    RC_ASSERT(prediction.latent_variance(i) >= 0.0);
    RC_ASSERT(prediction.latent_variance(i) <= prior * (1.0 + 1e-12));
    const double expected = prediction.latent_variance(i) + h.noise_stddev * h.noise_stddev;
    RC_ASSERT(std::abs(prediction.variance(i) - expected) <= 1e-15 * expected);
  }
}

RC_GTEST_PROP(GaussianProcess, DoesNotDependOnTheOrderOfTheSamples, ()) {
  Problem problem = arbitraryProblem();
  const Prediction before = predict(problem);
  std::vector<int> order(problem.target.size());
  std::iota(order.begin(), order.end(), 0);
  std::rotate(order.begin(), order.begin() + *rc::gen::inRange(1, 10), order.end());
  std::swap(order.front(), order[order.size() / 2]);
  Problem permuted = problem;
  for (std::size_t i = 0; i < order.size(); ++i) {
    permuted.inputs.col(i) = problem.inputs.col(order[i]);
    permuted.target(i) = problem.target(order[i]);
  }
  const Prediction after = predict(permuted);
  // Rounding, amplified by at most n s_f^2 / s_n^2 < 60 * 9 / 1e-4.
  const double tolerance = 1e-15 * 60.0 * 9e4 * 10.0;
  RC_ASSERT((before.mean - after.mean).cwiseAbs().maxCoeff() < tolerance * 10.0);
  RC_ASSERT((before.variance - after.variance).cwiseAbs().maxCoeff() < tolerance * 10.0);
}

RC_GTEST_PROP(GaussianProcess, DoesNotDependOnTheOrderOfFeaturesOrAShift, ()) {
  Problem problem = arbitraryProblem();
  const Prediction before = predict(problem);
  Problem changed = problem;
  changed.inputs = problem.inputs.colwise().reverse().array() + 3.0;
  changed.tests = problem.tests.colwise().reverse().array() + 3.0;
  std::reverse(changed.structure.length_scale_groups.begin(), changed.structure.length_scale_groups.end());
  const Prediction after = predict(changed);
  RC_ASSERT((before.mean - after.mean).cwiseAbs().maxCoeff() < 1e-7);
  RC_ASSERT((before.variance - after.variance).cwiseAbs().maxCoeff() < 1e-7);
}

RC_GTEST_PROP(GaussianProcess, InterpolatesWithoutNoise, ()) {
  Problem problem = arbitraryProblem();
  problem.hyperparameters.noise_stddev = 1e-5;
  problem.hyperparameters.signal_stddev = 1.0;
  problem.tests = problem.inputs;
  const Prediction prediction = predict(problem);
  // At a training point the posterior mean misses by s_n^2 alpha, and its variance is below s_n^2.
  const auto gp = fit(problem.inputs, problem.target, problem.structure, problem.hyperparameters);
  const VectorXd miss = (prediction.mean - problem.target).cwiseAbs();
  const double noise_variance = 1e-10 + gp->getParts().jitter;
  // Both to the rounding of k'alpha: eps |k|_1 |alpha|_1.
  const double rounding = 1e-14 * gp->getAlpha().lpNorm<1>() * problem.hyperparameters.signal_stddev;
  RC_ASSERT((miss.array() <= noise_variance * gp->getAlpha().cwiseAbs().array() + rounding + 1e-9).all());
  RC_ASSERT(prediction.latent_variance.maxCoeff() <= noise_variance + 1e-9);
}

RC_GTEST_PROP(OnlinePredictor, AgreesWithTheBatchPrediction, ()) {
  Problem problem = arbitraryProblem();
  const auto one = fit(problem.inputs, problem.target, problem.structure, problem.hyperparameters);
  const auto two = fit(problem.inputs, -2.0 * problem.target, problem.structure, problem.hyperparameters);
  const OnlinePredictor predictor({one, two});
  OnlinePredictor::Workspace workspace(predictor);
  const OnlinePredictor::Values& values = workspace.values;
  const Prediction expected = one->predict(problem.tests);
  const MatrixXd gradient = one->getMean().predictMeanGradient(problem.tests);
  for (Eigen::Index i = 0; i < problem.tests.cols(); ++i) {
    predictor.predictWithGradient(problem.tests.col(i), workspace);
    RC_ASSERT(std::abs(values.mean(0) - expected.mean(i)) < 1e-8);
    RC_ASSERT(std::abs(values.mean(1) + 2.0 * expected.mean(i)) < 2e-8);
    RC_ASSERT(std::abs(values.stddev(0) - std::sqrt(expected.variance(i))) < 1e-7);
    const VectorXd mean = values.mean;
    predictor.predictMean(problem.tests.col(i), workspace);
    RC_ASSERT(values.mean == mean);
    RC_ASSERT((values.gradient.col(0) - gradient.col(i)).norm() < 1e-7 * (1.0 + gradient.col(i).norm()));
  }
}

}  // namespace
}  // namespace twinmap::gp
