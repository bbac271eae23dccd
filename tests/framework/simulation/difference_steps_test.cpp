#include "framework/simulation/difference_steps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "framework/simulation/stencil.hpp"

namespace twinmap::testing {
namespace {

ParameterSpec makeParameter(const std::string& name, double lower, double upper) {
  return {{name, {}}, {lower, upper, {}}, "", "", RelativeTo::kRange, {}};
}

const std::vector<ParameterSpec>& getParameters() {
  static const std::vector<ParameterSpec> kParameters{makeParameter("a", 1.0, 3.0),
                                                      makeParameter("b", 0.0, 1.0)};
  return kParameters;
}

ResponseLayout makeLayout() {
  return {{"y"}, {""}, Eigen::VectorXd::LinSpaced(50, 0.1, 5.0), 0};
}

/// sin(a t) + b t, and errors of about `noise` that jump from point to point.
double calcOutput(const Eigen::VectorXd& point, double t, double noise) {
  const double hash = std::sin(1e9 * (point[0] + 0.37 * point[1]) + 12.9898 * t) * 43758.5453;
  return std::sin(point[0] * t) + point[1] * t + noise * std::sqrt(12.0) * (hash - std::floor(hash) - 0.5);
}

SimulateNeighbours makeModel(double noise) {
  return [noise](const Eigen::MatrixXd& points, Eigen::MatrixXd& responses,
                 std::vector<SampleStatus>& statuses) {
    const ResponseLayout layout = makeLayout();
    for (Eigen::Index j = 0; j < points.cols(); ++j) {
      statuses[j] = {};
      for (Eigen::Index i = 0; i < layout.times.size(); ++i) {
        responses(i, j) = calcOutput(points.col(j), layout.times[i], noise);
      }
    }
  };
}

TEST(DifferenceSteps, StaySmallWhereResponsesAreSmooth) {
  const DifferenceSteps steps = measureDifferenceSteps(getParameters(), makeLayout(), makeModel(0.0));
  EXPECT_LT(steps.noise, 1e-14);
  EXPECT_EQ(steps.steps[0], kSharedStepsDifference);
}

TEST(DifferenceSteps, FollowTheNoiseAndTheThirdDerivative) {
  constexpr double kNoise = 1e-6;
  const DifferenceSteps steps = measureDifferenceSteps(getParameters(), makeLayout(), makeModel(kNoise));
  const double scale = 1.6;  // root mean square of sin(2 t) + t / 2 there
  EXPECT_NEAR(steps.noise, kNoise / scale, 0.3 * kNoise / scale);
  // third derivative per width^3 = (2 t)^3 cos(2 t): root mean square 270
  EXPECT_NEAR(steps.steps[0], std::cbrt(3.0 * kNoise / 270.0), 0.5 * std::cbrt(3.0 * kNoise / 270.0));
  EXPECT_GT(steps.steps[1], 0.01);  // linear: as wide as may be
}

TEST(DifferenceSteps, PutNeighboursOnTheTangent) {
  constexpr double kNoise = 1e-6;
  const DifferenceSteps steps = measureDifferenceSteps(getParameters(), makeLayout(), makeModel(kNoise));
  const Eigen::Vector2d point(2.2, 1.0);  // b at its upper bound: differences to one side
  const Eigen::MatrixXd points = makeNeighbours(getParameters(), point);
  Eigen::MatrixXd responses(50, points.cols());
  std::vector<SampleStatus> statuses(points.cols());
  simulateOnTangent(getParameters(), steps, makeModel(kNoise), points, responses, statuses.data());
  const Eigen::MatrixXd slopes = calcDifferences(responses, getParameters(), point);
  const ResponseLayout layout = makeLayout();
  for (Eigen::Index i = 0; i < 50; ++i) {
    const double t = layout.times[i];
    EXPECT_NEAR(slopes(i, 0), 2.0 * t * std::cos(2.2 * t), 5e-3);  // plain differences err by 2e-2
    EXPECT_NEAR(slopes(i, 1), t, 1e-3);
  }
}

TEST(DifferenceSteps, FailWithTheSimulationThatTheyNeed) {
  const auto fails = [](const Eigen::MatrixXd& points, Eigen::MatrixXd& responses,
                        std::vector<SampleStatus>& statuses) {
    responses.setZero();
    for (Eigen::Index j = 0; j < points.cols(); ++j) {
      statuses[j] = {points(1, j) <= 0.5, "too large"};
      if (!statuses[j].ok) {
        responses.col(j).setConstant(std::numeric_limits<double>::quiet_NaN());
      }
    }
  };
  const DifferenceSteps steps{1e-6, Eigen::Vector2d(1e-2, 1e-2)};
  const Eigen::MatrixXd points = makeNeighbours(getParameters(), Eigen::Vector2d(2.0, 0.5));
  Eigen::MatrixXd responses(50, points.cols());
  std::vector<SampleStatus> statuses(points.cols());
  simulateOnTangent(getParameters(), steps, fails, points, responses, statuses.data());
  EXPECT_TRUE(statuses[0].ok && statuses[1].ok && statuses[2].ok);
  EXPECT_TRUE(responses.leftCols(3).allFinite());
  EXPECT_EQ(statuses[3].reason, "too large");
  EXPECT_EQ(statuses[4].reason, "too large");
}

}  // namespace
}  // namespace twinmap::testing
