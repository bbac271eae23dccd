#include "framework/simulation/excitation/excitation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/simulation/excitation/excitation_terms.hpp"

namespace twinmap {
namespace {

constexpr double kPi = 3.141592653589793;

Expression ex(const std::string& text) {
  return {text, {}};
}

SignalSpec makeSignal(const std::string& name) {
  SignalSpec spec;
  spec.name = {name, {}};
  spec.unit = "N";
  return spec;
}

/// With a parameter "p".
ModelSpec makeNamedModel() {
  ModelSpec model;
  model.parameters.emplace_back();
  model.parameters.front().name.text = "p";
  return model;
}

/// An excitation of one signal with the values of a parameter "p" = 2.
class OneSignal {
 public:
  explicit OneSignal(SignalSpec spec) : signals_{std::move(spec)}, excitation_(signals_) {
    setParameter(2.0);
  }

  Excitation& get() { return excitation_; }
  void setParameter(double p) {
    numbers_.update(Eigen::VectorXd::Constant(1, p));
    excitation_.update(numbers_);
  }

  /// The value at t, by entering all phases up to the one that holds t.
  double calcAt(double t) {
    excitation_.mute();
    excitation_.beginPhase(0.0);
    for (const double event : excitation_.calcEventTimes(t * (1.0 + 1e-15) + 1e-300)) {
      excitation_.beginPhase(event);
    }
    return calcInPhase(t);
  }

  double calcInPhase(double t) {
    std::vector<double> values(1);
    excitation_.calcValues(t, values);
    return values[0];
  }

