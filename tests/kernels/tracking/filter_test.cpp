// Filter and smoother against the joint normal distribution of all states, solved as one dense system.
#include <gtest/gtest.h>

#include "kernels/tracking/smoother.hpp"
#include "kernels/tracking/tracker.hpp"
#include "tests/kernels/tracking/lives.hpp"
#include "tests/lu.hpp"

namespace twinmap::tracking {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kCount = 12;

/// Two parameters: one walks with a slope, the other is constant and follows a condition. Measurements tell
/// mixtures of both, at uneven times.
struct Case {
  Model model = testing::makeModel(2, 0.0);
  std::vector<Measurement> measurements;

  Case() {
    model.drifts[0] = {2e-5, true};
    model.follows = {{1, 0, 0.05}};
    model.conditions = 1;
    model.covariance << 0.3, 0.1, 0.1, 0.4;
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (Index i = 0; i < kCount; ++i) {
      Measurement one{i == 0 ? 5.0 : measurements.back().time + 0.5 + static_cast<double>(i % 3),
                      MatrixXd(2, 2), VectorXd(2), VectorXd::Constant(2, 2e-4),
                      VectorXd::Constant(1, 20.0 + normal(random))};
      one.rows << 90.0 + 5.0 * normal(random), 30.0, -20.0, 80.0 + 5.0 * normal(random);
      one.values = one.rows * Eigen::Vector2d(0.2, -0.1) + Eigen::Vector2d(normal(random), normal(random));
      measurements.push_back(one);
    }
  }
};

/// Of the first `count` measurements, all states at their times: n of each, stacked.
struct Joint {
  VectorXd mean;
  MatrixXd covariance;
};

Joint solveJointly(const Case& all, Index count) {
  const Index n = all.model.countStates();
  const double interval = all.measurements[1].time - all.measurements[0].time;
  MatrixXd information = MatrixXd::Zero(n * count, n * count);
  VectorXd descent = VectorXd::Zero(n * count);
  MatrixXd prior = MatrixXd::Zero(n, n);
  prior.topLeftCorner(2, 2) = all.model.covariance;
  prior(2, 2) = 1.0 / (interval * interval);
  prior(3, 3) = 0.05 * 0.05;
  information.topLeftCorner(n, n) += test::calcInverse(prior);
  constexpr double kFixed = 1e12;  // information of what does not move
  for (Index i = 0; i < count; ++i) {
    const Measurement& one = all.measurements[static_cast<std::size_t>(i)];
    MatrixXd rows = MatrixXd::Zero(2, n);
    rows.leftCols(2) = one.rows;
    rows.col(3) = (one.conditions[0] - all.measurements[0].conditions[0]) * one.rows.col(1);
    information.block(n * i, n * i, n, n) += rows.transpose() * rows;
    descent.segment(n * i, n) += rows.transpose() * one.values;
    if (i > 0) {
      const double dt = one.time - all.measurements[static_cast<std::size_t>(i - 1)].time;
      MatrixXd moved(n, 2 * n);
      moved << -MatrixXd::Identity(n, n), MatrixXd::Identity(n, n);
      moved(0, 2) = -dt;
      VectorXd weights = VectorXd::Constant(n, kFixed);
      weights[0] = 1.0 / (2e-5 * dt);
      information.block(n * (i - 1), n * (i - 1), 2 * n, 2 * n) +=
          moved.transpose() * weights.asDiagonal() * moved;
    }
  }
  const MatrixXd covariance = test::calcInverse(information);
  return {covariance * descent, covariance};
}

constexpr double kTolerance = 1e-6;  // of kFixed's rounding

TEST(Filter, IsTheJointNormalDistributionsLastState) {
  const Case all;
  Tracker tracker(all.model);
  for (Index i = 0; i < kCount; ++i) {
    tracker.advance(all.measurements[static_cast<std::size_t>(i)]);
    if (i == 0) {
      continue;  // the unit of the slope is not known yet
    }
    const Joint joint = solveJointly(all, i + 1);
    const Index n = all.model.countStates();
    const Belief belief = tracker.calcBelief();
    EXPECT_LT((belief.mean - joint.mean.tail(n)).cwiseAbs().maxCoeff(), kTolerance);
    const MatrixXd expected = joint.covariance.bottomRightCorner(n, n);
    EXPECT_LT((belief.covariance - expected).norm(), kTolerance * expected.norm() + 1e-9);
  }
}

TEST(Smoother, IsTheJointNormalDistributionsEveryState) {
  const Case all;
  Tracker tracker(all.model);
  std::vector<SmoothedStep> steps;
  for (const Measurement& one : all.measurements) {
    tracker.advance(one);
  }
  const TrackerState& state = tracker.getState();
  for (std::size_t i = 0; i < all.measurements.size(); ++i) {
    const Measurement& one = all.measurements[i];
    steps.push_back({i > 0 ? one.time - all.measurements[i - 1].time : 0.0,
                     makeStateRows(all.model, one, state.reference, state.spread, state.belief),
                     {},
                     {}});
  }
  steps[0].units = VectorXd::Zero(4);
  steps[0].units.tail(2) = tracker.calcUnits();
  const Smoothed smoothed = smooth(all.model, steps, tracker.calcRates());
  const Joint joint = solveJointly(all, kCount);
  for (Index i = 0; i < kCount; ++i) {
    for (Index j = 0; j < 2; ++j) {
      EXPECT_NEAR(smoothed.course.means(j, i), joint.mean[4 * i + j], kTolerance);
      const double stddev = std::sqrt(joint.covariance(4 * i + j, 4 * i + j));
      EXPECT_NEAR(smoothed.course.stddevs(j, i), stddev, 1e-4 * stddev);
    }
  }
}

TEST(Filter, OfAConstantIsTheMean) {
  Model model = testing::makeModel(1, 0.0);
  model.covariance(0, 0) = 1e6;
  Tracker tracker(model);
  for (const double value : {1.0, 2.0, 6.0}) {
    tracker.advance({value,
                     MatrixXd::Constant(1, 1, 0.25),
                     VectorXd::Constant(1, 0.25 * value),
                     VectorXd::Constant(1, 16.0),
                     {}});
  }
  EXPECT_NEAR(tracker.calcBelief().mean[0], 3.0, 1e-4);  // of the prior
  EXPECT_NEAR(tracker.calcBelief().covariance(0, 0), 16.0 / 3.0, 1e-4);
}

TEST(Filter, OfAWalkOfATenthOfAMeasurementsVarianceKnowsHalfOfItsStandardDeviation) {
  // the fixed point of P = (P + q) r / (P + q + r), q = .1 r: P = .27 r
  testing::LivingMachine machine(1, {std::sqrt(0.1)}, 1);
  Tracker tracker(testing::makeModel(1, testing::calcRate(std::sqrt(0.1))));
  for (int i = 0; i < 100; ++i) {
    tracker.advance(machine.measure());
  }
  EXPECT_NEAR(std::sqrt(tracker.calcBelief().covariance(0, 0)) / testing::kMeasured, 0.5197, 1e-3);
}

TEST(Filter, LeavesACoefficientWhereItsConditionIsMissing) {
  Case all;
  Tracker tracker(all.model);
  for (const Measurement& one : all.measurements) {
    tracker.advance(one);
  }
  const Belief before = tracker.calcBelief();
  Measurement missing = all.measurements.back();
  missing.time += 1.0;
  missing.conditions[0] = std::nan("");
  tracker.advance(missing);
  const Belief after = tracker.calcBelief();
  EXPECT_LT(after.covariance(1, 1), before.covariance(1, 1));
  // its covariance with the level lets it move a little; by itself it learns nothing
  EXPECT_NEAR(after.covariance(3, 3), before.covariance(3, 3), 0.02 * before.covariance(3, 3));
}

}  // namespace
}  // namespace twinmap::tracking
