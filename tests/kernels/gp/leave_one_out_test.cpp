#include "kernels/gp/leave_one_out.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/gp/fit.hpp"
#include "tests/kernels/support/random_data.hpp"

namespace twinmap::gp {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class LeaveOneOutOf : public testing::TestWithParam<MeanFunction> {};

// Against fits to the other samples. Features far from linear terms: the linear mean's basis shifts its
// centre with the sample left out, which the integrated coefficients absorb exactly.
TEST_P(LeaveOneOutOf, EverySampleEqualsAFitWithoutIt) {
  const int n = 25;
  const MatrixXd inputs = test::randomMatrix(2, n, 1);
  const VectorXd target = test::smoothTarget(inputs, 0.2, 2);
  ModelStructure structure;
  structure.mean = GetParam();
  const Hyperparameters hyperparameters{VectorXd::Constant(1, 0.9), 1.2, 0.2, 1.0, 1.0};
  const LeaveOneOut result = calcLeaveOneOut(*fit(inputs, target, structure, hyperparameters));
  int covered = 0;
  for (int i = 0; i < n; ++i) {
    MatrixXd others(2, n - 1);
    VectorXd other_target(n - 1);
    others << inputs.leftCols(i), inputs.rightCols(n - 1 - i);
    other_target << target.head(i), target.tail(n - 1 - i);
    const Prediction prediction =
        fit(others, other_target, structure, hyperparameters)->predict(inputs.col(i));
    const double residual = target(i) - prediction.mean(0), variance = prediction.variance(0);
    EXPECT_NEAR(result.residual(i), residual, 1e-10);
    EXPECT_NEAR(result.stddev(i), std::sqrt(variance), 1e-10);
    EXPECT_NEAR(result.log_density(i),
                -0.5 * (residual * residual / variance + std::log(2 * M_PI * variance)), 1e-9);
    covered += std::abs(residual) <= 1.959963984540054 * std::sqrt(variance);
  }
  EXPECT_DOUBLE_EQ(result.coverage95, double(covered) / n);
  EXPECT_NEAR(result.total_log_density, result.log_density.sum(), 1e-12);
}

// Each simulation's draws leave together. Both what lies off the group's diagonal and the mean's integration
// matter: a fit without the group is the oracle.
TEST_P(LeaveOneOutOf, EveryGroupEqualsAFitWithoutIt) {
  const int simulations = 8, draws = 3, n = simulations * draws;
  const MatrixXd noise = test::randomMatrix(2, n, 4);
  const MatrixXd inputs = test::randomMatrix(2, simulations, 3).replicate(1, draws) + 0.1 * noise;
  const VectorXd target =
      test::smoothTarget(test::randomMatrix(2, simulations, 3), 0.2, 2).replicate(draws, 1);
  ModelStructure structure;
  structure.mean = GetParam();
  const Hyperparameters hyperparameters{VectorXd::Constant(1, 0.9), 1.2, 0.2, 1.0, 1.0};
  const auto process = fit(inputs, target, structure, hyperparameters);
  const LeaveOneOut result = calcLeaveGroupsOut(*process, makeDrawGroups(n, draws));
  for (int j = 0; j < simulations; ++j) {
    std::vector<Eigen::Index> kept, left;
    for (int i = 0; i < n; ++i) {
      (i % simulations == j ? left : kept).push_back(i);
    }
    const Prediction prediction = fit(inputs(Eigen::all, kept), target(kept), structure, hyperparameters)
                                      ->predict(inputs(Eigen::all, left));
    EXPECT_LT((result.residual(left) - (target(left) - prediction.mean)).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_LT((result.stddev(left) - prediction.stddev()).cwiseAbs().maxCoeff(), 1e-10);
  }
  // Draw by draw, siblings give a sample away: the target repeats among them exactly.
  EXPECT_LT(calcLeaveOneOut(*process).root_mean_square, 0.8 * result.root_mean_square);
  const LeaveOneOut shared = calcLeaveGroupsOut(*process, makeDrawGroups(n, draws), 3);
  EXPECT_EQ(shared.residual, result.residual);
  EXPECT_EQ(shared.stddev, result.stddev);
}

// A noise variance of 1e-16 beside a signal variance of 1: the precision matrix is rounding in its fifth
// digit or before.
TEST(LeaveGroupsOut, StddevIsNeverBelowTheNoise) {
  const int n = 60;
  const MatrixXd inputs = test::randomMatrix(2, n, 1);
  for (const double noise : {1e-8, 1e-3}) {
    const Hyperparameters hyperparameters{VectorXd::Constant(1, 3.0), 1.0, noise, 1.0, 1.0};
    const auto process = fit(inputs, test::smoothTarget(inputs, 0.0, 2), {}, hyperparameters);
    for (const int draws : {1, 3}) {
      const LeaveOneOut result = calcLeaveGroupsOut(*process, makeDrawGroups(n, draws));
      EXPECT_GE(result.stddev.minCoeff(), (1.0 - 1e-15) * noise);
      EXPECT_TRUE(result.log_density.allFinite());
    }
  }
}

// The block and alpha of one sample as rounding may leave them: [2 / s_n^2] instead of at most 1 / s_n^2.
TEST(LeaveGroupsOut, AVarianceBelowTheNoiseIsRounding) {
  const double noise_variance = 0.04;
  const GroupPrediction rounded =
      predictGroup(MatrixXd::Constant(1, 1, 2.0 / noise_variance), VectorXd::Ones(1), noise_variance);
  EXPECT_EQ(rounded.variance(0), noise_variance);
  EXPECT_DOUBLE_EQ(rounded.residual(0), 0.5 * noise_variance);
  const GroupPrediction kept =
      predictGroup(MatrixXd::Constant(1, 1, 0.5 / noise_variance), VectorXd::Ones(1), noise_variance);
  EXPECT_DOUBLE_EQ(kept.variance(0), 2.0 * noise_variance);
}

TEST(LeaveGroupsOut, RefusesGroupsThatAreNoPartition) {
  const MatrixXd inputs = test::randomMatrix(2, 4, 1);
  const auto process =
      fit(inputs, test::smoothTarget(inputs, 0.2, 2), {}, {VectorXd::Ones(1), 1.0, 0.2, 1.0, 1.0});
  EXPECT_THROW(calcLeaveGroupsOut(*process, {{0, 1}, {2}}), std::invalid_argument);
  EXPECT_THROW(calcLeaveGroupsOut(*process, {{0, 1}, {1, 2, 3}}), std::invalid_argument);
  EXPECT_THROW(calcLeaveGroupsOut(*process, {{0, 1}, {2, 3, 4}}), std::invalid_argument);
  EXPECT_THROW(makeDrawGroups(10, 3), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Means, LeaveOneOutOf,
                         testing::Values(MeanFunction::kZero, MeanFunction::kConstant,
                                         MeanFunction::kLinear));

}  // namespace
}  // namespace twinmap::gp
