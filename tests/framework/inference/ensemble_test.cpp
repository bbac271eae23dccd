#include "framework/inference/ensemble.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/estimation/draws.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

const RandomStream kRandom(3, RandomPurpose::kEnsemble);

ParameterSpec makeParameter(double lower, double upper) {
  ParameterSpec parameter;
  parameter.bounds = {lower, upper, {}};
  return parameter;
}

TEST(DrawNormal, HasTheMeanAndTheCovarianceDRD) {
  constexpr int kDraws = 20000;
  VectorXd mean(3), stddev(3);
  mean << 1.0, -2.0, 100.0;
  stddev << 0.1, 2.0, 5.0;
  MatrixXd correlation(3, 3);
  correlation << 1.0, 0.8, -0.3, 0.8, 1.0, 0.1, -0.3, 0.1, 1.0;
  const MatrixXd draws = drawNormal(mean, stddev, correlation, kDraws, kRandom);
  const VectorXd found_mean = draws.rowwise().mean();
  const MatrixXd scaled = stddev.cwiseInverse().asDiagonal() * (draws.colwise() - found_mean);
  const MatrixXd found = scaled * scaled.transpose() / kDraws;
  const double five_errors = 5.0 / std::sqrt(static_cast<double>(kDraws));
  EXPECT_LT(((found_mean - mean).cwiseQuotient(stddev)).cwiseAbs().maxCoeff(), five_errors);
  EXPECT_LT((found - correlation).cwiseAbs().maxCoeff(), 2.0 * five_errors);
}

TEST(DrawNormal, KeepsASumThatIsExactlyKnown) {
  MatrixXd correlation(2, 2);
  correlation << 1.0, -1.0, -1.0, 1.0;
  VectorXd mean(2);
  mean << 4.0, 6.0;
  const MatrixXd draws = drawNormal(mean, VectorXd::Constant(2, 3.0), correlation, 50, kRandom);
  EXPECT_LT((draws.colwise().sum().array() - 10.0).abs().maxCoeff(), 1e-6);
  EXPECT_GT((draws.row(0).array() - 4.0).abs().maxCoeff(), 3.0);
}

TEST(DrawNormal, MoreDrawsBeginWithTheSame) {
  const MatrixXd one = MatrixXd::Identity(2, 2);
  const VectorXd zero = VectorXd::Zero(2), unit = VectorXd::Ones(2);
  EXPECT_EQ(drawNormal(zero, unit, one, 30, kRandom).leftCols(10), drawNormal(zero, unit, one, 10, kRandom));
}

TEST(ClipToBounds, MovesEachValueAlone) {
  MatrixXd points(2, 2), expected(2, 2);
  points << -1.0, 0.5, 30.0, 15.0;
  expected << 0.0, 0.5, 20.0, 15.0;
  EXPECT_EQ(clipToBounds(points, {makeParameter(0.0, 1.0), makeParameter(10.0, 20.0)}), expected);
}

TEST(CalcRowQuantiles, AreLinearBetweenSortedValues) {
  MatrixXd values(2, 5);
  values << 5.0, 1.0, 4.0, 2.0, 3.0, 0.0, 0.0, 10.0, 0.0, 0.0;
  EXPECT_EQ(calcRowQuantiles(values, 0.5), (VectorXd(2) << 3.0, 0.0).finished());
  EXPECT_NEAR(calcRowQuantiles(values, 0.025)[0], 1.1, 1e-12);  // numpy.quantile([1, 2, 3, 4, 5], 0.025)
  EXPECT_NEAR(calcRowQuantiles(values, 0.975)[1], 9.0, 1e-12);
  EXPECT_EQ(calcRowQuantiles(values, 1.0)[0], 5.0);
}

}  // namespace
}  // namespace twinmap
