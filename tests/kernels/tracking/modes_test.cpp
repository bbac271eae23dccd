#include "kernels/tracking/modes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/kernels/tracking/lives.hpp"

namespace twinmap::tracking {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Belief makeBelief(double mean, double stddev) {
  return {VectorXd::Constant(1, mean), MatrixXd::Constant(1, 1, stddev * stddev)};
}

/// -.5 or .5, of which each is known to .02.
Measurement makeMirror(const Model& model) {
  return makeLikelihood(makePrior(model), {makeBelief(-0.5, 0.02), makeBelief(0.5, 0.02)},
                        Eigen::Vector2d(0.3, 0.7));
}

Belief update(const Measurement& measurement, Belief belief) {
  update({measurement.rows.transpose(), measurement.values}, belief);
  return belief;
}

TEST(Modes, OfWhichTheBeliefKnowsOneAreThatOne) {
  const Model model = testing::makeModel(1, 0.0);
  const Measurement resolved = resolveModes(model, makeMirror(model), {}, makeBelief(-0.45, 0.05));
  const Belief after = update(resolved, makeBelief(-0.45, 0.05));
  // the mode's likelihood: its belief less the prior
  const double information = 1.0 / 0.0004 - 3.0, all = information + 400.0;
  EXPECT_NEAR(after.covariance(0, 0), 1.0 / all, 1e-12);
  EXPECT_NEAR(after.mean[0], (-0.5 / 0.0004 - 0.45 * 400.0) / all, 1e-12);
}

TEST(Modes, ThatAllFitGiveTheMomentsOfAll) {
  const Model model = testing::makeModel(1, 0.0);
  const Measurement mirror = makeMirror(model);
  const Belief before = makeBelief(0.02, 0.55);
  const Belief after = update(resolveModes(model, mirror, {}, before), before);
  double total = 0.0, mean = 0.0, square = 0.0;  // by quadrature of belief times mixture over prior
  for (double x = -3.0; x < 3.0; x += 1e-4) {
    const auto normal = [&](double m, double s) { return std::exp(-0.5 * std::pow((x - m) / s, 2)) / s; };
    const double density = normal(0.02, 0.55) * (0.3 * normal(-0.5, 0.02) + 0.7 * normal(0.5, 0.02)) /
                           normal(0.0, std::sqrt(1.0 / 3.0));
    total += density, mean += x * density, square += x * x * density;
  }
  mean /= total;
  EXPECT_NEAR(after.mean[0], mean, 1e-3);
  EXPECT_NEAR(after.covariance(0, 0), square / total - mean * mean, 1e-3);
}

TEST(Modes, LetATrackerFollowTheOneThatItKnew) {
  const Model model = testing::makeModel(1, 0.0);
  Tracker tracker(model);
  Measurement first = makeLikelihood(makePrior(model), makeBelief(-0.48, 0.1));
  tracker.advance(first);
  for (int i = 1; i < 10; ++i) {
    Measurement mirror = makeMirror(model);
    mirror.time = i;
    EXPECT_TRUE(tracker.advance(mirror).is_used);
  }
  EXPECT_NEAR(tracker.calcBelief().mean[0], -0.5, 0.01);
  EXPECT_LT(std::sqrt(tracker.calcBelief().covariance(0, 0)), 0.01);
}

}  // namespace
}  // namespace twinmap::tracking
