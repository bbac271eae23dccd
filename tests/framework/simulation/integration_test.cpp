#include "framework/simulation/integration/integration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace twinmap {
namespace {

using State = OdeProblem::State;

/// Records everything; the right-hand side is given per phase.
class RecordedProblem : public OdeProblem {
 public:
  using Rhs = std::function<void(double phase, double t, const State& x, State& dxdt)>;
  explicit RecordedProblem(Rhs rhs) : rhs_(std::move(rhs)) {}

  void beginPhase(double begin) override { phases.push_back(begin); }
  void calcDerivative(double t, const State& x, State& dxdt) override {
    largest_time = std::max(largest_time, t);
    rhs_(phases.back(), t, x, dxdt);
  }
  void recordOutput(int index, double t, const State& x) override {
    indices.push_back(index);
    times.push_back(t);
    values.push_back(x[0]);
    output_phases.push_back(phases.back());
  }

  std::vector<double> phases, times, values, output_phases;
  std::vector<int> indices;
  double largest_time = 0.0;

 private:
  Rhs rhs_;
};

RecordedProblem makeOscillator() {
  return RecordedProblem([](double, double, const State& x, State& dxdt) {
    dxdt[0] = x[1];
    dxdt[1] = -x[0];
  });
}

IntegrationOptions makeOptions(double tolerance) {
  IntegrationOptions options;
  options.relative_tolerance = options.absolute_tolerance = tolerance;
  return options;
}

double calcOscillatorError(double tolerance, int& steps) {
  RecordedProblem problem = makeOscillator();
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(777, 0.0, 20.0);
  const IntegrationReport report =
      integrateDopri5(problem, {0.0, 1.0}, {0.0, 20.0}, times, makeOptions(tolerance));
  EXPECT_EQ(report.failure, "");
  steps = report.steps;
  double error = 0.0;
  for (Eigen::Index i = 0; i < times.size(); ++i) {
    error = std::max(error, std::abs(problem.values[i] - std::sin(times[i])));
  }
  return error;
}

TEST(IntegrateDopri5, DenseOutputFollowsAnOscillator) {
  int steps = 0;
  EXPECT_LT(calcOscillatorError(1e-8, steps), 2e-7);
  EXPECT_LT(steps, 400);
}

TEST(IntegrateDopri5, ErrorFallsWithTheFifthPowerOfTheStep) {
  int coarse_steps = 0, fine_steps = 0;
  const double coarse = calcOscillatorError(1e-6, coarse_steps);
  const double fine = calcOscillatorError(1e-10, fine_steps);
  const double order = std::log(coarse / fine) / std::log(static_cast<double>(fine_steps) / coarse_steps);
  EXPECT_GT(order, 4.5);
  EXPECT_LT(order, 6.5);
}

TEST(IntegrateDopri5, LandsOnEventsExactly) {
  // x' = 0, then 1 from t = 0.1, then -2 from t = 0.4: exact for any Runge-Kutta method that restarts there
  RecordedProblem problem([](double phase, double, const State&, State& dxdt) {
    dxdt[0] = phase == 0.0 ? 0.0 : phase == 0.1 ? 1.0 : -2.0;
  });
  Eigen::VectorXd times(6);
  times << 0.0, 0.05, 0.1, 0.25, 0.4, 1.0;
  const IntegrationReport report =
      integrateDopri5(problem, {3.0}, {0.0, 0.1, 0.4, 1.0}, times, makeOptions(1e-9));
  EXPECT_EQ(report.failure, "");
  EXPECT_EQ(problem.phases, (std::vector<double>{0.0, 0.1, 0.4}));
  EXPECT_EQ(problem.indices, (std::vector<int>{0, 1, 2, 3, 4, 5}));
  const double expected[] = {3.0, 3.0, 3.0, 3.15, 3.3, 2.1};
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(problem.values[i], expected[i], 1e-14) << times[i];
  }
}

TEST(IntegrateDopri5, OutputAtAnEventBelongsToThePhaseThatBeginsThere) {
  RecordedProblem problem = makeOscillator();
  Eigen::VectorXd times(3);
  times << 0.0, 1.0, 2.0;
  integrateDopri5(problem, {0.0, 1.0}, {0.0, 1.0, 2.0}, times, makeOptions(1e-6));
  EXPECT_EQ(problem.output_phases, (std::vector<double>{0.0, 1.0, 1.0}));
}

