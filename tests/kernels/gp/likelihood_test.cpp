#include <gtest/gtest.h>

#include <cmath>

#include "kernels/gp/fit.hpp"
#include "tests/kernels/support/random_data.hpp"

namespace twinmap::gp {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::randomMatrix;

// Five-point differences: the truncation error is of order step^4, the rounding error eps |NLML| / step.
double difference(const TrainingSet& set, const VectorXd& target, VectorXd point, int index,
                  LikelihoodWorkspace& workspace) {
  constexpr double kStep = 2e-3;
  const double middle = point(index);
  const auto at = [&](double offset) {
    point(index) = middle + offset * kStep;
    return evaluateLikelihood(set, target, fromLog(set.getStructure(), point), workspace).nlml;
  };
  return (8.0 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12.0 * kStep);
}

struct GradientCase {
  CovarianceFunction covariance;
  MeanFunction mean;
  int groups;
  bool linear_term;
};

class Gradient : public testing::TestWithParam<GradientCase> {};

TEST_P(Gradient, EqualsFiniteDifferences) {
  const int d = 7, n = 60;
  const MatrixXd inputs = randomMatrix(d, n, 11);
  const VectorXd target = test::smoothTarget(inputs, 0.2, 12);
  ModelStructure structure{GetParam().covariance, test::cyclicGroups(d, GetParam().groups),
                           GetParam().linear_term, GetParam().mean};
  const TrainingSet set(inputs, structure);
  LikelihoodWorkspace workspace(set);
  Hyperparameters hyperparameters;
  hyperparameters.length_scales = VectorXd::LinSpaced(GetParam().groups, 0.8, 2.5);
  hyperparameters.shape = 0.7;
  hyperparameters.linear_stddev = 0.4;
  const VectorXd point = toLog(structure, hyperparameters);
  VectorXd gradient(point.size());
  ASSERT_TRUE(evaluateLikelihoodGradient(set, target, hyperparameters, workspace, gradient).ok);
  for (int i = 0; i < point.size(); ++i) {
    const double expected = difference(set, target, point, i, workspace);
    EXPECT_NEAR(gradient(i), expected, 1e-6 * std::max(0.1, std::abs(expected)))
        << getHyperparameterNames(structure)[i];
  }
}

std::vector<GradientCase> allCases() {
  std::vector<GradientCase> cases;
  for (auto covariance : {CovarianceFunction::kSquaredExponential, CovarianceFunction::kMatern32,
                          CovarianceFunction::kMatern52, CovarianceFunction::kRationalQuadratic}) {
    for (auto mean : {MeanFunction::kZero, MeanFunction::kConstant, MeanFunction::kLinear}) {
      for (int groups : {1, 3, 7}) {  // stored distances, several of them, and by product
        for (bool linear_term : {false, true}) {
          cases.push_back({covariance, mean, groups, linear_term});
        }
      }
    }
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(AllStructures, Gradient, testing::ValuesIn(allCases()));

// Two samples at distance r, zero mean: K = [[s^2 + v, c], [c, s^2 + v]], c = s^2 exp(-r^2 / (2 l^2)).
TEST(Likelihood, OfTwoSamplesByHand) {
  MatrixXd inputs(1, 2);
  inputs << 0.0, 1.5;
  const VectorXd target = Eigen::Vector2d(0.7, -0.2);
  Hyperparameters hyperparameters{VectorXd::Constant(1, 2.0), 1.1, 0.4, 1.0, 1.0};
  ModelStructure structure;
  structure.mean = MeanFunction::kZero;
  const double diagonal = 1.21 + 0.16, off = 1.21 * std::exp(-0.5 * 2.25 / 4.0);
  const double determinant = diagonal * diagonal - off * off;
  const double quadratic = (diagonal * (0.49 + 0.04) + 2.0 * off * 0.7 * 0.2) / determinant;
  const double expected = 0.5 * quadratic + 0.5 * std::log(determinant) + std::log(2.0 * M_PI);
  EXPECT_NEAR(fit(inputs, target, structure, hyperparameters)->getNlml(), expected, 1e-13);
}

TEST(Likelihood, OfAnIntegratedConstantMeanIgnoresAnOffsetOfTheTarget) {
  const MatrixXd inputs = randomMatrix(3, 40, 1);
  const VectorXd target = test::smoothTarget(inputs, 0.1, 2);
  const Hyperparameters hyperparameters{VectorXd::Constant(1, 1.0), 1.0, 0.2, 1.0, 1.0};
  const auto one = fit(inputs, target, {}, hyperparameters);
  const auto other = fit(inputs, target.array() + 5.0, {}, hyperparameters);
  EXPECT_NEAR(one->getNlml(), other->getNlml(), 1e-9);
  EXPECT_NEAR(other->getMeanCoefficients()(0) - one->getMeanCoefficients()(0), 5.0, 1e-10);
}

TEST(Likelihood, OfDuplicatePointsWithoutNoiseReportsItsJitter) {
  MatrixXd inputs = randomMatrix(2, 20, 3);
  inputs.rightCols(10) = inputs.leftCols(10);
  const VectorXd target = test::smoothTarget(inputs, 0.0, 4);
  const Hyperparameters hyperparameters{VectorXd::Constant(1, 1.0), 1.0, 1e-12, 1.0, 1.0};
  const auto gp = fit(inputs, target, {}, hyperparameters);
  EXPECT_GT(gp->getParts().jitter, 0.0);
  EXPECT_LE(gp->getParts().jitter, 1e-6);
  EXPECT_TRUE(gp->predict(inputs).variance.allFinite());
}

TEST(Likelihood, IsTheSameForProductsAndStoredDistances) {
  const MatrixXd inputs = randomMatrix(6, 70, 5);
  const VectorXd target = test::smoothTarget(inputs, 0.1, 6);
  ModelStructure shared, separate;
  separate.length_scale_groups = oneGroupPerFeature(6);
  const auto one = fit(inputs, target, shared, {VectorXd::Constant(1, 1.3), 1.0, 0.1, 1.0, 1.0});
  const auto six = fit(inputs, target, separate, {VectorXd::Constant(6, 1.3), 1.0, 0.1, 1.0, 1.0});
  EXPECT_NEAR(one->getNlml(), six->getNlml(), 1e-9);
}

}  // namespace
}  // namespace twinmap::gp
