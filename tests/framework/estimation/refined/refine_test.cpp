#include "framework/estimation/refined/refine.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/framework/estimation/refined/problem.hpp"
#include "tests/lu.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::makeMatrix;
using testing::makeVector;
using testing::Problem;

TEST(Refine, FindsTheExactPosteriorOfALinearModel) {
  constexpr double kNoise = 0.3;
  const MatrixXd matrix = makeMatrix(30, 3);
  Problem problem(
      30, [&](const VectorXd& x) { return VectorXd(matrix * x); }, testing::makeParameters(3, -1.0, 1.0),
      kNoise);
  const VectorXd features = problem.measure(makeVector({0.4, -0.7, 0.1}), kNoise);
  const Refined refined = problem.refineFrom(features, {{"map", makeVector({0.0, 0.0, 0.0})}});

  const MatrixXd precision = matrix.transpose() * matrix / (kNoise * kNoise) + 3.0 * MatrixXd::Identity(3, 3);
  const MatrixXd covariance = test::calcInverse(precision);
  const VectorXd mean = covariance * matrix.transpose() * features / (kNoise * kNoise);
  ASSERT_EQ(refined.status, RefinementStatus::kAccepted) << refined.message;
  EXPECT_LT((refined.covariance - covariance).norm(), 1e-5 * covariance.norm());  // by differences
  EXPECT_LT(((refined.point - mean).array() / refined.stddev.array()).abs().maxCoeff(), 0.03);
  EXPECT_NEAR(refined.chi_square, (features - matrix * refined.point).squaredNorm() / (kNoise * kNoise),
              1e-9);
}

// a: normal, b: uniform, c: normal, correlated with a
TEST(Refine, TakesPriorsAsMeasurementsMore) {
  constexpr double kNoise = 2.0, kOfA = 0.1, kOfC = 0.2, kCorrelation = 0.6;
  const MatrixXd matrix = makeMatrix(30, 3);
  std::vector<ParameterSpec> unknown = testing::makeParameters(3, -1.0, 1.0);
  unknown[0].prior = PriorSpec{NormalPrior{0.2, kOfA}};
  unknown[2].prior = PriorSpec{NormalPrior{-0.1, kOfC}};
  Problem problem(
      30, [&](const VectorXd& x) { return VectorXd(matrix * x); }, unknown, kNoise);
  const VectorXd features = problem.measure(makeVector({0.3, -0.4, 0.1}), kNoise);
  const std::vector<PriorGroupSpec> groups{
      {CorrelatedPriors{{unknown[0].name, unknown[2].name}, kCorrelation}, {}}};
  RefinementTask task{features, {{"map", makeVector({0.0, 0.0, 0.0})}}, {0, 3}};
  task.prior = std::make_shared<const Prior>(unknown, groups);
  const Refined refined = refine(problem.simulator, problem.model, task);

  Eigen::Matrix2d of_both;
  of_both << kOfA * kOfA, kCorrelation * kOfA * kOfC, kCorrelation * kOfA * kOfC, kOfC * kOfC;
  MatrixXd prior = 3.0 * MatrixXd::Identity(3, 3);
  prior({0, 2}, {0, 2}) = test::calcInverse(of_both);
  const MatrixXd covariance = test::calcInverse(matrix.transpose() * matrix / (kNoise * kNoise) + prior);
  const VectorXd mean =
      covariance * (matrix.transpose() * features / (kNoise * kNoise) + prior * makeVector({0.2, 0.0, -0.1}));
  ASSERT_EQ(refined.status, RefinementStatus::kAccepted) << refined.message;
  EXPECT_LT((refined.covariance - covariance).norm(), 1e-6 * covariance.norm());
  EXPECT_LT(((refined.point - mean).array() / refined.stddev.array()).abs().maxCoeff(), 0.03);
}

TEST(Refine, MarginalisesTheNuisanceAndHoldsWhatIsNotSearched) {
  constexpr double kNoise = 0.3;
  const MatrixXd matrix = makeMatrix(30, 3);
  Problem problem(
      30, [&](const VectorXd& x) { return VectorXd(matrix * x); }, testing::makeParameters(2, -1.0, 1.0),
      kNoise);
  const VectorXd features = problem.measure(makeVector({0.4, -0.7, 0.5}), kNoise);
  const Refined refined =
      refine(problem.simulator, problem.model, {features, {{"map", makeVector({0.0, 0.0, 0.5})}}, {0, 2}});
  const VectorXd a = matrix.col(0) / kNoise, b = matrix.col(1) / kNoise;
  const double information = a.dot(a) + 3.0 - a.dot(b) * a.dot(b) / (b.dot(b) + 3.0);
  ASSERT_TRUE(refined.isAccepted()) << refined.message;
  EXPECT_NEAR(refined.stddev[0], 1.0 / std::sqrt(information), 1e-6);
  EXPECT_EQ(refined.point[2], 0.5);
}