 private:
  std::vector<SignalSpec> signals_;
  Excitation excitation_;
  ModelSpec model_ = makeNamedModel();
  ModelNumbers numbers_{model_};
};

SignalSpec makePulse() {
  SignalSpec spec = makeSignal("F");
  spec.pulses = {{ex("5 * p"), ex("0.2"), ex("0.25")}};
  return spec;
}

TEST(Excitation, PulseActsFromItsStartAndNoLongerAtItsEnd) {
  OneSignal signal(makePulse());
  EXPECT_EQ(signal.get().calcEventTimes(5.0), (std::vector<double>{0.2, 0.25}));
  EXPECT_EQ(signal.calcAt(0.1), 0.0);
  EXPECT_EQ(signal.calcAt(0.2), 10.0);
  EXPECT_EQ(signal.calcAt(0.24), 10.0);
  EXPECT_EQ(signal.calcAt(0.25), 0.0);
}

TEST(Excitation, PhaseDecidesAndNotTheTime) {
  OneSignal signal(makePulse());
  signal.get().beginPhase(0.0);
  EXPECT_EQ(signal.calcInPhase(0.22), 0.0);
  signal.get().beginPhase(0.2);
  EXPECT_EQ(signal.calcInPhase(0.3), 10.0);
}

TEST(Excitation, IsMutedUntilAPhaseBegins) {
  OneSignal signal(makePulse());
  EXPECT_EQ(signal.calcInPhase(0.22), 0.0);
}

TEST(Excitation, NumbersFollowTheParameters) {
  OneSignal signal(makePulse());
  signal.setParameter(3.0);
  EXPECT_EQ(signal.calcAt(0.2), 15.0);
}

TEST(Excitation, EventsOutsideTheDurationAreNone) {
  SignalSpec spec = makeSignal("F");
  spec.pulses = {{ex("1"), ex("-1"), ex("0.5")}, {ex("1"), ex("0.5"), ex("7")}, {ex("1"), ex("0"), ex("5")}};
  OneSignal signal(spec);
  EXPECT_EQ(signal.get().calcEventTimes(5.0), std::vector<double>{0.5});
  EXPECT_EQ(signal.calcAt(0.1), 2.0);
  EXPECT_EQ(signal.calcAt(0.6), 2.0);
}

TEST(Excitation, SineStartsItsClockAtItsStart) {
  SignalSpec spec = makeSignal("F");
  spec.sines = {{ex("3"), ex("2"), ex("pi / 6"), ex("0.5"), ex("")}};
  OneSignal signal(spec);
  EXPECT_EQ(signal.get().calcEventTimes(5.0), std::vector<double>{0.5});
  EXPECT_EQ(signal.calcAt(0.4), 0.0);
  EXPECT_NEAR(signal.calcAt(0.5), 1.5, 1e-15);               // 3 sin(30 deg)
  EXPECT_NEAR(signal.calcAt(0.5 + 1.0 / 12.0), 3.0, 1e-12);  // 60 deg later
}

TEST(Excitation, LinearChirpSweepsItsFrequency) {
  SignalSpec spec = makeSignal("F");
  spec.chirps = {{ex("1"), ex("1"), ex("3"), ex("0"), ex("4"), SweepKind::kLinear}};
  OneSignal signal(spec);
  // cycles(t) = t + t^2 / 4
  EXPECT_NEAR(signal.calcAt(1.0), std::sin(2.0 * kPi * 1.25), 1e-12);
  EXPECT_NEAR(signal.calcAt(3.0), std::sin(2.0 * kPi * 5.25), 1e-12);
  EXPECT_EQ(signal.calcAt(4.5), 0.0);
}

TEST(Excitation, LogarithmicChirpSweepsItsFrequency) {
  SignalSpec spec = makeSignal("F");
  spec.chirps = {{ex("2"), ex("1"), ex("8"), ex("0"), ex("3"), SweepKind::kLogarithmic}};
  OneSignal signal(spec);
  // frequency 2^t, cycles (2^t - 1) / ln 2
  EXPECT_NEAR(signal.calcAt(1.0), 2.0 * std::sin(2.0 * kPi / std::log(2.0)), 1e-12);
  EXPECT_NEAR(signal.calcAt(2.5), 2.0 * std::sin(2.0 * kPi * (std::exp2(2.5) - 1.0) / std::log(2.0)), 1e-12);
}

TEST(Excitation, LogarithmicChirpOfOneFrequencyIsASine) {
  SignalSpec spec = makeSignal("F");
  spec.chirps = {{ex("1"), ex("2"), ex("2"), ex("0"), ex("3"), SweepKind::kLogarithmic}};
  EXPECT_NEAR(OneSignal(spec).calcAt(0.125), 1.0, 1e-12);
}

TEST(Excitation, MultisineUsesSchroederPhasesUnlessToldOtherwise) {
  SignalSpec spec = makeSignal("F");
  MultisineSpec multisine;
  multisine.amplitude = ex("2");
  multisine.frequencies = {ex("1"), ex("2")};
  multisine.start = ex("0");
  multisine.end = ex("");
  spec.multisines = {multisine};
  // phases 0 and -pi: sin(2 pi t) - sin(4 pi t)
  EXPECT_NEAR(OneSignal(spec).calcAt(0.125), 2.0 * (std::sqrt(0.5) - 1.0), 1e-12);
  spec.multisines[0].phases = {ex("0"), ex("0")};
  EXPECT_NEAR(OneSignal(spec).calcAt(0.125), 2.0 * (std::sqrt(0.5) + 1.0), 1e-12);
}

TEST(Excitation, SchroederPhasesLowerTheCrestFactor) {
  const int count = 20;
  const std::vector<double> phases = calcSchroederPhases(count);
  double aligned = 0.0, spread = 0.0;
  for (int i = 0; i < 2000; ++i) {
    double with = 0.0, without = 0.0;
    for (int k = 1; k <= count; ++k) {
      with += std::cos(2.0 * kPi * k * i / 2000.0 + phases[k - 1]);
      without += std::cos(2.0 * kPi * k * i / 2000.0);
    }
    spread = std::max(spread, std::abs(with));
    aligned = std::max(aligned, std::abs(without));
  }
  EXPECT_NEAR(aligned, count, 1e-12);
  EXPECT_LT(spread, 0.4 * aligned);
}

TableSpec makeTable(std::vector<double> times, std::vector<double> values, TableInterpolation interpolation) {
  TableSpec table;
  table.times = std::move(times);
  table.values = std::move(values);
  table.interpolation = interpolation;
  return table;
}

TEST(Excitation, LinearTableInterpolatesAndIsZeroOutside) {
  SignalSpec spec = makeSignal("F");
  spec.tables = {makeTable({0.5, 1.0, 3.0}, {2.0, 4.0, -2.0}, TableInterpolation::kLinear)};
  OneSignal signal(spec);
  EXPECT_EQ(signal.get().calcEventTimes(5.0), (std::vector<double>{0.5, 1.0, 3.0}));
  EXPECT_EQ(signal.calcAt(0.4), 0.0);
  EXPECT_EQ(signal.calcAt(0.5), 2.0);
  EXPECT_NEAR(signal.calcAt(0.75), 3.0, 1e-15);
  EXPECT_NEAR(signal.calcAt(2.0), 1.0, 1e-15);
  EXPECT_EQ(signal.calcAt(3.0), 0.0);
}

TEST(Excitation, HoldTableKeepsEachValueUntilTheNextTime) {
  SignalSpec spec = makeSignal("F");
  spec.tables = {makeTable({0.5, 1.0, 3.0}, {2.0, 4.0, -2.0}, TableInterpolation::kHold)};
  OneSignal signal(spec);
  EXPECT_EQ(signal.calcAt(0.9), 2.0);
  EXPECT_EQ(signal.calcAt(1.0), 4.0);
  EXPECT_EQ(signal.calcAt(2.9), 4.0);
  EXPECT_EQ(signal.calcAt(3.0), 0.0);
}

TEST(Excitation, CubicTableIsOnePhase) {
  SignalSpec spec = makeSignal("F");
  spec.tables = {makeTable({0.5, 1.0, 3.0, 3.5}, {2.0, 4.0, -2.0, 0.0}, TableInterpolation::kCubic)};
  const CubicSpline spline(spec.tables[0].times, spec.tables[0].values);
  OneSignal signal(spec);
  EXPECT_EQ(signal.get().calcEventTimes(5.0), (std::vector<double>{0.5, 3.5}));
  EXPECT_EQ(signal.calcAt(0.4), 0.0);
  EXPECT_EQ(signal.calcAt(0.5), 2.0);
  EXPECT_EQ(signal.calcAt(2.0), spline.calc(1.5));
  EXPECT_EQ(signal.calcAt(3.5), 0.0);
  signal.setParameter(3.0);
  EXPECT_EQ(signal.calcAt(1.0), 4.0);
}

TEST(Excitation, SignalsAreSumsOfTheirTermsAndIndependent) {
  std::vector<SignalSpec> signals{makePulse(), makeSignal("M")};
  signals[0].pulses.push_back({ex("1"), ex("0"), ex("1")});
  signals[1].pulses.push_back({ex("7"), ex("0.2"), ex("1")});
  const ModelSpec model = makeNamedModel();
  ModelNumbers numbers(model);
  numbers.update(Eigen::VectorXd::Ones(1));
  Excitation excitation(signals);
  excitation.update(numbers);
  excitation.beginPhase(0.0);
  excitation.beginPhase(0.2);
  std::vector<double> values(2);
  excitation.calcValues(0.21, values);
  EXPECT_EQ(values, (std::vector<double>{6.0, 7.0}));
}

std::string getFailure(SignalSpec spec) {
  try {
    OneSignal signal(std::move(spec));
  } catch (const SimulationFailure& failure) {
    return failure.what();
  }
  return "";
}

TEST(Excitation, UnusableNumbersNameTheirSignal) {
  SignalSpec backwards = makeSignal("F");
  backwards.pulses = {{ex("1"), ex("0.3"), ex("0.3")}};
  EXPECT_EQ(getFailure(backwards), "excitation 'F': end = 0.3 s must be after its start");
  SignalSpec infinite = makeSignal("F");
  infinite.pulses = {{ex("1 / (p - 2)"), ex("0"), ex("1")}};
  EXPECT_EQ(getFailure(infinite), "excitation 'F': amplitude = inf N must be finite");
  SignalSpec still = makeSignal("F");
  still.sines = {{ex("1"), ex("0"), ex("0"), ex("0"), ex("")}};
  EXPECT_EQ(getFailure(still), "excitation 'F': frequency = 0 Hz must be positive");
}

TEST(Excitation, BadTablesAndPhasesAreWrongInput) {
  std::vector<SignalSpec> signals{makeSignal("F")};
  signals[0].tables = {{{0.0, 2.0, 1.0}, {1.0, 1.0, 1.0}, TableInterpolation::kLinear}};
  EXPECT_THROW(Excitation{signals}, ExperimentError);
  signals[0].tables = {{{0.0, 1.0, 1.0}, {1.0, 1.0, 1.0}, TableInterpolation::kCubic}};
  EXPECT_THROW(Excitation{signals}, ExperimentError);
  signals[0].tables = {{{0.0, 2.0}, {1.0}, TableInterpolation::kLinear}};
  EXPECT_THROW(Excitation{signals}, ExperimentError);
  signals[0].tables.clear();
  signals[0].multisines = {{ex("1"), {}, {ex("1"), ex("2")}, {ex("0")}, ex("0"), ex("")}};
  EXPECT_THROW(Excitation{signals}, ExperimentError);
}

}  // namespace
}  // namespace twinmap