TEST(IntegrateDopri5, NeverLooksBeyondTheEnd) {
  RecordedProblem problem = makeOscillator();
  integrateDopri5(problem, {0.0, 1.0}, {0.0, 0.3, 2.0}, Eigen::VectorXd(), makeOptions(1e-6));
  EXPECT_LE(problem.largest_time, 2.0 * (1.0 + 1e-15));
}

TEST(IntegrateDopri5, SurvivesEventsThatDifferByRounding) {
  RecordedProblem problem = makeOscillator();
  Eigen::VectorXd times(1);
  times << 1.0;
  const double twin = std::nextafter(0.3, 1.0);
  const IntegrationReport report =
      integrateDopri5(problem, {0.0, 1.0}, {0.0, 0.3, twin, 1.0}, times, makeOptions(1e-9));
  EXPECT_EQ(report.failure, "");
  EXPECT_NEAR(problem.values[0], std::sin(1.0), 1e-8);
}

TEST(IntegrateDopri5, StepLimitIsAReason) {
  RecordedProblem problem = makeOscillator();
  IntegrationOptions options = makeOptions(1e-10);
  options.max_steps = 10;
  const IntegrationReport report =
      integrateDopri5(problem, {0.0, 1.0}, {0.0, 100.0}, Eigen::VectorXd(), options);
  EXPECT_EQ(report.failure.rfind("step limit of 10 reached at t = ", 0), 0u) << report.failure;
  EXPECT_EQ(report.steps, 10);
}

TEST(IntegrateDopri5, WallTimeLimitIsAReason) {
  RecordedProblem problem = makeOscillator();
  IntegrationOptions options = makeOptions(1e-10);
  options.max_wall_time = 1e-9;
  try {
    integrateDopri5(problem, {0.0, 1.0}, {0.0, 100.0}, Eigen::VectorXd(), options);
    FAIL();
  } catch (const WallTimeReached& reached) {
    EXPECT_STREQ(reached.what(), "wall-time limit of 1e-09 s reached at t = 0 s");
  }
}

TEST(IntegrateDopri5, BlowUpIsAReasonWithItsTime) {
  // x' = x^2 from 1 goes to infinity at t = 1
  RecordedProblem problem([](double, double, const State& x, State& dxdt) { dxdt[0] = x[0] * x[0]; });
  const IntegrationReport report =
      integrateDopri5(problem, {1.0}, {0.0, 2.0}, Eigen::VectorXd(), makeOptions(1e-6));
  EXPECT_NE(report.failure.find("at t = 1 s"), std::string::npos) << report.failure;
}

TEST(IntegrateDopri5, NonFiniteDerivativeIsAReasonAndNotAnAcceptedStep) {
  RecordedProblem problem([](double, double t, const State&, State& dxdt) {
    dxdt[0] = t > 0.5 ? std::numeric_limits<double>::quiet_NaN() : 1.0;
  });
  const IntegrationReport report =
      integrateDopri5(problem, {0.0}, {0.0, 1.0}, Eigen::VectorXd(), makeOptions(1e-6));
  EXPECT_EQ(report.failure, "state became non-finite at t = 0.5 s");
}

TEST(IntegrateDopri5, NonFiniteStartIsAReason) {
  RecordedProblem problem = makeOscillator();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const IntegrationReport report =
      integrateDopri5(problem, {nan, 1.0}, {0.0, 1.0}, Eigen::VectorXd(), makeOptions(1e-6));
  EXPECT_EQ(report.failure, "state became non-finite at t = 0 s");
}

TEST(IntegrateDopri5, StepsBackFromADomainErrorInsideATrialStep) {
  // x' = -50 x^1.5 with the solution 1 / (1 + 25 t)^2 > 0; a trial stage below 0 gives NaN
  RecordedProblem problem(
      [](double, double, const State& x, State& dxdt) { dxdt[0] = -50.0 * std::sqrt(x[0]) * x[0]; });
  Eigen::VectorXd times(1);
  times << 1.0;
  const IntegrationReport report = integrateDopri5(problem, {1.0}, {0.0, 1.0}, times, makeOptions(1e-2));
  EXPECT_EQ(report.failure, "");
  EXPECT_NEAR(problem.values[0], 1.0 / (26.0 * 26.0), 1e-2);
}

TEST(IntegrateDopri5, AnEmptyStateIsIntegratedToo) {
  RecordedProblem problem([](double, double, const State&, State&) {});
  const IntegrationReport report =
      integrateDopri5(problem, {}, {0.0, 1.0}, Eigen::VectorXd(), makeOptions(1e-6));
  EXPECT_EQ(report.failure, "");
}

}  // namespace
}  // namespace twinmap
