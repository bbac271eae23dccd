#include "framework/estimation/posterior/profile_likelihood.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "framework/estimation/posterior/simulator_posterior.hpp"
#include "tests/framework/estimation/refined/problem.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::makeVector;
using testing::Problem;

SimulatorPosterior sample(Problem& problem, const VectorXd& features) {
  const auto u = static_cast<Index>(problem.model.getUnknown().size());
  SimulatorPosteriorOptions options;
  options.profiles = true;
  return samplePosterior(problem.simulator, problem.model, {}, features, VectorXd::Zero(u), MatrixXd(u, 0),
                         options);
}

TEST(ProfileLikelihood, OfANormalPosteriorIsAParabola) {
  const MatrixXd matrix = MatrixXd::NullaryExpr(
      30, 3, [](Index i, Index j) { return std::sin(1.0 + 0.7 * static_cast<double>((i + 1) * (j + 1))); });
  constexpr double kNoise = 0.05;
  Problem problem(
      30, [=](const VectorXd& x) -> VectorXd { return matrix * x; }, testing::makeParameters(3, -2.0, 2.0),
      kNoise);
  const VectorXd features = problem.measure(makeVector({0.2, -0.1, 0.3}), kNoise);
  const MatrixXd covariance = kNoise * kNoise * (matrix.transpose() * matrix).inverse();
  const VectorXd mean = covariance * matrix.transpose() * features / (kNoise * kNoise);
  const SimulatorPosterior posterior = sample(problem, features);
  ASSERT_EQ(posterior.profiles.size(), 3u);
  for (const Profile& profile : posterior.profiles) {
    const Index j = profile.parameter;
    ASSERT_EQ(profile.log_ratios.size(), 13);
    EXPECT_LT(profile.log_ratios.minCoeff(), -4.0);
    for (Index i = 0; i < 13; ++i) {
      const double apart = profile.points(j, i) - mean[j];
      EXPECT_NEAR(profile.log_ratios[i], -0.5 * apart * apart / covariance(j, j), 0.01);
      EXPECT_NEAR(profile.points((j + 1) % 3, i),
                  mean[(j + 1) % 3] + covariance((j + 1) % 3, j) / covariance(j, j) * apart, 1e-3);
    }
  }
}

TEST(ProfileLikelihood, FollowsWhatTheMeasurementLeavesFlat) {
  Problem problem(
      20, [](const VectorXd& x) { return VectorXd::Constant(20, x[0] * x[1]); },
      testing::makeParameters(2, 0.5, 5.0), 0.3);
  const VectorXd features = problem.measure(makeVector({1.5, 2.0}), 0.3);
  const SimulatorPosterior posterior = sample(problem, features);
  ASSERT_EQ(posterior.profiles.size(), 2u);
  for (const Profile& profile : posterior.profiles) {
    const auto held = profile.points.row(profile.parameter);
    EXPECT_GT(held.maxCoeff() / held.minCoeff(), 4.0);
    for (Index i = 0; i < profile.log_ratios.size(); ++i) {
      if (features.mean() / held[i] > 0.5 && features.mean() / held[i] < 5.0) {
        EXPECT_NEAR(profile.points.col(i).prod(), features.mean(), 0.01);
        EXPECT_NEAR(profile.log_ratios[i], 0.0, 0.01);
      }
    }
  }
}

TEST(ProfileLikelihood, TakesTheBetterOfTwoModes) {
  // the sign of b decides which a fits
  Problem problem(
      2,
      [](const VectorXd& x) {
        return makeVector({x[1] * x[1], x[0] + 0.5 * x[1]});
      },
      testing::makeParameters(2, -2.0, 2.0), 0.1);
  const SimulatorPosterior posterior = sample(problem, makeVector({1.0, 0.2}));
  ASSERT_EQ(posterior.profiles.size(), 2u);
  const Profile& of_a = posterior.profiles.front();
  for (Index i = 0; i < of_a.log_ratios.size(); ++i) {
    if (std::abs(0.2 - of_a.points(0, i)) > 0.1) {
      EXPECT_GT(of_a.points(1, i) * (0.2 - of_a.points(0, i)), 0.0) << of_a.points.col(i).transpose();
    }
  }
}

TEST(ProfileLikelihood, IsNotThereUnlessItIsAskedFor) {
  Problem problem(
      20, [](const VectorXd& x) { return VectorXd::Constant(20, x[0] * x[1]); },
      testing::makeParameters(2, 0.5, 5.0), 0.3);
  const SimulatorPosterior posterior =
      samplePosterior(problem.simulator, problem.model, {}, problem.measure(makeVector({1.5, 2.0}), 0.3),
                      VectorXd::Zero(2), MatrixXd(2, 0), {});
  EXPECT_TRUE(posterior.isReliable());
  EXPECT_TRUE(posterior.profiles.empty());
}

}  // namespace
}  // namespace twinmap
