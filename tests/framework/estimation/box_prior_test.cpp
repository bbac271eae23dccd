#include "framework/estimation/box_prior.hpp"

#include <gtest/gtest.h>

#include "tests/lu.hpp"

namespace twinmap {
namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

ParameterSpec makeParameter(const char* name, double lower, double upper) {
  ParameterSpec parameter;
  parameter.name.text = name;
  parameter.bounds = {lower, upper, {}};
  return parameter;
}

ParameterSpec makeParameter(const char* name, double lower, double upper, const PriorSpec& prior) {
  ParameterSpec parameter = makeParameter(name, lower, upper);
  parameter.prior = prior;
  return parameter;
}

TEST(BoxPrior, OfUniformParametersIsThatOfTheBox) {
  ModelSpec model;
  model.parameters = {makeParameter("a", 0.0, 4.0), makeParameter("b", -1.0, 3.0)};
  const BoxPrior prior = makeBoxPrior(model);
  EXPECT_TRUE(prior.isUniform());
  EXPECT_EQ(prior.relative, MatrixXd::Identity(2, 2));
  EXPECT_EQ(prior.mean, VectorXd::Zero(2));
  EXPECT_NEAR(prior.stddev[0], 1.0 / std::sqrt(3.0), 1e-15);
  EXPECT_EQ(findPrior(model), nullptr);
}

// a on [0, 8]: a half width is 4; c on [0, 20]: 10
TEST(BoxPrior, OfNormalOnesHasTheirInverseCovarianceInHalfWidths) {
  ModelSpec model;
  model.parameters = {makeParameter("a", 0.0, 8.0, {NormalPrior{5.0, 0.4}}), makeParameter("b", -1.0, 1.0),
                      makeParameter("c", 0.0, 20.0, {NormalPrior{9.0, 2.0}})};
  model.priors = {{CorrelatedPriors{{{"a", {}}, {"c", {}}}, 0.5}, {}}};
  const BoxPrior prior = makeBoxPrior(model);
  Matrix2d covariance;
  covariance << 0.01, 0.5 * 0.1 * 0.2, 0.5 * 0.1 * 0.2, 0.04;
  MatrixXd expected = MatrixXd::Zero(3, 3);
  expected({0, 2}, {0, 2}) = test::calcInverse(covariance);
  EXPECT_LT((prior.within - expected).norm(), 1e-10 * expected.norm());
  expected(1, 1) = 3.0;
  EXPECT_LT((prior.calcInformation() - expected).norm(), 1e-10 * expected.norm());
  EXPECT_NEAR(prior.mean[0], 0.25, 1e-14);
  EXPECT_NEAR(prior.mean[2], -0.1, 1e-14);
  EXPECT_LT((prior.shift - prior.within * prior.mean).norm(), 1e-12);
  EXPECT_NEAR(prior.stddev[2], 0.2, 1e-3);  // 512 quantiles
}

// x uniform by a beta distribution: the bounds alone say as much
TEST(BoxPrior, CountsTheBoundsOnceWhereTheyArePartOfTheDistribution) {
  ModelSpec model;
  model.parameters = {makeParameter("a", 2.0, 4.0, {BetaPrior{1.0, 1.0}}),
                      makeParameter("b", 0.0, 1.0, {BetaPrior{5.0, 5.0}})};
  const BoxPrior prior = makeBoxPrior(model);
  EXPECT_NEAR(prior.within(0, 0), 0.0, 1e-3);
  EXPECT_NEAR(prior.stddev[0], 1.0 / std::sqrt(3.0), 1e-3);
  const double variance = 4.0 * 25.0 / (100.0 * 11.0);  // of a beta distribution, in half widths
  EXPECT_NEAR(prior.within(1, 1), 1.0 / variance - 3.0, 0.02);
}

TEST(BoxPrior, BeginsAtTheMediansOfThePriors) {
  ModelSpec model;
  model.parameters = {makeParameter("a", 1.0, 9.0, {LognormalPrior{2.0, 1.2}}), makeParameter("b", 0.0, 4.0)};
  model.inputs = {makeParameter("m", 0.0, 10.0)};
  const VectorXd center = calcPriorCenter(model);
  EXPECT_NEAR(center[0], 2.0, 1e-3);
  EXPECT_NEAR(center[1], 2.0, 1e-15);
  EXPECT_NEAR(center[2], 5.0, 1e-15);
}

}  // namespace
}  // namespace twinmap
