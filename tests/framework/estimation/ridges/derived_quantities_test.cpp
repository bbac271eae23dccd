#include "framework/estimation/derived/derived_quantities.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap {
namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr double kNormal95 = 1.959963984540054;

ParameterSpec makeParameter(const std::string& name, double lower, double upper) {
  ParameterSpec parameter;
  parameter.name.text = name;
  parameter.bounds = {lower, upper, {}};
  return parameter;
}

DerivedSpec makeDerived(const std::string& name, const std::string& value) {
  DerivedSpec derived;
  derived.name.text = name;
  derived.value.text = value;
  return derived;
}

/// Of m in [1, 2] and L in [-1, 3], with g = 10.
DerivedQuantities makeQuantities(const std::vector<std::string>& values) {
  ExperimentSpec experiment;
  experiment.model.parameters = {makeParameter("m", 1.0, 2.0), makeParameter("L", -1.0, 3.0)};
  experiment.model.constants.resize(1);
  experiment.model.constants[0].name.text = "g";
  experiment.model.constants[0].value.text = "10";
  for (std::size_t k = 0; k < values.size(); ++k) {
    experiment.derived.push_back(makeDerived("d" + std::to_string(k), values[k]));
  }
  return DerivedQuantities(experiment);
}

TEST(DerivedQuantities, UseParametersConstantsAndEarlierQuantities) {
  const DerivedQuantities quantities = makeQuantities({"m * g", "d0 + L"});
  EXPECT_EQ(quantities.calc(Vector2d(1.5, 0.25)), Vector2d(15.0, 15.25));
  EXPECT_EQ(quantities.getSpecs()[0].bounds.lower, 10.0);
  EXPECT_EQ(quantities.getSpecs()[0].bounds.upper, 20.0);
  EXPECT_EQ(quantities.getSpecs()[0].relative_to, RelativeTo::kValue);
  EXPECT_EQ(makeQuantities({"L"}).getSpecs()[0].relative_to, RelativeTo::kRange);
}

TEST(DerivedQuantities, HaveTheGradientsOfTheirExpressions) {
  const MatrixXd gradients = makeQuantities({"m * L^2", "sqrt(m)"}).calcGradients(Vector2d(1.44, 2.0));
  EXPECT_NEAR(gradients(0, 0), 4.0, 1e-8);
  EXPECT_NEAR(gradients(0, 1), 5.76, 1e-8);
  EXPECT_NEAR(gradients(1, 0), 0.5 / 1.2, 1e-8);
  EXPECT_NEAR(gradients(1, 1), 0.0, 1e-12);
}

TEST(DerivedQuantities, OfALinearFunctionAreNormal) {
  Matrix2d covariance;
  covariance << 4e-4, -1e-4, -1e-4, 1e-4;
  const auto distributions = makeQuantities({"3 * m + 2 * L"}).propagate(Vector2d(1.5, 1.0), covariance);
  const double stddev = std::sqrt(9 * 4e-4 - 12e-4 + 4e-4);
  const DerivedEstimate estimate = summarize(distributions);
  EXPECT_NEAR(estimate.mean[0], 6.5, 1e-6 * stddev);
  EXPECT_NEAR(estimate.stddev[0], stddev, 1e-6 * stddev);
  EXPECT_NEAR(estimate.lower95[0], 6.5 - kNormal95 * stddev, 1e-3 * stddev);
  EXPECT_NEAR(distributions[0].calcProbability(6.5 + stddev), 0.8413447, 1e-3);
}

TEST(DerivedQuantities, OfAMonotoneFunctionOfOneParameterHaveItsExactQuantiles) {
  const double mean = 1.5, stddev = 0.1;
  const Matrix2d covariance = Vector2d(stddev * stddev, 1e-6).asDiagonal();
  const DerivedEstimate estimate =
      summarize(makeQuantities({"1 / m^3"}).propagate(Vector2d(mean, 0.0), covariance));
  EXPECT_NEAR(estimate.lower95[0], std::pow(mean + kNormal95 * stddev, -3.0), 1e-4);
  EXPECT_NEAR(estimate.upper95[0], std::pow(mean - kNormal95 * stddev, -3.0), 1e-4);
}

TEST(DerivedQuantities, StayDeterminedAlongARidge) {
  // m L is known to 1e-3, m to 20 %: the covariance is flat along (m, -L)
  const Vector2d mean(1.5, 1.0), along = Vector2d(0.3, -0.2), across = 1e-3 * Vector2d(1.0, 1.5) / 3.25;
  const Matrix2d covariance = along * along.transpose() + across * across.transpose();
  const DerivedEstimate estimate = summarize(makeQuantities({"m * L"}).propagate(mean, covariance));
  EXPECT_NEAR(estimate.mean[0], 1.5, 1e-5);
  EXPECT_NEAR(estimate.stddev[0], 1e-3, 1e-5);
}

TEST(DerivedQuantities, OfAMixtureAreAsWideAsItsComponents) {
  Mixture mixture{Vector2d(0.25, 0.75),
                  MatrixXd(2, 2),
                  MatrixXd::Constant(2, 2, 0.01),
                  {Matrix2d::Identity(), Matrix2d::Identity()}};
  mixture.means << 1.5, 1.5, -0.5, 2.5;
  const auto distributions = makeQuantities({"m * L"}).propagate(mixture);
  EXPECT_NEAR(distributions[0].getMean(), 0.25 * -0.75 + 0.75 * 3.75, 1e-4);  // of 1e-4 is m L curved
  EXPECT_NEAR(distributions[0].calcProbability(1.0), 0.25, 1e-9);
}

TEST(DerivedQuantities, AreDrawnWhereTheGradientVanishes) {
  const Matrix2d covariance = Vector2d(1e-6, 0.01).asDiagonal();
  const auto distributions = makeQuantities({"L^2"}).propagate(Vector2d(1.5, 0.0), covariance);
  EXPECT_NEAR(distributions[0].getMean(), 0.01, 0.001);             // a chi-square of one degree, 2000 draws
  EXPECT_NEAR(distributions[0].calcQuantile(0.95), 0.0384, 0.004);  // 0.01 * 3.84
}

TEST(DerivedQuantities, AreUndefinedWhereTheirExpressionIs) {
  const Matrix2d covariance = Vector2d(1e-6, 1e-6).asDiagonal();
  const auto distributions = makeQuantities({"sqrt(L)"}).propagate(Vector2d(1.5, -0.5), covariance);
  EXPECT_FALSE(distributions[0].isDefined());
  EXPECT_TRUE(std::isnan(distributions[0].calcQuantile(0.5)));
}

TEST(ValueDistribution, InterpolatesBetweenWeightedValues) {
  const ValueDistribution distribution(Eigen::Vector3d(3.0, 1.0, 2.0), Eigen::Vector3d(1.0, 1.0, 2.0));
  EXPECT_EQ(distribution.getMean(), 2.0);
  EXPECT_EQ(distribution.calcQuantile(0.5), 2.0);
  EXPECT_EQ(distribution.calcQuantile(0.125), 1.0);
  EXPECT_DOUBLE_EQ(distribution.calcQuantile(0.3125), 1.5);
  EXPECT_DOUBLE_EQ(distribution.calcProbability(1.5), 0.3125);
  EXPECT_EQ(distribution.calcProbability(0.9), 0.0);
  EXPECT_EQ(distribution.calcProbability(3.1), 1.0);
}

}  // namespace
}  // namespace twinmap
