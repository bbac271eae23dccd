#include "kernels/tracking/tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "kernels/tracking/flat_state.hpp"
#include "kernels/tracking/whole_course.hpp"
#include "tests/kernels/tracking/lives.hpp"

namespace twinmap::tracking {
namespace {

using testing::Life;
using testing::LivingMachine;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// How many alarms lives without a change raise.
int countAlarms(Eigen::Index p, double ratio, double rate, int lives, int measurements, double bad = 0.0) {
  int alarms = 0;
  for (int l = 0; l < lives; ++l) {
    LivingMachine machine(p, {ratio, 0.0, 0.0, -1, bad}, static_cast<unsigned>(l + 1));
    Tracker tracker(testing::makeModel(p, rate));
    for (int i = 0; i < measurements; ++i) {
      alarms += tracker.advance(machine.measure()).change ? 1 : 0;
    }
  }
  return alarms;
}

// 30 are expected of 30000; 17 to 44 is the 99 % interval of a binomial, and thresholds are known to a fifth
constexpr int kFewest = 14, kMost = 53;

TEST(Alarms, OfConstantsAreAsRareAsStated) {
  const int alarms = countAlarms(1, 0.0, 0.0, 100, 300);
  EXPECT_GE(alarms, kFewest);
  EXPECT_LE(alarms, kMost);
}

TEST(Alarms, OfKnownWalksAreAsRareAsStated) {
  const double ratio = 0.3;
  const int alarms = countAlarms(1, ratio, testing::calcRate(ratio), 100, 300);
  EXPECT_GE(alarms, kFewest);
  EXPECT_LE(alarms, kMost);
}

TEST(Alarms, OfUnknownWalksAreAsRareAsStated) {
  const int alarms = countAlarms(1, 0.3, kUnknown, 100, 300);
  EXPECT_GE(alarms, kFewest);
  EXPECT_LE(alarms, kMost);
}

struct Delays {
  std::vector<int> found;  ///< measurements after the step, that one included
  int right = 0;           ///< of the right parameter
};

Delays findSteps(Eigen::Index p, double step, int lives) {
  constexpr int kAt = 100, kAfter = 60;
  Delays delays;
  for (int l = 0; l < lives; ++l) {
    LivingMachine machine(p, {0.0, 0.0, step, kAt}, static_cast<unsigned>(l + 1000));
    Tracker tracker(testing::makeModel(p, 0.0));
    for (int i = 0; i < kAt + kAfter; ++i) {
      const Step one = tracker.advance(machine.measure());
      if (i >= kAt && one.change) {
        delays.found.push_back(i - kAt + 1);
        delays.right += one.change->parameter == 0 ? 1 : 0;
        break;
      }
    }
  }
  std::sort(delays.found.begin(), delays.found.end());
  return delays;
}

int takeMedian(const std::vector<int>& sorted) {
  return sorted[sorted.size() / 2];
}

TEST(Alarms, FindStepsOfOneStandardDeviationWithinFifteen) {
  EXPECT_LE(takeMedian(findSteps(2, 1.0, 60).found), 15);
}
TEST(Alarms, FindStepsOfTwoStandardDeviationsWithinFive) {
  EXPECT_LE(takeMedian(findSteps(2, 2.0, 60).found), 5);
}
TEST(Alarms, FindLargerStepsWithinTwoAndMissNone) {
  for (const double step : {5.0, 9.0, 30.0, 500.0}) {
    const Delays delays = findSteps(2, step, 40);
    EXPECT_EQ(delays.found.size(), 40U) << step;
    EXPECT_LE(takeMedian(delays.found), 2) << step;
    EXPECT_GE(delays.right, 38) << step;
  }
}

TEST(Alarms, AreNotRaisedByOneBadMeasurement) {
  LivingMachine machine(2, {}, 5);
  Tracker tracker(testing::makeModel(2, 0.0));
  for (int i = 0; i < 50; ++i) {
    tracker.advance(machine.measure());
  }
  const Belief before = tracker.calcBelief();
  Measurement bad = machine.measure();
  bad.values[1] += 30.0;
  const Step step = tracker.advance(bad);
  EXPECT_FALSE(step.is_used);
  EXPECT_FALSE(step.change.has_value());
  EXPECT_EQ(tracker.calcBelief().mean, before.mean);
}

TEST(Tracker, UsesMeasurementsThatAreNearerThanNoiseIs) {
  Tracker tracker(testing::makeModel(4, 0.0));
  Measurement measurement = LivingMachine(4, {}, 1).measure();
  measurement.values.setConstant(1e-3);
  EXPECT_TRUE(tracker.advance(measurement).is_used);
}

// An alarm at its threshold is as likely false as true: a band that believed it would hold .93 at most.
TEST(Tracker, HoldsWhatItSaysOfAConstantAfterFalseAlarms) {
  int held = 0, all = 0;
  for (unsigned l = 0; l < 150; ++l) {
    LivingMachine machine(1, {}, l);
    Model model = testing::makeModel(1, 0.0);
    model.false_alarms = 0.01;
    Tracker tracker(model);
    bool has_alarm = false;
    for (int i = 0; i < 200; ++i) {
      has_alarm = tracker.advance(machine.measure()).change || has_alarm;
      const Belief belief = tracker.calcBelief();
      const double off = std::abs(belief.mean[0] - machine.getTruth()[0]);
      held += has_alarm && off < 1.96 * std::sqrt(belief.covariance(0, 0)) ? 1 : 0;
      all += has_alarm ? 1 : 0;
    }
  }
  EXPECT_GT(static_cast<double>(held) / all, 0.93);
  EXPECT_LT(static_cast<double>(held) / all, 0.97);
}

TEST(WholeCourse, TakesBackAChangeThatLaterMeasurementsSpeakAgainst) {
  int with_alarm = 0, taken_back = 0;
  for (unsigned l = 0; l < 60; ++l) {
    LivingMachine machine(1, {}, l);
    Model model = testing::makeModel(1, 0.0);
    model.false_alarms = 0.01;
    std::vector<Measurement> measurements;
    bool has_alarm = false, has_late_one = false;  // of which nothing is known yet
    Tracker tracker(model);
    for (int i = 0; i < 200; ++i) {
      measurements.push_back(machine.measure());
      const bool is_alarm = tracker.advance(measurements.back()).change.has_value();
      (i < 100 ? has_alarm : has_late_one) |= is_alarm;
    }
    if (has_alarm && !has_late_one) {
      ++with_alarm;
      const WholeCourse course = calcWholeCourse(model, measurements);
      const double moved = course.smoothed.means(0, 199) - course.smoothed.means(0, 0);
      taken_back += std::abs(moved) < 1e-6 ? 1 : 0;
    }
  }
  EXPECT_GT(with_alarm, 8);
  EXPECT_GE(2 * taken_back, with_alarm);  // chance alone speaks for the others to the end
}

TEST(Tracker, HoldsWhatItSaysWhereOneInTwentyIsBad) {
  int held = 0, all = 0;
  for (unsigned l = 0; l < 40; ++l) {
    LivingMachine machine(1, {0.3, 0.0, 0.0, -1, 0.05}, l);
    Tracker tracker(testing::makeModel(1, kUnknown));
    for (int i = 0; i < 200; ++i) {
      tracker.advance(machine.measure());
      const Belief belief = tracker.calcBelief();
      held += std::abs(belief.mean[0] - machine.getTruth()[0]) < 1.96 * std::sqrt(belief.covariance(0, 0))
                  ? 1
                  : 0;
      ++all;
    }
  }
  EXPECT_GT(static_cast<double>(held) / all, 0.92);
  EXPECT_LT(static_cast<double>(held) / all, 0.975);
}

// An estimator that is not refined errs in the same way of the same machine, however often that is measured.
TEST(Tracker, HoldsWhatItSaysWhereMeasurementsShareAnError) {
  constexpr double kShared = 0.5;  // of a measurement's standard deviation
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  int filtered = 0, smoothed = 0, blind = 0;
  constexpr int kLives = 100, kMeasurements = 100;
  for (unsigned l = 0; l < kLives; ++l) {
    LivingMachine machine(1, {}, l);
    Model model = testing::makeModel(1, 0.0);
    model.drifts[0].shared_error = kShared;
    const double error = kShared * normal(random);
    std::vector<Measurement> measurements;
    for (int i = 0; i < kMeasurements; ++i) {
      measurements.push_back(machine.measure());
      measurements.back().values.array() += error;
    }
    const double truth = machine.getTruth()[0];
    const auto holds = [&](const Course& course) {
      return std::abs(course.means(0, kMeasurements - 1) - truth) <
             1.96 * course.stddevs(0, kMeasurements - 1);
    };
    const WholeCourse course = calcWholeCourse(model, measurements);
    filtered += holds(course.filtered) ? 1 : 0;
    smoothed += holds(course.smoothed) ? 1 : 0;
    model.drifts[0].shared_error = 0.0;
    blind += holds(calcWholeCourse(model, measurements).filtered) ? 1 : 0;
  }
  EXPECT_GE(filtered, 89);  // 95 are expected of 100: at most three standard errors less
  EXPECT_EQ(smoothed, filtered);
  EXPECT_LT(blind, 60);
}

TEST(Tracker, EstimatesRatesWithinAFactorOfTwo) {
  constexpr int kLives = 40;
  int within = 0;
  for (unsigned l = 0; l < kLives; ++l) {
    LivingMachine machine(1, {0.5}, l);
    Tracker tracker(testing::makeModel(1, kUnknown));
    for (int i = 0; i < 300; ++i) {
      tracker.advance(machine.measure());
    }
    const double ratio = estimateRate(calcRatePosterior(tracker.getState().filters[0])).median / 0.5;
    within += ratio > 0.5 && ratio < 2.0 ? 1 : 0;
  }
  EXPECT_GE(within, kLives - 2);
}

/// The belief after 30 measurements of a walk whose rate is known or not, and years without any that says
/// something.
Belief waitForYears(double rate, double prior, bool comes) {
  Model model = testing::makeModel(1, rate);
  model.covariance(0, 0) = prior;
  testing::LivingMachine machine(1, {0.5}, 4);
  Tracker tracker(model);
  for (int i = 0; i < 30; ++i) {
    tracker.advance(machine.measure());
  }
  constexpr double kYears = 1e6;  // steps: the walk's sd is five times the bounds' half-width by then
  if (comes) {
    for (int i = 1; i <= 500; ++i) {
      Measurement empty{30.0 + i * kYears / 500.0, Eigen::MatrixXd(0, 1), Eigen::VectorXd(0),
                        Eigen::VectorXd::Constant(1, std::numeric_limits<double>::infinity()),
                        Eigen::VectorXd()};
      tracker.advance(empty);
    }
  } else {
    Measurement after = machine.measure();
    after.time += kYears;
    after.rows *= 1e-6;  // it says next to nothing
    after.values *= 1e-6;
    tracker.advance(after);
  }
  return tracker.calcBelief();
}

TEST(Tracker, TakesNoWalkBeyondTheBounds) {
  for (const double rate : {kUnknown, testing::calcRate(0.5)}) {
    for (const bool comes : {true, false}) {
      const double variance = waitForYears(rate, 1.0 / 3.0, comes).covariance(0, 0);
      EXPECT_LT(variance, 1.01 / 3.0);
      EXPECT_GT(variance, std::isnan(rate) ? 0.1 : 0.99 / 3.0);  // rates that are slow have a share
    }
  }
  // a walk may leave a narrow prior; a wide one stays as it was
  EXPECT_NEAR(waitForYears(testing::calcRate(0.5), 1e-4, true).covariance(0, 0), 1.0 / 3.0, 1e-9);
  EXPECT_NEAR(waitForYears(testing::calcRate(0.5), 0.6, true).covariance(0, 0), 0.6, 1e-9);
}

TEST(Tracker, LearnsASlope) {
  Model model = testing::makeModel(1, 0.0);
  model.drifts[0].has_slope = true;
  LivingMachine machine(1, {0.0, 0.2}, 3);
  Tracker tracker(model);
  for (int i = 0; i < 100; ++i) {
    tracker.advance(machine.measure());
  }
  const Belief belief = tracker.calcBelief();
  EXPECT_NEAR(belief.mean[1], 0.2 * testing::kMeasured, 3.0 * std::sqrt(belief.covariance(1, 1)));
  EXPECT_LT(std::sqrt(belief.covariance(1, 1)), 0.005 * testing::kMeasured);
}

TEST(Tracker, BeginsAnewWhereAllParametersHaveChanged) {
  LivingMachine machine(3, {}, 7);
  Tracker tracker(testing::makeModel(3, 0.0));
  for (int i = 0; i < 50; ++i) {
    tracker.advance(machine.measure());
  }
  bool has_begun_anew = false;
  for (int i = 0; i < 12; ++i) {
    Measurement moved = machine.measure();
    moved.values.array() += 40.0;
    has_begun_anew = has_begun_anew || tracker.advance(moved).has_begun_anew;
  }
  EXPECT_TRUE(has_begun_anew);
  const Belief belief = tracker.calcBelief();
  for (Eigen::Index j = 0; j < 3; ++j) {
    EXPECT_NEAR(belief.mean[j], machine.getTruth()[j] + 40.0 * testing::kMeasured,
                4.0 * std::sqrt(belief.covariance(j, j)));
  }
}

TEST(Tracker, GoesOnFromItsNumbersWithTheSameBits) {
  Model model = testing::makeModel(2, kUnknown);
  model.drifts[1] = {1e-6, true};
  LivingMachine machine(2, {0.3}, 9);
  Tracker tracker(model), other(model);
  for (int i = 0; i < 60; ++i) {
    tracker.advance(machine.measure());
  }
  other.setState(unflatten(model, flatten(tracker.getState())));
  for (int i = 0; i < 20; ++i) {
    const Measurement measurement = machine.measure();
    tracker.advance(measurement);
    other.advance(measurement);
  }
  EXPECT_EQ(flatten(tracker.getState()), flatten(other.getState()));
}

TEST(Tracker, RefusesNumbersOfAnotherModel) {
  const std::vector<double> numbers = flatten(Tracker(testing::makeModel(2, 0.0)).getState());
  EXPECT_THROW(unflatten(testing::makeModel(3, 0.0), numbers), std::runtime_error);
  EXPECT_THROW(unflatten(testing::makeModel(2, kUnknown), numbers), std::runtime_error);
}

}  // namespace
}  // namespace twinmap::tracking
