#include "framework/estimation/refined/confirmation.hpp"

#include <gtest/gtest.h>

#include "tests/framework/estimation/refined/problem.hpp"
#include "tests/lu.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::makeMatrix;
using testing::makeVector;
using testing::Problem;

constexpr double kNoiseStddev = 0.3;

/// Two parameters within [-1, 1]; 30 samples, linear but for `bend` times the square of the first.
Problem makeBent(double bend) {
  const MatrixXd matrix = makeMatrix(30, 2);
  const auto response = [=](const VectorXd& x) -> VectorXd {
    return (matrix * x).array() + bend * x[0] * x[0];
  };
  return {30, response, testing::makeParameters(2, -1.0, 1.0), kNoiseStddev};
}

MatrixXd calcLinearCovariance() {
  const MatrixXd matrix = makeMatrix(30, 2);
  return test::calcInverse(matrix.transpose() * matrix / (kNoiseStddev * kNoiseStddev) +
                           3.0 * MatrixXd::Identity(2, 2));
}

Refined refineKnowing(Problem& problem, const VectorXd& features, const VectorXd& start,
                      const MatrixXd& covariance) {
  return refine(problem.simulator, problem.model,
                {features, {{"map", start}}, {0, start.size()}, false, covariance});
}

TEST(Confirm, OfALinearModelIsTheExactPosteriorAfterTwoPoints) {
  Problem problem = makeBent(0.0);
  const VectorXd features = problem.measure(makeVector({0.4, -0.3}), kNoiseStddev);
  const MatrixXd covariance = calcLinearCovariance();
  const Refined refined = refineKnowing(problem, features, makeVector({0.5, -0.2}), 2.0 * covariance);
  ASSERT_TRUE(refined.isAccepted()) << refined.message;
  const VectorXd mean = covariance * makeMatrix(30, 2).transpose() * features / (kNoiseStddev * kNoiseStddev);
  EXPECT_EQ(refined.simulations, 2 * 5);
  EXPECT_LT((refined.covariance - covariance).norm(), 1e-6 * covariance.norm());
  EXPECT_LT(((refined.point - mean).array() / refined.stddev.array()).abs().maxCoeff(), 1e-6);
}

TEST(Confirm, AgreesWithTheSearchOfASmoothModel) {
  Problem problem = makeBent(1.0);
  const VectorXd features = problem.measure(makeVector({0.4, -0.3}), kNoiseStddev);
  const VectorXd start = makeVector({0.45, -0.25});
  const Refined searched = problem.refineFrom(features, {{"map", start}});
  const Refined confirmed = refineKnowing(problem, features, start, calcLinearCovariance());
  ASSERT_TRUE(searched.isAccepted() && confirmed.isAccepted());
  EXPECT_LT(confirmed.simulations, searched.simulations);
  EXPECT_LT(((confirmed.point - searched.point).array() / searched.stddev.array()).abs().maxCoeff(), 0.05);
  EXPECT_LT((confirmed.stddev.array() / searched.stddev.array() - 1.0).abs().maxCoeff(), 0.02);
}

TEST(Confirm, EndsWhereTheSearchDoesFromFarAway) {
  Problem problem = makeBent(1.0);
  const VectorXd features = problem.measure(makeVector({0.4, -0.3}), kNoiseStddev);
  const VectorXd start = makeVector({-0.6, 0.5});
  const Refined refined = refineKnowing(problem, features, start, 1e-4 * MatrixXd::Identity(2, 2));
  const Refined searched = problem.refineFrom(features, {{"map", start}});
  ASSERT_TRUE(refined.isAccepted());
  EXPECT_LT(refined.simulations, searched.simulations);
  EXPECT_LT(((refined.point - searched.point).array() / searched.stddev.array()).abs().maxCoeff(), 0.05);
}

TEST(Confirm, DoesNotBeginWhereTheLimitsAreNear) {
  Problem problem = makeBent(0.0);
  const VectorXd features = problem.measure(makeVector({0.4, -0.3}), kNoiseStddev);
  const VectorXd start = makeVector({1.099, 0.0});
  const Refined refined = refineKnowing(problem, features, start, 0.01 * MatrixXd::Identity(2, 2));
  EXPECT_EQ(refined.simulations, problem.refineFrom(features, {{"map", start}}).simulations);
}

TEST(Confirm, AcceptsNeitherAWrongModelNorAMinimumThatIsNoParaboloid) {
  Problem bent = makeBent(0.0);
  const VectorXd features = bent.measure(makeVector({0.4, -0.3}), kNoiseStddev);
  const VectorXd wrong = features.array() + VectorXd::LinSpaced(30, -2.0, 2.0).array();
  EXPECT_EQ(refineKnowing(bent, wrong, makeVector({0.4, -0.3}), calcLinearCovariance()).status,
            RefinementStatus::kMisfit);
  Problem square(
      20, [](const VectorXd& x) { return VectorXd::Constant(20, x[0] * x[0]); },
      testing::makeParameters(1, -1.0, 1.0), 0.1);
  for (const double variance : {1e-4, 1e-2, 0.3}) {
    EXPECT_EQ(refineKnowing(square, VectorXd::Zero(20), makeVector({0.0}), MatrixXd::Constant(1, 1, variance))
                  .status,
              RefinementStatus::kNonlinear);
  }
}

}  // namespace
}  // namespace twinmap
