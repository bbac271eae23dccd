#include "framework/estimation/posterior/agreement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "framework/base/random/random.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "tests/case_turns.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<ParameterSpec> makeUnknown(Index count) {
  std::vector<ParameterSpec> unknown;
  for (Index j = 0; j < count; ++j) {
    unknown.emplace_back();
    unknown.back().name = {std::string(1, static_cast<char>('a' + j)), {}};
    unknown.back().bounds = {-1.0, 1.0, {}};  // not of one sign: LogCoordinates are the parameters
  }
  return unknown;
}

/// Least-squares measurements of two shared parameters, each with an offset of its own: exact misfits.
struct LinearTrials {
  std::vector<MatrixXd> jacobians;
  PosteriorProblem problem;
  std::vector<PartInformation> parts;
};

LinearTrials makeLinearTrials(const std::vector<double>& scales) {
  LinearTrials trials;
  constexpr Index kShared = 2, kRows = 12;
  trials.problem.unknown = makeUnknown(kShared + static_cast<Index>(scales.size()));
  for (std::size_t k = 0; k < scales.size(); ++k) {
    const MatrixXd jacobian =
        scales[k] * MatrixXd::NullaryExpr(kRows, 3, [&](Index i, Index j) {
          return std::sin(1.0 + 0.7 * static_cast<double>((i + 1) * (j + 1)) + static_cast<double>(k));
        });
    trials.jacobians.push_back(jacobian);
    trials.parts.push_back({{0, 1, kShared + static_cast<Index>(k)}, jacobian.transpose() * jacobian, {}});
  }
  return trials;
}

double calcLeast(const MatrixXd& jacobian, const VectorXd& errors) {
  const MatrixXd information = jacobian.transpose() * jacobian;
  const VectorXd fitted =
      jacobian * linalg::solvePositiveDefinite(information, VectorXd(jacobian.transpose() * errors));
  return (errors - fitted).squaredNorm();
}

/// p-value of measurements with random errors, the second of a machine that differs by `shift`. What a trial
/// of hardly any sensitivity could fit lies far outside the bounds: within them it fits nothing.
double testOnce(LinearTrials trials, std::uint64_t seed, double shift) {
  constexpr double kInsensitive = 0.01;
  const auto u = static_cast<Index>(trials.problem.unknown.size());
  const RandomStream random(seed, RandomPurpose::kVerification);
  std::vector<double> separate;
  MatrixXd information = MatrixXd::Zero(u, u);
  VectorXd gradient = VectorXd::Zero(u);
  double joint = 0.0;
  for (std::size_t k = 0; k < trials.parts.size(); ++k) {
    const MatrixXd& jacobian = trials.jacobians[k];
    VectorXd errors(jacobian.rows());
    random.drawNormals(k, 0, errors.data(), static_cast<std::size_t>(errors.size()));
    errors += (k == 1 ? shift : 0.0) * jacobian.col(0);
    trials.parts[k].descent = jacobian.transpose() * errors;
    const bool fits = jacobian.cwiseAbs().maxCoeff() > kInsensitive;
    separate.push_back(fits ? calcLeast(jacobian, errors) : errors.squaredNorm());
    joint += errors.squaredNorm();
    if (fits) {
      information(trials.parts[k].unknown, trials.parts[k].unknown) += trials.parts[k].information;
      gradient(trials.parts[k].unknown) += jacobian.transpose() * errors;
    }
  }
  information.diagonal().array() += 1e-9;  // what no trial determines
  joint -= gradient.dot(linalg::solvePositiveDefinite(information, gradient));
  return testAgreement(joint, separate, trials.parts, trials.problem, VectorXd::Zero(u), seed).p_value;
}

/// Of 200 tests of what agrees, or of those whose turn it is.
std::vector<std::uint64_t> drawSeeds() {
  const std::vector<int> turn = testing::takeTurn(200);
  std::vector<std::uint64_t> seeds;
  std::transform(turn.begin(), turn.end(), std::back_inserter(seeds), [](int i) { return 1 + i; });
  return seeds;
}

struct AlarmCount {
  int tests = 0, below = 0, far_below = 0;

  void add(double p) {
    ++tests;
    below += p < 0.2 ? 1 : 0;
    far_below += p < kMismatchLevel ? 1 : 0;
  }

  void expectTheStatedRate() const {
    EXPECT_NEAR(below / static_cast<double>(tests), 0.2, 3.0 * std::sqrt(0.16 / tests));
    const double expected = kMismatchLevel * tests;
    EXPECT_LE(far_below, expected + 4.2 * std::sqrt(expected));  // 7 of 200, 3 of 40: p = 0.001
  }
};

TEST(Agreement, FalseAlarmsHaveTheStatedRate) {
  const LinearTrials trials = makeLinearTrials({40.0, 60.0, 50.0});
  AlarmCount alarms;
  for (const std::uint64_t seed : drawSeeds()) {
    alarms.add(testOnce(trials, seed, 0.0));
  }
  alarms.expectTheStatedRate();
}

TEST(Agreement, IsRefusedWhereOneMachineDiffers) {
  const LinearTrials trials = makeLinearTrials({40.0, 60.0, 50.0});
  EXPECT_LT(testOnce(trials, 1, 0.05), kMismatchLevel);
}

TEST(Agreement, ATrialThatDeterminesNothingContradictsNothing) {
  // the second trial sees its parameters with a standard deviation of many bounds
  const LinearTrials trials = makeLinearTrials({40.0, 1e-3});
  int below = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    below += testOnce(trials, seed, 0.0) < 0.1 ? 1 : 0;
  }
  EXPECT_LE(below, 14);  // 6 are expected
}

TEST(Agreement, FalseAlarmsHaveTheirRateWhereATrialSeesADifferenceAlone) {
  // its Newton step goes along the sum to a corner of the bounds, which must not be cut coordinate by
  // coordinate
  LinearTrials trials = makeLinearTrials({400.0, 600.0});
  trials.jacobians[1].col(1) = -trials.jacobians[1].col(0);
  trials.parts[1].information = trials.jacobians[1].transpose() * trials.jacobians[1];
  AlarmCount alarms;
  for (const std::uint64_t seed : drawSeeds()) {
    const RandomStream random(seed, RandomPurpose::kVerification);
    for (std::size_t k = 0; k < 2; ++k) {
      VectorXd errors(trials.jacobians[k].rows());
      random.drawNormals(k, 0, errors.data(), static_cast<std::size_t>(errors.size()));
      trials.parts[k].descent = trials.jacobians[k].transpose() * errors;
    }
    alarms.add(
        testAgreement(20.0, {12.0, 8.0}, trials.parts, trials.problem, VectorXd::Zero(4), seed).p_value);
  }
  alarms.expectTheStatedRate();
}

TEST(Agreement, WhatATrialFitsFarFromTheJointEstimateContradictsLittle) {
  // alone the second trial fits along a bent valley what its linear model does not say
  LinearTrials trials = makeLinearTrials({40.0, 1e-3});
  for (PartInformation& part : trials.parts) {
    part.descent = VectorXd::Zero(3);
  }
  const auto test = [&](double excess) {
    return testAgreement(20.0 + excess, {12.0, 8.0}, trials.parts, trials.problem, VectorXd::Zero(4), 1)
        .p_value;
  };
  EXPECT_GT(test(5.0), 0.5);
  EXPECT_LT(test(20.0), kMismatchLevel);  // chi-square of two degrees of freedom: e^-10
}

}  // namespace
}  // namespace twinmap
