#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/text/source_location.hpp"
#include "framework/models/fmu/package/package.hpp"
#include "tests/framework/models/fmu/fmu_case.hpp"

namespace twinmap::testing {
namespace {

using fmi::Kind;

/// Height at t of a ball that falls from rest at `height` under g and bounces with e; for times before it
/// rests.
double calcBall(double height, double g, double e, double t) {
  double fall = std::sqrt(2.0 * height / g), speed = g * fall;
  if (t <= fall) {
    return height - 0.5 * g * t * t;
  }
  t -= fall;
  for (speed *= e; t > 2.0 * speed / g; speed *= e) {
    t -= 2.0 * speed / g;
  }
  return speed * t - 0.5 * g * t * t;
}

class Ball : public ::testing::TestWithParam<const char*> {};

TEST_P(Ball, BouncesAsTheParabolasSay) {
  FmuCase fmu;
  fmu.name = GetParam();
  fmu.kind = Kind::kModelExchange;
  fmu.parameters = {{"e", 0.8}, {"h", 1.3}};  // h: a start value
  fmu.units = {{"h", "m"}};
  fmu.outputs = {"h"};
  fmu.times = Eigen::VectorXd::LinSpaced(61, 0.0, 3.0);
  fmu.duration = 3.0;
  const FmuResult result = simulate(fmu, 2);
  ASSERT_TRUE(result.status.ok) << result.status.reason;
  for (Eigen::Index i = 0; i < fmu.times.size(); ++i) {
    EXPECT_NEAR(result.outputs(i, 0), calcBall(1.3, 9.81, 0.8, fmu.times[i]), 1e-10) << fmu.times[i];
  }
}

TEST_P(Ball, BouncesInCoSimulationToItsOwnStep) {
  FmuCase fmu;
  fmu.name = GetParam();
  fmu.outputs = {"h"};
  fmu.units = {{"h", "m"}};
  fmu.times = Eigen::VectorXd::LinSpaced(16, 0.0, 1.5);
  fmu.duration = 1.5;
  const FmuResult result = simulate(fmu);
  ASSERT_TRUE(result.status.ok) << result.status.reason;
  for (Eigen::Index i = 0; i < fmu.times.size(); ++i) {
    EXPECT_NEAR(result.outputs(i, 0), calcBall(1.0, 9.81, 0.7, fmu.times[i]), 3e-3) << fmu.times[i];
  }
}

TEST_P(Ball, ComesToRestAfterInfinitelyManyBounces) {
  FmuCase fmu;
  fmu.name = GetParam();
  fmu.kind = Kind::kModelExchange;
  fmu.outputs = {"h"};
  fmu.units = {{"h", "m"}};
  fmu.times = Eigen::VectorXd::LinSpaced(2, 3.0, 10.0);
  fmu.duration = 10.0;
  const FmuResult result = simulate(fmu);
  ASSERT_TRUE(result.status.ok) << result.status.reason;
  EXPECT_NEAR(result.outputs(1, 0), 0.0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Versions, Ball,
                         ::testing::Values("bouncing_ball_2", "bouncing_ball_3", "bouncing_ball_events"));

class Stairs : public ::testing::TestWithParam<Way> {};

TEST_P(Stairs, RisesAtEverySecondExactly) {
  FmuCase fmu;
  fmu.name = GetParam().fmu;
  fmu.kind = GetParam().kind;
  fmu.outputs = {"counter"};
  fmu.times = (Eigen::VectorXd(6) << 0.0, 0.99999, 1.0, 1.00001, 5.5, 9.5).finished();
  fmu.duration = 9.5;
  const FmuResult result = simulate(fmu);
  ASSERT_TRUE(result.status.ok) << result.status.reason;
  EXPECT_EQ(result.outputs.col(0), (Eigen::VectorXd(6) << 1, 1, 2, 2, 6, 10).finished());
}

TEST_P(Stairs, MayEndItsSimulationWithTheLastOutput) {
  FmuCase fmu;
  fmu.name = GetParam().fmu;
  fmu.kind = GetParam().kind;
  fmu.outputs = {"counter"};
  fmu.times = Eigen::VectorXd::LinSpaced(11, 0.0, 10.0);
  fmu.duration = 10.0;
  const FmuResult result = simulate(fmu, 2);
  ASSERT_TRUE(result.status.ok) << result.status.reason;
  EXPECT_EQ(result.outputs(10, 0), 11.0);
}

TEST_P(Stairs, FailsWhereItEndsItsSimulationEarlier) {
  FmuCase fmu;
  fmu.name = GetParam().fmu;
  fmu.kind = GetParam().kind;
  fmu.outputs = {"counter"};
  fmu.times = Eigen::VectorXd::LinSpaced(12, 0.0, 11.0);
  fmu.duration = 11.0;
  const FmuResult result = simulate(fmu);
  EXPECT_FALSE(result.status.ok);
  EXPECT_NE(result.status.reason.find("ended its simulation at t = 10 s"), std::string::npos)
      << result.status.reason;
}

INSTANTIATE_TEST_SUITE_P(Ways, Stairs,
                         ::testing::Values(Way{"stairs_2", Kind::kCoSimulation},
                                           Way{"stairs_3", Kind::kCoSimulation},
                                           Way{"stairs_events", Kind::kCoSimulation},
                                           Way{"stairs_2", Kind::kModelExchange},
                                           Way{"stairs_3", Kind::kModelExchange}));

TEST(EventMode, TakesChangesOfDiscreteInputs) {
  FmuCase fmu;
  fmu.name = "feedthrough_events";
  fmu.excitation = {makePulse("u", "", 3.0, 0.25, 0.5), makePulse("du", "", 2.0, 0.25, 0.5)};
  fmu.outputs = {"y", "dy"};
  fmu.times = Eigen::VectorXd::LinSpaced(11, 0.0, 1.0);
  const FmuResult result = simulate(fmu, 2);
  ASSERT_TRUE(result.status.ok) << result.status.reason;
  for (Eigen::Index i = 0; i < fmu.times.size(); ++i) {
    const bool on = fmu.times[i] >= 0.25 && fmu.times[i] < 0.5;
    EXPECT_EQ(result.outputs(i, 0), on ? 3.0 : 0.0) << fmu.times[i];
    EXPECT_EQ(result.outputs(i, 1), on ? 2.0 : 0.0) << fmu.times[i];
  }
}

TEST(Clocks, ThatFollowTheTimeAreLeftToCoSimulation) {
  FmuCase fmu;
  fmu.name = "clocked";
  fmu.outputs = {"counter"};
  fmu.times = Eigen::VectorXd::LinSpaced(3, 1.0, 3.0);
  fmu.duration = 3.0;
  const FmuResult result = simulate(fmu);
  ASSERT_TRUE(result.status.ok) << result.status.reason;
  EXPECT_EQ(result.outputs.col(0), Eigen::Vector3d(2, 3, 4));
  try {
    fmi::Package(findFmu("clocked")).chooseKind(Kind::kModelExchange);
    FAIL();
  } catch (const ExperimentError& error) {
    EXPECT_NE(std::string(error.what()).find("clock 'clock'"), std::string::npos) << error.what();
  }
}

/// x'' = -c x - d x' with a strong damper creeps back: (s1 exp(s2 t) - s2 exp(s1 t)) / (s1 - s2).
TEST(StiffModels, AreIntegratedImplicitlyAfterTheStepLimit) {
  constexpr double kDamping = 1e6, kStiffness = 4e5;
  FmuCase fmu;
  fmu.name = "oscillator_2";
  fmu.kind = Kind::kModelExchange;
  fmu.parameters = {{"c", kStiffness}, {"d", kDamping}};
  fmu.outputs = {"x"};
  fmu.units = {{"x", "m"}};
  fmu.times = Eigen::VectorXd::LinSpaced(11, 0.0, 5.0);
  fmu.duration = 5.0;
  const FmuResult result = simulate(fmu, 2);
  ASSERT_TRUE(result.status.ok) << result.status.reason;
  EXPECT_TRUE(result.status.stiff_retry);
  const double slow = 2.0 * kStiffness / (kDamping + std::sqrt(kDamping * kDamping - 4.0 * kStiffness));
  for (Eigen::Index i = 0; i < fmu.times.size(); ++i) {
    EXPECT_NEAR(result.outputs(i, 0), 0.1 * std::exp(-slow * fmu.times[i]), 1e-6) << fmu.times[i];
  }
}

}  // namespace
}  // namespace twinmap::testing
