#include "framework/models/fmu/run/communication_points.hpp"

#include <gtest/gtest.h>

#include "framework/models/fmu/instance/failure.hpp"

namespace twinmap::fmi {
namespace {

double calcLongest(const CommunicationGrid& grid) {
  double longest = 0.0;
  for (std::size_t i = 1; i < grid.points.size(); ++i) {
    longest = std::max(longest, grid.points[i] - grid.points[i - 1]);
  }
  return longest;
}

bool meets(const CommunicationGrid& grid, double time) {
  return std::any_of(grid.points.begin(), grid.points.end(),
                     [time](double point) { return std::abs(point - time) < 1e-12; });
}

TEST(CommunicationPoints, MeetEveryTargetWithStepsNoLongerThanAsked) {
  Capabilities can;
  can.variable_step = true;
  const std::vector<double> targets{0.05, 0.1, 0.217, 1.0};
  const CommunicationGrid grid = calcCommunicationGrid(targets, 0.03, can);
  EXPECT_LE(calcLongest(grid), 0.03 + 1e-12);
  for (const double target : targets) {
    EXPECT_TRUE(meets(grid, target)) << target;
  }
}

TEST(CommunicationPoints, AFixedStepDividesAllTargets) {
  const CommunicationGrid grid = calcCommunicationGrid({0.2, 0.25, 0.3}, 0.02, Capabilities{});
  EXPECT_NEAR(grid.step, 0.05 / 3.0, 1e-12);
  EXPECT_EQ(grid.points.size(), 19U);
  EXPECT_TRUE(meets(grid, 0.25));
}

TEST(CommunicationPoints, NoFixedStepDividesIrrationalTargets) {
  EXPECT_THROW(calcCommunicationGrid({0.1, 0.1414213562373095}, 0.02, Capabilities{}), FmuFailure);
}

TEST(CommunicationPoints, AreMultiplesOfTheInternalStepWhereTheTargetsAre) {
  Capabilities can;
  can.variable_step = true;
  can.internal_step = 0.01;
  const CommunicationGrid grid = calcCommunicationGrid({0.05, 0.12}, 0.03, can);
  for (const double point : grid.points) {
    EXPECT_NEAR(point / 0.01, std::round(point / 0.01), 1e-9);
  }
  EXPECT_LE(calcLongest(grid), 0.03 + 1e-12);
}

}  // namespace
}  // namespace twinmap::fmi
