#include "framework/estimation/posterior/residual_loss.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "framework/estimation/posterior/simulator_posterior.hpp"
#include "tests/framework/estimation/refined/problem.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::makeMatrix;
using testing::makeVector;
using testing::Problem;

TEST(ResidualLoss, WeightsHaveItsSlope) {
  const VectorXd residual = makeVector({0.3, -1.2, 4.5, -60.0, 2.0});
  constexpr double kStep = 1e-6;
  for (const LossKind kind : {LossKind::kPlain, LossKind::kUnknownNoise, LossKind::kOutliers}) {
    const VectorXd weights = calcLossWeights(kind, residual);
    for (Index i = 0; i < residual.size(); ++i) {
      VectorXd up = residual, down = residual;
      up[i] += kStep;
      down[i] -= kStep;
      EXPECT_NEAR((calcLoss(kind, up) - calcLoss(kind, down)) / (2.0 * kStep), 2.0 * weights[i] * residual[i],
                  1e-6);
    }
  }
}

TEST(ResidualLoss, TellsOutliersFromNoise) {
  const VectorXd weights = calcLossWeights(LossKind::kOutliers, makeVector({0.0, 2.0, 3.0, 20.0, 500.0}));
  EXPECT_GT(weights.head(3).minCoeff(), 0.9);
  EXPECT_LT(weights.tail(2).maxCoeff(), 0.01);
}

/// A straight line's two coefficients from 40 samples.
Problem makeLine(const MatrixXd& matrix) {
  return Problem(
      static_cast<int>(matrix.rows()), [matrix](const VectorXd& x) -> VectorXd { return matrix * x; },
      testing::makeParameters(2, -1.0, 1.0), 0.05);
}

SimulatorPosterior sampleWith(Problem& problem, const VectorXd& features, LossKind loss) {
  SimulatorPosteriorOptions options;
  options.draws = 4000;
  PosteriorProblem posed{problem.model.getUnknown(), {}, {}, 2};
  posed.trials.push_back({&problem.simulator, &problem.model, features, VectorXd::Zero(2), {0, 1}, loss});
  return samplePosterior(posed, MatrixXd(2, 0), options);
}

TEST(ResidualLoss, UnknownNoiseGivesStudentsDistribution) {
  const MatrixXd matrix = makeMatrix(12, 2);
  Problem problem = makeLine(matrix);
  const VectorXd features = problem.measure(makeVector({0.1, -0.2}), 0.15);  // three times what is stated
  const SimulatorPosterior posterior = sampleWith(problem, features, LossKind::kUnknownNoise);
  ASSERT_TRUE(posterior.isReliable()) << posterior.message;
  const Eigen::Matrix2d inverse = Eigen::Matrix2d(matrix.transpose() * matrix).inverse();
  const VectorXd mean = inverse * matrix.transpose() * features;
  // location and scale of least squares, n - 2 = 10 degrees of freedom: variance 10 / 8 times s^2
  const double variance = (features - matrix * mean).squaredNorm() / 8.0;
  for (Index j = 0; j < 2; ++j) {
    const double stddev = std::sqrt(variance * inverse(j, j));
    EXPECT_NEAR(posterior.mean[j], mean[j], 0.06 * stddev);
    EXPECT_NEAR(posterior.stddev[j] / stddev, 1.0, 0.06);
  }
}

TEST(ResidualLoss, SpikesCountForNothing) {
  const MatrixXd matrix = makeMatrix(40, 2);
  Problem problem = makeLine(matrix);
  const VectorXd clean = problem.measure(makeVector({0.1, -0.2}), 0.05);
  VectorXd spiked = clean;
  spiked[7] += 5.0;
  spiked[22] -= 20.0;
  const SimulatorPosterior without = sampleWith(problem, clean, LossKind::kPlain);
  const SimulatorPosterior with = sampleWith(problem, spiked, LossKind::kOutliers);
  ASSERT_TRUE(with.isReliable()) << with.message;
  for (Index j = 0; j < 2; ++j) {
    EXPECT_NEAR(with.mean[j], without.mean[j], 0.7 * without.stddev[j]);
    EXPECT_NEAR(with.stddev[j] / without.stddev[j], 1.0, 0.15);
  }
}

}  // namespace
}  // namespace twinmap