constexpr double kSineNoise = 0.05;

/// A sine whose frequency has many basins.
Problem makeSine() {
  const auto response = [](const VectorXd& x) -> VectorXd {
    return VectorXd::LinSpaced(40, 1.0, 40.0).unaryExpr([&](double t) { return std::sin(x[0] * t); });
  };
  return {40, response, testing::makeParameters(1, 0.5, 2.5), kSineNoise};
}

TEST(Refine, DoesNotAcceptAnotherBasin) {
  Problem problem = makeSine();
  const Refined refined =
      problem.refineFrom(problem.measure(makeVector({1.4}), kSineNoise), {{"map", makeVector({0.9})}});
  EXPECT_NE(refined.status, RefinementStatus::kAccepted);
  EXPECT_FALSE(refined.message.empty());
  EXPECT_EQ(refined.stddev.size(), 0);
}

TEST(Refine, TriesOneStartAfterAnother) {
  Problem problem = makeSine();
  const VectorXd features = problem.measure(makeVector({1.4}), kSineNoise);
  const Refined refined =
      problem.refineFrom(features, {{"map", makeVector({0.9})}, {"training", makeVector({1.42})}});
  ASSERT_TRUE(refined.isAccepted()) << refined.message;
  EXPECT_EQ(refined.start, "training");
  EXPECT_NEAR(refined.point[0], 1.4, 5.0 * refined.stddev[0]);
}

/// Iterates of the logistic map, chaotic.
VectorXd iterate(const VectorXd& x) {
  VectorXd response(16);
  double value = x[0];
  for (double& entry : response) {
    value = 3.8 * value * (1.0 - value);
    entry = value;
  }
  return response;
}

TEST(Refine, FollowsAChaoticResponseFromItsBeginning) {
  constexpr double kNoise = 0.01;
  Problem problem(16, iterate, testing::makeParameters(1, 0.15, 0.35), kNoise);
  const VectorXd features = problem.measure(makeVector({0.27}), kNoise);
  const std::vector<RefinementStart> starts{{"map", makeVector({0.2})}};
  EXPECT_FALSE(problem.refineFrom(features, starts, false).isAccepted());
  const Refined refined = problem.refineFrom(features, starts, true);
  ASSERT_TRUE(refined.isAccepted()) << refined.message;
  EXPECT_NEAR(refined.point[0], 0.27, 5.0 * refined.stddev[0]);
}

TEST(Refine, StaysWithinTheEnlargedBox) {
  Problem problem(
      20, [](const VectorXd& x) { return VectorXd::Constant(20, x[0] * x[0]); },
      testing::makeParameters(1, 1.0, 2.0), 0.05);
  const VectorXd features = VectorXd::Constant(20, 2.2 * 2.2);
  const Refined refined = problem.refineFrom(features, {{"map", makeVector({1.5})}});
  EXPECT_DOUBLE_EQ(refined.point[0], 2.05);
  EXPECT_EQ(refined.status, RefinementStatus::kFailed);
  EXPECT_NE(refined.message.find("ended at the bounds"), std::string::npos);
}

TEST(Refine, AcceptsAnAnswerAtABound) {
  Problem problem(
      20, [](const VectorXd& x) { return VectorXd::Constant(20, x[0] * x[0]); },
      testing::makeParameters(1, 1.0, 2.0), 0.5);
  const Refined refined =
      problem.refineFrom(VectorXd::Constant(20, 2.03 * 2.03), {{"map", makeVector({1.5})}});
  ASSERT_TRUE(refined.isAccepted()) << refined.message;
  EXPECT_NEAR(refined.point[0], 2.03, 0.02);
}

TEST(Refine, DoesNotAcceptAModelThatIsWrong) {
  Problem problem(
      20, [](const VectorXd& x) { return VectorXd::Constant(20, x[0]); },
      testing::makeParameters(1, 1.0, 2.0), 0.1);
  const Refined refined = problem.refineFrom(VectorXd::LinSpaced(20, 1.0, 2.0), {{"map", makeVector({1.5})}});
  EXPECT_EQ(refined.status, RefinementStatus::kMisfit);
  EXPECT_NE(refined.message.find("chi-square"), std::string::npos);
}

