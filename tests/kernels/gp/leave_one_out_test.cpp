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

INSTANTIATE_TEST_SUITE_P(Means, LeaveOneOutOf,
                         testing::Values(MeanFunction::kZero, MeanFunction::kConstant,
                                         MeanFunction::kLinear));

}  // namespace
}  // namespace twinmap::gp
