#include "framework/inference/tolerances/tolerances.hpp"

#include <gtest/gtest.h>

#include "framework/experiment/files/experiment_file.hpp"
#include "framework/inference/tolerances/onset_speeds.hpp"
#include "tests/framework/experiment/experiments.hpp"

namespace twinmap {
namespace {

using Overrides = std::vector<std::string>;

const std::string kPendulum =
    std::string(TWINMAP_SOURCE_DIR) + "/experiments/mechanisms/double_pendulum_mild.yaml";

SimulationSpec follow(const std::string& file, const Overrides& overrides = {}) {
  return followNoise(loadExperiment(file, overrides)).model.simulation;
}

TEST(Tolerances, StayWhereTheNoiseIsFarAboveTheErrors) {
  for (const std::string& file : {kTable1, kCart}) {
    const SimulationSpec found = follow(file);
    EXPECT_EQ(found.relative_tolerance, 3e-7) << file;
    EXPECT_EQ(found.absolute_tolerance, 1e-9);
    EXPECT_FALSE(found.relative_tolerance.automatic || found.absolute_tolerance.automatic);
  }
}

// 1e-7 of the range of the response.
TEST(Tolerances, AreTightenedUntilNoEstimateMoves) {
  for (const auto& [file, scale] : {std::pair{kCart, 1e-4}, {kPendulum, 1e-4}}) {
    const ExperimentSpec experiment = loadExperiment(file, {"noise.scale=" + std::to_string(scale)});
    IntegrationErrors errors(experiment);
    EXPECT_FALSE(errors.calc(experiment.model.simulation)->isNegligible());
    const SimulationSpec found = followNoise(experiment).model.simulation;
    EXPECT_LT(found.relative_tolerance, 3e-8);
    EXPECT_NEAR(found.relative_tolerance / found.absolute_tolerance, 300.0, 1e-9);
    EXPECT_TRUE(errors.calc(found)->isNegligible()) << file;
  }
}

TEST(Tolerances, ThatAreGivenStay) {
  const SimulationSpec found =
      follow(kCart, {"simulation.relative_tolerance=1e-3", "simulation.absolute_tolerance=1e-4"});
  EXPECT_EQ(found.relative_tolerance, 1e-3);
  EXPECT_EQ(found.absolute_tolerance, 1e-4);
  const SimulationSpec one = follow(kCart, {"simulation.relative_tolerance=1e-3"});
  EXPECT_EQ(one.relative_tolerance, 1e-3);
  EXPECT_EQ(one.absolute_tolerance, 1e-9);
}

TEST(Tolerances, DoNotFollowWhatIsNotThere) {
  EXPECT_EQ(follow(kCart, {"noise.scale=0", "transform=[z_score]"}).relative_tolerance, 3e-7);
}

TEST(Tolerances, WarnOfAnOnsetSpeedOnWhichEstimatesDepend) {
  const auto describe = [](const std::string& onset) {
    const ExperimentSpec experiment = loadExperiment(
        kCart,
        {"system.friction=[{coordinate: x, model: regularised, coulomb: 0.05, onset_speed: " + onset + "}]"});
    IntegrationErrors errors(experiment);
    return describeOnsetSpeeds(experiment, errors);
  };
  EXPECT_NE(describe("0.3").find("half of it moves d by up to"), std::string::npos) << describe("0.3");
  EXPECT_EQ(describe("1e-5"), "");
}

TEST(Tolerances, DoNotDependOnTheSeed) {
  const Overrides low{"noise.scale=1e-4"}, other{"noise.scale=1e-4", "seed=5"};
  EXPECT_EQ(follow(kCart, low).relative_tolerance, follow(kCart, other).relative_tolerance);
}

// So that they are read back from resolved.yaml and maps.h5.
TEST(Tolerances, AreWrittenAsNumbers) {
  const ExperimentSpec followed = followNoise(loadExperiment(kCart, {"noise.scale=1e-4"}));
  const ExperimentSpec read = readResolved(writeExperiment(followed));
  EXPECT_EQ(read.model.simulation.relative_tolerance, followed.model.simulation.relative_tolerance);
  EXPECT_FALSE(read.model.simulation.relative_tolerance.automatic);
  EXPECT_NE(writeExperiment(loadExperiment(kCart)).find("relative_tolerance: automatic"), std::string::npos);
}

TEST(Tolerances, AreFoundOnceForCasesThatShareThem) {
  std::vector<SweepCase> cases(3);
  for (SweepCase& one : cases) {
    one.experiment = loadExperiment(kCart);
  }
  cases[1].experiment.seed = 7;
  cases[2].experiment.noise.scale = 1e-4;
  followNoise(cases);
  EXPECT_EQ(cases[0].experiment.model.simulation.relative_tolerance, 3e-7);
  EXPECT_EQ(cases[1].experiment.model.simulation.relative_tolerance, 3e-7);
  EXPECT_LT(cases[2].experiment.model.simulation.relative_tolerance, 3e-8);
  EXPECT_EQ(cases[1].model, cases[0].model);
  EXPECT_NE(cases[2].model, cases[0].model);
}

}  // namespace
}  // namespace twinmap
