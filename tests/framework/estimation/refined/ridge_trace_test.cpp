#include "framework/estimation/refined/ridge_trace.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/random/random.hpp"
#include "framework/estimation/refined/refine.hpp"
#include "tests/framework/estimation/refined/problem.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using testing::makeVector;
using testing::Problem;

constexpr double kRidgeNoise = 0.1;

/// 20 values that follow from a b (or a + b) alone, and 20 from c.
Problem makeRidge(bool product) {
  const auto response = [product](const VectorXd& x) -> VectorXd {
    VectorXd values(40);
    values << VectorXd::Constant(20, product ? x[0] * x[1] : x[0] + x[1]), VectorXd::Constant(20, x[2]);
    return values;
  };
  return {40, response, testing::makeParameters(3, 1.0, 2.0), kRidgeNoise};
}

Refined refineAt(Problem& problem, const VectorXd& truth) {
  return problem.refineFrom(problem.measure(truth, kRidgeNoise), {{"map", makeVector({1.5, 1.5, 1.5})}});
}

TEST(RidgeTrace, OfAProductIsUniformInTheLogarithm) {
  // of a with a b = s the density is the integral of N(a b; s) over b: 1 / a, from s / 2 to 2
  Problem problem = makeRidge(true);
  const Refined refined = problem.refineFrom(problem.measure(makeVector({1.6, 1.5, 1.4}), 1e-9),
                                             {{"map", makeVector({1.5, 1.5, 1.5})}});
  ASSERT_TRUE(refined.isAccepted()) << refined.message;
  ASSERT_TRUE(refined.ridge.isGiven());
  const double lower = 1.2, upper = 2.0, length = std::log(upper / lower);
  const double mean = (upper - lower) / length;
  const double stddev = std::sqrt((upper * upper - lower * lower) / (2.0 * length) - mean * mean);
  EXPECT_NEAR(refined.mean[0], mean, 0.05 * stddev);
  EXPECT_NEAR(refined.stddev[0], stddev, 0.05 * stddev);
  // the distance from the mean that holds so much of the density
  for (const auto& [factor, probability] : {std::pair(refined.interval_factors.get(0).of95, 0.95),
                                            std::pair(refined.interval_factors.get(0).of50, 0.5)}) {
    const double from = std::max(lower, mean - factor * stddev), to = std::min(upper, mean + factor * stddev);
    EXPECT_NEAR(std::log(to / from) / length, probability, 0.02);
  }
}

TEST(RidgeTrace, LeavesTheOthersWhatTheyAre) {
  Problem problem = makeRidge(true);
  const Refined refined = refineAt(problem, makeVector({1.6, 1.5, 1.4}));
  ASSERT_TRUE(refined.ridge.isGiven());
  const double precision = 20.0 / (kRidgeNoise * kRidgeNoise);
  EXPECT_NEAR(refined.stddev[2], 1.0 / std::sqrt(precision), 0.01 / std::sqrt(precision));
  EXPECT_EQ(refined.interval_factors.get(2).of95, kNormal95);
}

TEST(RidgeTrace, HoldsWhatItDerives) {
  Problem problem = makeRidge(true);
  const Refined refined = refineAt(problem, makeVector({1.6, 1.5, 1.4}));
  ASSERT_TRUE(refined.ridge.isGiven());
  for (Index i = 0; i < refined.ridge.countComponents(); ++i) {
    EXPECT_NEAR(refined.ridge.means(0, i) * refined.ridge.means(1, i), 2.4,
                4.0 * kRidgeNoise / std::sqrt(20.0));
  }
}

TEST(RidgeTrace, IsTakenWhereOneDirectionIsFlat) {
  Problem all(
      30,
      [](const VectorXd& x) -> VectorXd {
        VectorXd values(30);
        values << VectorXd::Constant(15, x[0] * x[1]), VectorXd::Constant(15, x[0]);
        return values;
      },
      testing::makeParameters(2, 1.0, 2.0), kRidgeNoise);
  const Refined refined =
      all.refineFrom(all.measure(makeVector({1.6, 1.5}), kRidgeNoise), {{"map", makeVector({1.5, 1.5})}});
  ASSERT_TRUE(refined.isAccepted()) << refined.message;
  EXPECT_FALSE(refined.ridge.isGiven());
  EXPECT_EQ(refined.mean, refined.point);
}

/// Shares of truths within intervals of 300 measurements of machines anywhere in the box.
void expectCalibrated(bool product) {
  Problem problem = makeRidge(product);
  const RandomStream random(5, RandomPurpose::kTestDesign);
  constexpr int kMeasurements = 300;
  Eigen::Array3d within95 = Eigen::Array3d::Zero(), within50 = Eigen::Array3d::Zero();
  int accepted = 0;
  for (int i = 0; i < kMeasurements; ++i) {
    const VectorXd truth = VectorXd::NullaryExpr(3, [&](Index j) {
      return 1.0 + random.calcUniform(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j));
    });
    const Refined refined =
        problem.refineFrom(problem.measure(truth, kRidgeNoise, i), {{"map", makeVector({1.5, 1.5, 1.5})}});
    if (!refined.isAccepted()) {
      continue;
    }
    ++accepted;
    const Eigen::Array3d z = ((refined.mean - truth).array() / refined.stddev.array()).abs();
    for (Index j = 0; j < 3; ++j) {
      within95[j] += z[j] < refined.interval_factors.get(j).of95 ? 1.0 : 0.0;
      within50[j] += z[j] < refined.interval_factors.get(j).of50 ? 1.0 : 0.0;
    }
  }
  EXPECT_GT(accepted, 0.95 * kMeasurements);
  for (Index j = 0; j < 3; ++j) {  // three standard errors
    EXPECT_NEAR(within95[j] / accepted, 0.95, 0.038) << "parameter " << j;
    EXPECT_NEAR(within50[j] / accepted, 0.5, 0.087) << "parameter " << j;
  }
}

TEST(RidgeTrace, OfAProductIsCalibrated) {
  expectCalibrated(true);
}

TEST(RidgeTrace, OfASumIsCalibrated) {
  expectCalibrated(false);
}

}  // namespace
}  // namespace twinmap
