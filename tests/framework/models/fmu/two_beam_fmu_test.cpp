#include <gtest/gtest.h>

#include "tests/framework/models/fmu/fmu_case.hpp"
#include "tests/framework/models/mechanism/two_beam.hpp"

namespace twinmap::testing {
namespace {

using fmi::Kind;

const Eigen::Vector4d kCenter(1.0, 2e-4, 10.0, 0.036);

FmuCase makeTwoBeamCase(const std::string& name, Kind kind, const Eigen::Vector4d& point) {
  const Eigen::Vector2d start = calcTwoBeamEquilibrium(kCenter);
  FmuCase fmu;
  fmu.name = name;
  fmu.kind = kind;
  fmu.parameters = {{"d_y", point[0]},     {"d_theta", point[1]}, {"k_y", point[2]},
                    {"k_theta", point[3]}, {"y_start", start[0]}, {"theta_start", start[1]}};
  fmu.units = {{"d_y", "N s/m"},       {"k_y", "N/m"}, {"k_theta", "N m/rad"}, {"y_start", "m"},
               {"theta_start", "rad"}, {"F", "N"},     {"M", "N m"},           {"y", "m"},
               {"theta", "rad"}};
  fmu.excitation = {makePulse("F", "N", 5.0, 0.2, 0.25), makePulse("M", "N m", 0.075, 0.2, 0.25)};
  fmu.outputs = {"y", "theta"};
  fmu.times = makeTwoBeamTimes();
  fmu.duration = 5.0;
  return fmu;
}

/// Largest distance from the closed form, relative to the range of each output.
double calcError(const FmuResult& result, const Eigen::Vector4d& point) {
  const Eigen::MatrixXd exact = integrateTwoBeam(point, makeTwoBeamTimes()).transpose();
  double worst = 0.0;
  for (Eigen::Index o = 0; o < 2; ++o) {
    const double range = exact.col(o).maxCoeff() - exact.col(o).minCoeff();
    worst = std::max(worst, (result.outputs.col(o) - exact.col(o)).cwiseAbs().maxCoeff() / range);
  }
  return worst;
}

class TwoBeamFmu : public ::testing::TestWithParam<Way> {};

TEST_P(TwoBeamFmu, FollowsTheClosedForm) {
  const Eigen::MatrixXd points = makeTwoBeamPoints(3);
  for (Eigen::Index j = 0; j < points.cols(); ++j) {
    const FmuResult result = simulate(makeTwoBeamCase(GetParam().fmu, GetParam().kind, points.col(j)));
    ASSERT_TRUE(result.status.ok) << result.status.reason;
    EXPECT_LT(calcError(result, points.col(j)), 2e-5);  // what the built-in model is asked for
  }
}

TEST_P(TwoBeamFmu, GivesTheSameBitsWhenItsInstanceIsUsedAgain) {
  const FmuCase fmu = makeTwoBeamCase(GetParam().fmu, GetParam().kind, kCenter);
  EXPECT_EQ(simulate(fmu, 1).outputs, simulate(fmu, 3).outputs);
}

INSTANTIATE_TEST_SUITE_P(
    Ways, TwoBeamFmu,
    ::testing::Values(Way{"two_beam_2", Kind::kCoSimulation}, Way{"two_beam_3", Kind::kCoSimulation},
                      Way{"two_beam_2", Kind::kModelExchange}, Way{"two_beam_3", Kind::kModelExchange},
                      Way{"fixed_step", Kind::kCoSimulation}, Way{"discards", Kind::kCoSimulation},
                      Way{"no_reset", Kind::kModelExchange}, Way{"early_return", Kind::kCoSimulation}));

}  // namespace
}  // namespace twinmap::testing