TEST(Refine, DoesNotAcceptAMinimumThatIsNoParaboloid) {
  Problem problem(
      20, [](const VectorXd& x) { return VectorXd::Constant(20, x[0] * x[0]); },
      testing::makeParameters(1, -1.0, 1.0), 0.1);
  const Refined refined = problem.refineFrom(VectorXd::Zero(20), {{"map", makeVector({0.0})}});
  EXPECT_EQ(refined.status, RefinementStatus::kNonlinear);
  EXPECT_EQ(refined.stddev.size(), 0);
}

VectorXd failAboveHalf(const VectorXd& x) {
  return VectorXd::Constant(20, x[0] > 0.5 ? std::nan("") : x[0] * x[0] * x[0]);
}

TEST(Refine, GoesAroundSimulationsThatFail) {
  Problem problem(20, failAboveHalf, testing::makeParameters(1, -1.0, 1.0), 0.002);
  const VectorXd features = problem.measure(makeVector({0.45}), 0.002);
  const Refined refined = problem.refineFrom(features, {{"map", makeVector({0.1})}});
  ASSERT_TRUE(refined.isAccepted()) << refined.message;
  EXPECT_NEAR(refined.point[0], 0.45, 5.0 * refined.stddev[0]);
}

TEST(Refine, SaysWhyItFailed) {
  Problem problem(20, failAboveHalf, testing::makeParameters(1, -1.0, 1.0), 0.002);
  const Refined refined = problem.refineFrom(VectorXd::Zero(20), {{"map", makeVector({0.8})}});
  EXPECT_EQ(refined.status, RefinementStatus::kFailed);
  EXPECT_EQ(refined.message, "cannot be");
  EXPECT_EQ(refined.point, makeVector({0.8}));
}

TEST(Refine, GivesTheSameBitsForAnyNumberOfThreads) {
  Problem problem = makeSine();
  std::vector<RefinementTask> tasks;
  for (std::uint64_t i = 0; i < 12; ++i) {
    const VectorXd truth = makeVector({0.7 + 0.1 * static_cast<double>(i)});
    tasks.push_back({problem.measure(truth, kSineNoise, i), {{"map", truth * 1.01}}, {0, 1}});
  }
  const std::vector<Refined> serial = refineAll(problem.simulator, problem.model, tasks, 1);
  const std::vector<Refined> parallel = refineAll(problem.simulator, problem.model, tasks, 3);
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    EXPECT_EQ(serial[i].status, parallel[i].status);
    EXPECT_EQ(serial[i].point, parallel[i].point);
    EXPECT_EQ(serial[i].simulations, parallel[i].simulations);
  }
}

TEST(Refine, IsGivenUpWhereTheFirstAllFail) {
  Problem hopeless(20, failAboveHalf, testing::makeParameters(1, -1.0, 1.0), 0.002);
  const RefinementTask task{VectorXd::Zero(20), {{"map", makeVector({0.8})}}, {0, 1}};
  const std::vector<Refined> refined =
      refineOrAbortEarly(hopeless.simulator, hopeless.model, std::vector<RefinementTask>(18, task), 2);
  ASSERT_EQ(refined.size(), 18u);
  EXPECT_EQ(refined[15].message, "cannot be");
  EXPECT_EQ(refined[16].message, "not tried: none of the first 16 was accepted");
  EXPECT_EQ(refined[17].status, RefinementStatus::kFailed);
  EXPECT_EQ(refined[17].point, makeVector({0.8}));
  EXPECT_EQ(refined[17].simulations, 0);
}

TEST(Refine, GoesOnWhereOneOfTheFirstIsAccepted) {
  Problem problem = makeSine();
  const VectorXd truth = makeVector({0.9});
  const RefinementTask good{problem.measure(truth, kSineNoise, 3), {{"map", truth * 1.01}}, {0, 1}};
  const RefinementTask bad{VectorXd::Constant(good.features.size(), 100.0), {{"map", truth}}, {0, 1}, false};
  std::vector<RefinementTask> tasks(20, bad);
  tasks[7] = good;
  tasks[18] = good;
  const std::vector<Refined> refined = refineOrAbortEarly(problem.simulator, problem.model, tasks, 2);
  EXPECT_TRUE(refined[7].isAccepted());
  EXPECT_TRUE(refined[18].isAccepted());
  EXPECT_FALSE(refined[19].isAccepted());
  EXPECT_GT(refined[19].simulations, 0);
}

}  // namespace
}  // namespace twinmap
