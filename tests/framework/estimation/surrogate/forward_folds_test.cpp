#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "framework/estimation/folds.hpp"
#include "framework/estimation/surrogate/cross_validation.hpp"
#include "framework/estimation/surrogate/fit_forward.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kSampleTimes = 24, kSimulations = 40, kNumber = 5;
constexpr Index kEnough = 300;  // of which few slopes suffice
constexpr double kNoiseStddev = 0.02;

/// An oscillation whose decay and frequency are the parameters, with its derivatives by hand.
ForwardSamples makeOscillations(Index simulations = kSimulations) {
  ForwardSamples samples;
  samples.points.resize(2, simulations);
  samples.clean_features.resize(kSampleTimes, simulations);
  samples.noise_covariance = kNoiseStddev * kNoiseStddev * MatrixXd::Identity(kSampleTimes, kSampleTimes);
  for (Index j = 0; j < simulations; ++j) {
    const double a = -1.0 + 2.0 * static_cast<double>(j) / (simulations - 1);
    const double b = std::sin(7.0 * static_cast<double>(j));
    samples.points.col(j) << a, b;
    MatrixXd slopes(kSampleTimes, 2);
    for (Index i = 0; i < kSampleTimes; ++i) {
      const double t = 0.25 * static_cast<double>(i + 1), decay = std::exp(-(0.2 + 0.1 * a) * t);
      const double phase = (2.0 + 0.4 * b) * t;
      samples.clean_features(i, j) = decay * std::sin(phase);
      slopes.row(i) << -0.1 * t * decay * std::sin(phase), 0.4 * t * decay * std::cos(phase);
    }
    samples.slopes.push_back(slopes);
  }
  for (Index i = 0; i < kSampleTimes; ++i) {
    samples.infos.push_back({"", "m", 0, 0.25 * static_cast<double>(i + 1)});
  }
  return samples;
}

/// Features at some simulations' points, those of the scores that are kept.
MatrixXd predictScores(const ForwardSurrogate& surrogate, const MatrixXd& points, MatrixXd& stddev) {
  std::vector<gp::SharedProcess::Workspace> workspaces(surrogate.windows.size());
  MatrixXd values(surrogate.getScoreCount(), points.cols());
  stddev.resize(values.rows(), values.cols());
  surrogate.evaluate(points, std::vector<double>(surrogate.windows.size(), 1.0), workspaces, values, stddev);
  return values;
}

/// The folds of a fit and, by its choices, fits of their samples alone.
void expectFoldsAlone(const ForwardSamples& samples, const ForwardFit& fit) {
  for (Index fold = 0; fold < kNumber; ++fold) {
    const ForwardSurrogate& shared = fit.folds[static_cast<std::size_t>(fold)];
    const ForwardSamples kept = selectSimulations(samples, listKept(samples.points.cols(), kNumber, fold));
    const ForwardSurrogate alone = fitForward(kept, fit.choices, {}).surrogate;
    ASSERT_EQ(shared.getScoreCount(), alone.getScoreCount());
    EXPECT_TRUE(shared.projection.isApprox(alone.projection, 1e-8));
    EXPECT_TRUE(shared.points.isApprox(alone.points));
    EXPECT_TRUE(shared.scores.isApprox(alone.scores, 1e-8));
    MatrixXd stddev, stddev_alone;
    const MatrixXd at = samples.points(Eigen::all, listLeftOut(samples.points.cols(), kNumber, fold));
    const MatrixXd values = predictScores(shared, at, stddev);
    const MatrixXd expected = predictScores(alone, at, stddev_alone);
    EXPECT_LT((values - expected).cwiseAbs().maxCoeff(), 1e-3);  // of the noise
    EXPECT_LT((stddev - stddev_alone).cwiseAbs().maxCoeff(), 1e-3);
  }
}

TEST(ForwardFolds, AreThoseThatAreFittedToTheirSamplesAlone) {
  const ForwardSamples samples = makeOscillations();
  const ForwardFit fit = fitForward(samples, {}, {}, listFolds(kSimulations));
  ASSERT_EQ(fit.folds.size(), static_cast<std::size_t>(kNumber));
  EXPECT_TRUE(std::any_of(fit.choices.processes.begin(), fit.choices.processes.end(),
                          [](const gp::SharedChoice& choice) { return choice.structure.slopes; }));
  expectFoldsAlone(samples, fit);
}

TEST(ForwardFolds, TakeFewSlopesWhereErrorsAreFarBelowTheNoise) {
  const ForwardSamples samples = makeOscillations(kEnough);
  const ForwardFit fit = fitForward(samples, {}, {}, listFolds(kEnough));
  const std::vector<double>& shares = fit.choices.slope_shares;
  EXPECT_EQ(*std::max_element(shares.begin(), shares.end()), 200.0 / 300.0);
  EXPECT_LT(fit.surrogate.error_variance.maxCoeff(), 0.02);
  expectFoldsAlone(samples, fit);
}

TEST(ForwardFolds, TakeAllSlopesWhereErrorsMatter) {
  ForwardSamples samples = makeOscillations(kEnough);
  for (Index j = 0; j < kEnough; ++j) {  // no function of the parameters
    samples.clean_features(0, j) += 0.5 * kNoiseStddev * std::sin(1e3 * static_cast<double>(j * j));
  }
  const std::vector<double> shares = fitForward(samples, {}, {}).choices.slope_shares;
  EXPECT_EQ(shares.front(), 1.0);
}

TEST(ForwardFolds, LeaveTheWholeAsItIs) {
  const ForwardSamples samples = makeOscillations();
  const ForwardSurrogate with = fitForward(samples, {}, {}, listFolds(kSimulations)).surrogate;
  const ForwardSurrogate without = fitForward(samples, {}, {}).surrogate;
  EXPECT_EQ(with.scores, without.scores);
  EXPECT_LT((with.error_correlation - without.error_correlation).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_TRUE(with.error_variance.isApprox(without.error_variance, 1e-4));
}

}  // namespace
}  // namespace twinmap
