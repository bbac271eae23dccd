#include "framework/diagnosis/remainder/process_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kResiduals = 60, kParameters = 2, kKnots = 9;
constexpr double kVariance = 4.0, kLength = 0.3;

double wave(Index i, Index j, double phase) {
  return std::sin(0.37 * static_cast<double>(i * (j + 1)) + phase * static_cast<double>(j));
}

/// A recording whose residual is that of a process of known values and two parameters 0.
FittedRecording makeRecording(double phase) {
  FittedRecording recording;
  recording.half_widths = VectorXd::Constant(kParameters, 1e6);
  recording.linear.jacobian = MatrixXd::NullaryExpr(
      kResiduals, kParameters, [&](Index i, Index j) { return 3.0 * wave(i, j, phase + 1.0); });
  ProcessEffect effect{"a force", "N", VectorXd::LinSpaced(kKnots, 0.0, 1.0), {}};
  effect.responses =
      MatrixXd::NullaryExpr(kResiduals, kKnots, [&](Index i, Index j) { return 2.0 * wave(i, j, phase); });
  const VectorXd values = VectorXd::NullaryExpr(kKnots, [](Index j) { return j < 4 ? -1.5 : 1.5; });
  recording.linear.residual = effect.responses * values + VectorXd::NullaryExpr(kResiduals, [](Index i) {
                                return 0.8 * std::cos(2.9 * static_cast<double>(i));
                              });
  recording.effects.push_back(effect);
  return recording;
}

MatrixXd calcPrior(const VectorXd& knots) {
  return MatrixXd::NullaryExpr(kKnots, kKnots, [&](Index i, Index j) {
    return kVariance * std::exp(-std::abs(knots[i] - knots[j]) / kLength);
  });
}

MatrixXd invert(const MatrixXd& matrix) {
  return linalg::solveSemidefinite(matrix, MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

// Parameters and knots as one vector of normal unknowns.
TEST(EstimateProcess, IsThePosteriorOfParametersAndKnots) {
  const std::vector<FittedRecording> recordings{makeRecording(0.4)};
  const LinearizedRecordings& linear = recordings[0].linear;
  const ProcessEffect& effect = recordings[0].effects[0];
  const ProcessProblem problem{recordings, 0, kParameters};
  const ProcessEstimate estimate = estimateProcess(problem, {0.0, kVariance, kLength});
  MatrixXd all(kResiduals, kParameters + kKnots);
  all << linear.jacobian, effect.responses;
  MatrixXd information = all.transpose() * all;
  information.bottomRightCorner(kKnots, kKnots) += invert(calcPrior(effect.knots));
  const MatrixXd covariance = invert(information);
  const VectorXd mean = covariance * (all.transpose() * linear.residual);
  EXPECT_LT((estimate.step - mean.head(kParameters)).norm(), 1e-8);
  EXPECT_LT((estimate.covariance - covariance.topLeftCorner(kParameters, kParameters)).norm(), 1e-8);
  EXPECT_LT((estimate.means[0] - mean.tail(kKnots)).norm(), 1e-7);
  EXPECT_LT((estimate.stddevs[0] - covariance.diagonal().tail(kKnots).cwiseSqrt()).norm(), 1e-7);
}

TEST(SearchProcess, FindsTheSizeOfAProcessAndNoneWhereThereIsNone) {
  std::vector<FittedRecording> recordings{makeRecording(0.4), makeRecording(0.9)};
  const ProcessProblem problem{recordings, 0, kParameters};
  const BestProcess best = searchProcess(problem, {0.1, 0.3, 1.0});
  EXPECT_GT(best.log_evidence, 100.0);
  EXPECT_GT(std::sqrt(best.variance), 0.7);
  EXPECT_LT(std::sqrt(best.variance), 5.0);
  for (FittedRecording& recording : recordings) {
    recording.linear.residual = VectorXd::NullaryExpr(
        kResiduals, [](Index i) { return i % 7 == 3 ? 1.0 : std::cos(2.9 * static_cast<double>(i * i)); });
  }
  EXPECT_LT(searchProcess(problem, {0.1, 0.3, 1.0}).log_evidence, 0.0);
}

// Two springs of which only the sum acts: what one parameter alone says.
TEST(SearchProcess, IsAsGoodWhereParametersActByTheirSumAlone) {
  FittedRecording one = makeRecording(0.4);
  one.linear.residual *= 0.05;
  for (Index i = 0; i < kResiduals; ++i) {
    one.linear.residual[i] += i % 7 == 3 ? 1.0 : std::cos(2.9 * static_cast<double>(i * i));
  }
  FittedRecording both = one;
  both.half_widths = VectorXd::Constant(3, 10.0);
  one.half_widths = Eigen::Vector2d(10.0 * std::sqrt(2.0), 10.0);
  both.linear.jacobian.resize(kResiduals, 3);
  both.linear.jacobian << 1e3 * one.linear.jacobian.col(0), 1e3 * one.linear.jacobian.col(0),
      one.linear.jacobian.col(1);
  one.linear.jacobian.col(0) *= 1e3;
  const std::vector<FittedRecording> alone{one}, together{both};
  const std::vector<double> lengths{0.1, 0.3, 1.0};
  const BestProcess expected = searchProcess({alone, 0, 2}, lengths);
  const BestProcess best = searchProcess({together, 0, 3}, lengths);
  EXPECT_NEAR(best.log_evidence, expected.log_evidence, 1e-3 * (1.0 + std::abs(expected.log_evidence)));
}

}  // namespace
}  // namespace twinmap
