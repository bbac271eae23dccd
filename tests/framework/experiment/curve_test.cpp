// Curves by their knots: against scipy's piecewise cubics, and what they promise of shape.
#include "framework/experiment/model/curve.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "tests/framework/experiment/experiments.hpp"

namespace twinmap {
namespace {

constexpr double kValues[] = {0.0, 0.4, 0.5, 1.3, 1.35, 2.0};

class CurveTest : public testing::Test {
 protected:
  /// Through `values` over [0, 5].
  void define(const std::vector<double>& values, bool monotone) {
    CurveSpec spec;
    spec.name = {"motor", {}};
    spec.range = {0.0, 5.0, {}};
    spec.monotone = monotone;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::string knot = "v" + std::to_string(i);
      names_.define(knot, values[i]);
      spec.values.push_back({knot, {}});
    }
    x_ = names_.define("x");
    defineCurves({spec}, names_);
    call_ = names_.bind({"motor(x)", {}});
  }
  void define(bool monotone) { define({std::begin(kValues), std::end(kValues)}, monotone); }

  double calc(double x) {
    names_.upd(x_) = x;
    return names_.calc(call_);
  }
  double calcSlope(double x) { return (calc(x + 1e-6) - calc(x - 1e-6)) / 2e-6; }

  NamedValues<double> names_;
  int x_ = -1;
  BoundExpression call_;
};

TEST_F(CurveTest, PassesThroughItsKnots) {
  for (const bool monotone : {false, true}) {
    names_ = {};
    define(monotone);
    for (int i = 0; i < 6; ++i) {
      EXPECT_NEAR(calc(i), kValues[i], 1e-14);
    }
  }
}

TEST_F(CurveTest, IsScipysPchipBetweenInnerKnots) {
  // x = arange(6.); scipy.interpolate.PchipInterpolator(x, v)([1.3, 2.5, 3.7])
  define(true);
  EXPECT_NEAR(calc(1.3), 0.43392000000000003, 1e-14);
  EXPECT_NEAR(calc(2.5), 0.9104575163398694, 1e-14);
  EXPECT_NEAR(calc(3.7), 1.331479411764706, 1e-14);
}

TEST_F(CurveTest, IsScipysSplineOfItsEndSlopes) {
  // numpy.linalg.solve of the slopes' equations, then scipy.interpolate.CubicHermiteSpline at
  // 0.3, 1.3, 2.5, 4.9
  define(false);
  EXPECT_NEAR(calc(0.3), 0.19303125000000002, 1e-14);
  EXPECT_NEAR(calc(1.3), 0.39505, 1e-14);
  EXPECT_NEAR(calc(2.5), 0.90859375, 1e-14);
  EXPECT_NEAR(calc(4.9), 1.8862633928571433, 1e-14);
}

TEST_F(CurveTest, OfAParabolaIsTheParabola) {
  define({1.0, 0.5, 1.0, 2.5, 5.0, 8.5}, false);  // 1 - x + x^2 / 2
  for (const double x : {0.2, 1.7, 3.3, 4.9}) {
    EXPECT_NEAR(calc(x), 1.0 - x + 0.5 * x * x, 1e-13);
  }
}

TEST_F(CurveTest, GoesOnAsAStraightLine) {
  for (const bool monotone : {false, true}) {
    names_ = {};
    define(monotone);
    EXPECT_NEAR(calc(7.0), 2.0 + 2.0 * calcSlope(5.0 + 1e-3), 1e-8);
    EXPECT_NEAR(calcSlope(5.0 - 1e-5), calcSlope(5.0 + 1e-5), 1e-4);
    EXPECT_NEAR(calc(-3.0), 3.0 * (calc(-1e-3) / 1e-3), 1e-8);
  }
}

TEST_F(CurveTest, IsMonotoneWhereItsValuesAre) {
  define({0.0, 0.0, 0.01, 1.0, 1.0, 3.0}, true);
  for (double x = -1.0; x < 6.0; x += 0.01) {
    EXPECT_GE(calc(x + 0.01), calc(x) - 1e-15) << x;
  }
  names_ = {};
  define({0.0, 1.0, 0.5, 0.6, 0.4, 0.4}, true);  // nowhere beyond its neighbours
  for (double x = 1.0; x < 2.0; x += 0.01) {
    EXPECT_LE(calc(x), 1.0 + 1e-15);
    EXPECT_GE(calc(x), 0.5 - 1e-15);
  }
}

TEST_F(CurveTest, MayHaveTwoOrThreeKnots) {
  define({1.0, 3.0}, false);
  EXPECT_NEAR(calc(2.5), 2.0, 1e-15);
  names_ = {};
  define({1.0, 0.0, 1.0}, false);
  EXPECT_NEAR(calc(1.25), 0.25, 1e-14);
}

std::string getCurveError(const std::string& curve, const std::string& force) {
  try {
    loadExperiment(kCart, {"system.curves={motor: " + curve + "}",
                           "system.force_laws=[{coordinate: x, force: \"" + force + "\"}]"});
  } catch (const ExperimentError& error) {
    return error.what();
  }
  return "";
}

TEST(Curves, MakeAParameterOfEachKnot) {
  const ExperimentSpec experiment = loadExperiment(
      kCart, {"system.curves={motor: {over: x, range: [-1, 1], knots: 4, bounds: [1, 2], unit: N}}",
              "system.force_laws=[{coordinate: x, force: motor(x)}]"});
  const std::vector<ParameterSpec>& parameters = experiment.model.parameters;
  EXPECT_EQ(parameters.back().name.text, "motor_4");
  EXPECT_EQ(parameters.back().unit, "N");
  EXPECT_EQ(parameters.back().bounds.upper, 2.0);
  const ExperimentSpec again =
      readExperiment(parseExperimentTree(writeExperiment(experiment), "resolved.yaml"));
  EXPECT_EQ(writeExperiment(again), writeExperiment(experiment));
}

TEST(Curves, AreCheckedWithTheirUnits) {
  const std::string curve = "{over: x, range: [-1, 1], knots: 4, bounds: [1, 2], unit: N}";
  EXPECT_EQ(getCurveError(curve, "2 * motor(x)"), "");
  const auto expect = [&](const std::string& of, const std::string& force, const std::string& part) {
    EXPECT_NE(getCurveError(of, force).find(part), std::string::npos) << getCurveError(of, force);
  };
  expect(curve, "motor(x_dot)", "not in the unit of what it is a curve of");
  expect("{over: x, range: [-1, 1], knots: 4, bounds: [1, 2], unit: N m}", "motor(x)",
         "does not come out in N");
  expect(curve, "moter(x)", "there is no function 'moter' at character 1; did you mean 'motor'?");
  expect(curve, "motor", "uses the unknown name 'motor'");
  expect("{over: y, range: [-1, 1], knots: 4, bounds: [1, 2]}", "motor(x)",
         "is not a coordinate, a speed, a state or a signal");
  expect("{over: x, range: [-1, 1], knots: 4}", "motor(x)", "must give 'bounds' with 'knots'");
  expect("{over: x, range: [-1, 1]}", "motor(x)", "must give either 'values' or 'knots'");
  expect("{over: x, range: [1, -1], values: [1, 2]}", "motor(x)", "with lower below upper");
  expect("{over: x, range: [-1, 1], values: [1, nothing]}", "motor(x)", "unknown name 'nothing'");
}

}  // namespace
}  // namespace twinmap
