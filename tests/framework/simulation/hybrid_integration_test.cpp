#include "framework/simulation/integration/hybrid_integration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace twinmap {
namespace {

/// x' = rate * x + 1 from 0; back to 0 where x reaches 1, a state event, and at t = 2.5, a time event.
class Sawtooth : public HybridProblem {
 public:
  explicit Sawtooth(double rate, int outputs) : rate_(rate), values_(outputs) {}

  std::size_t getIndicatorCount() const override { return 1; }
  void calcIndicators(double, const State& x, double* indicators) override { indicators[0] = 1.0 - x[0]; }
  bool completeStep(double, const State&) override { return false; }
  void handleEvent(double t, State& x) override {
    events_.push_back(t);
    x[0] = 0.0;
  }
  void enterPhase(double, State&) override {}
  double getNextEventTime() const override {
    const bool over = !events_.empty() && events_.back() >= kTimeEvent;
    return over ? std::numeric_limits<double>::infinity() : kTimeEvent;
  }
  bool isOver() const override { return false; }
  void calcDerivative(double, const State& x, State& dxdt) override { dxdt[0] = rate_ * x[0] + 1.0; }
  void recordOutput(int index, double, const State& x) override { values_[index] = x[0]; }

  static constexpr double kTimeEvent = 2.5;
  double rate_;
  std::vector<double> values_, events_;
};

const IntegrationOptions kOptions{1e-10, 1e-12, 10000, 60.0};

TEST(HybridIntegration, LocatesStateEventsAndMeetsTimeEvents) {
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(31, 0.0, 3.0);
  Sawtooth problem(0.5, 31);
  const HybridReport report = integrateHybrid(problem, {0.0}, {0.0, 3.0}, times, kOptions);
  ASSERT_EQ(report.failure, "");
  const double period = 2.0 * std::log(1.5);  // (exp(rate t) - 1) / rate = 1
  ASSERT_EQ(problem.events_.size(), 4U);
  EXPECT_NEAR(problem.events_[0], period, 1e-9);
  EXPECT_NEAR(problem.events_[2], 3.0 * period, 3e-9);
  EXPECT_EQ(problem.events_[3], 2.5);
  EXPECT_EQ(report.state_events, 3);
  EXPECT_NEAR(problem.values_[9], 2.0 * (std::exp(0.5 * (0.9 - period)) - 1.0), 1e-8);
  EXPECT_EQ(problem.values_[25], 0.0);  // after the event at its time
  EXPECT_NEAR(problem.values_[30], 2.0 * std::expm1(0.25), 1e-9);
}

TEST(HybridIntegration, ReplaysStepsWithTimeEvents) {
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(31, 0.0, 3.0);
  Sawtooth problem(-2.0, 31);  // never reaches 1
  const HybridReport report = integrateHybrid(problem, {0.0}, {0.0, 1.0, 3.0}, times, kOptions);
  ASSERT_EQ(report.failure, "");
  EXPECT_EQ(report.sequence.size(), 3U);
  Sawtooth again(-2.0, 31);
  ASSERT_EQ(integrateHybrid(again, {0.0}, {0.0, 1.0, 3.0}, times, kOptions, &report.sequence).failure, "");
  for (std::size_t i = 0; i < again.values_.size(); ++i) {
    EXPECT_NEAR(again.values_[i], problem.values_[i], 1e-14);
  }
  Sawtooth other(0.5, 31);  // with state events
  EXPECT_NE(integrateHybrid(other, {0.0}, {0.0, 1.0, 3.0}, times, kOptions, &report.sequence).failure, "");
}

TEST(HybridIntegration, EventsWithoutEndAreAFailure) {
  struct Endless : Sawtooth {
    Endless() : Sawtooth(0.0, 1) {}
    double getNextEventTime() const override { return 0.5; }
  };
  Endless problem;
  const HybridReport report = integrateHybrid(problem, {0.0}, {0.0, 1.0}, Eigen::VectorXd::Ones(1), kOptions);
  EXPECT_NE(report.failure.find("without end"), std::string::npos) << report.failure;
}

/// Prothero and Robinson: x' = -stiffness (x - cos t) - sin t, whose solution from 1 is cos t.
class Stiff : public HybridProblem {
 public:
  explicit Stiff(int outputs) : values_(outputs) {}

  std::size_t getIndicatorCount() const override { return 1; }
  void calcIndicators(double t, const State& x, double* indicators) override {
    indicators[0] = x[0] - 0.5 * (t < 2.0 ? 1.0 : -9.0);
  }
  bool completeStep(double, const State&) override { return false; }
  void handleEvent(double t, State&) override { events_.push_back(t); }
  void enterPhase(double, State&) override {}
  double getNextEventTime() const override { return std::numeric_limits<double>::infinity(); }
  bool isOver() const override { return false; }
  void calcDerivative(double t, const State& x, State& dxdt) override {
    dxdt[0] = -1e6 * (x[0] - std::cos(t)) - std::sin(t);
  }
  void recordOutput(int index, double, const State& x) override { values_[index] = x[0]; }

  std::vector<double> values_, events_;
};

TEST(HybridIntegration, IntegratesAStiffProblemImplicitly) {
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(16, 0.0, 1.5);
  const IntegrationOptions options{1e-7, 1e-9, 10000, 60.0};
  Stiff limited(16);
  const HybridReport failed = integrateHybrid(limited, {1.0}, {0.0, 1.5}, times, options);
  EXPECT_TRUE(failed.reached_step_limit);
  Stiff problem(16);
  const HybridReport report =
      integrateHybrid(problem, {1.0}, {0.0, 0.7, 1.5}, times, options, nullptr, HybridMethod::kImplicit);
  ASSERT_EQ(report.failure, "");
  EXPECT_LT(report.steps, 300);
  for (int i = 0; i < 16; ++i) {
    EXPECT_NEAR(problem.values_[i], std::cos(times[i]), 1e-6) << times[i];
  }
  ASSERT_EQ(problem.events_.size(), 1U);
  EXPECT_NEAR(problem.events_[0], std::acos(0.5), 1e-6);
}

TEST(HybridIntegration, ReplaysImplicitSteps) {
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(11, 0.0, 1.0);
  const IntegrationOptions options{1e-7, 1e-9, 10000, 60.0};
  Stiff first(11), second(11);
  const HybridReport report =
      integrateHybrid(first, {1.0}, {0.0, 1.0}, times, options, nullptr, HybridMethod::kImplicit);
  ASSERT_EQ(report.failure, "");
  const HybridReport again =
      integrateHybrid(second, {1.0}, {0.0, 1.0}, times, options, &report.sequence, HybridMethod::kImplicit);
  ASSERT_EQ(again.failure, "");
  for (int i = 0; i < 11; ++i) {
    EXPECT_NEAR(first.values_[i], second.values_[i], 1e-12);
  }
}

}  // namespace
}  // namespace twinmap
