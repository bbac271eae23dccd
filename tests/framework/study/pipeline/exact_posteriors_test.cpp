#include "framework/study/pipeline/exact_posteriors.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// One parameter, uniform on [0, 1], by equal draws in its middle.
SimulatorPosterior makeUniform(int draws = 2000) {
  SimulatorPosterior posterior;
  posterior.draws = VectorXd::LinSpaced(draws, 0.5 / draws, 1.0 - 0.5 / draws).transpose();
  posterior.weights = VectorXd::Constant(draws, 1.0 / draws);
  posterior.mean = VectorXd::Constant(1, 0.5);
  posterior.stddev = VectorXd::Constant(1, std::sqrt(1.0 / 12.0));
  posterior.covariance = MatrixXd::Constant(1, 1, 1.0 / 12.0);
  return posterior;
}

SimulatorPosterior makeUnreliable() {
  SimulatorPosterior posterior;
  posterior.message = "too few draws";
  return posterior;
}

Refined makeRefined(double mean, double stddev) {
  Refined refined;
  refined.status = RefinementStatus::kAccepted;
  refined.point = VectorXd::Constant(1, mean);
  refined.stddev = VectorXd::Constant(1, stddev);
  return refined;
}

TEST(ExactPosteriors, HaveIntervalsThatHoldTheirDraws) {
  const ReliablePosteriors found = takeReliable({makeUnreliable(), makeUniform(), makeUnreliable()}, 1);
  ASSERT_EQ(found.samples, std::vector<Index>{1});
  EXPECT_EQ(found.estimates.mean(0, 0), 0.5);
  const IntervalFactor factor = found.estimates.interval_factors.get(0, 0);
  EXPECT_NEAR(factor.of50 * found.estimates.stddev(0, 0), 0.25, 1e-3);
  EXPECT_NEAR(factor.of95 * found.estimates.stddev(0, 0), 0.475, 1e-3);
}

TEST(ExactPosteriors, OfTestSamplesMakeARowOfMethods) {
  ParameterSpec parameter;
  parameter.name.text = "a";
  parameter.bounds = {0.0, 1.0, {}};
  parameter.relative_to = RelativeTo::kRange;
  MatrixXd truth(1, 5);
  truth << 0.1, 0.01, 0.6, 0.5, 0.9;
  const MethodSummary found = summarizePosteriors(
      {parameter}, truth, {makeUniform(), makeUniform(), makeUnreliable(), makeUniform(), makeUniform()}, {});
  EXPECT_EQ(found.samples, 5);
  EXPECT_EQ(found.accepted, 4);
  EXPECT_EQ(found.metrics[0].coverage95, 0.75);  // 0.01 is beyond 0.025
  EXPECT_EQ(found.metrics[0].coverage50, 0.25);
  EXPECT_EQ(summarizePosteriors({parameter}, truth, {makeUnreliable(), makeUniform()}, {}).accepted, 0);
}

TEST(ExactPosteriors, TellHowManyRefinedEstimatesDiffer) {
  const double sd = std::sqrt(1.0 / 12.0);
  Refined rejected = makeRefined(9.0, sd);
  rejected.status = RefinementStatus::kMisfit;
  const std::vector<Refined> refined{makeRefined(0.5 + 0.29 * sd, sd),
                                     makeRefined(0.5 - 0.31 * sd, sd),
                                     makeRefined(0.5, 0.69 * sd),
                                     makeRefined(0.5, 1.29 * sd),
                                     rejected,
                                     makeRefined(0.5, sd)};
  std::vector<SimulatorPosterior> posteriors(5, makeUniform());
  PosteriorDifference found = compareRefined(refined, posteriors, 1);
  EXPECT_EQ(found.compared, 4);
  EXPECT_EQ(found.apart, 2);
  EXPECT_TRUE(found.isConspicuous());
  posteriors.push_back(makeUnreliable());
  EXPECT_EQ(compareRefined(refined, posteriors, 1).compared, 4);
  found = {40, 2};
  EXPECT_FALSE(found.isConspicuous());
}

}  // namespace
}  // namespace twinmap
