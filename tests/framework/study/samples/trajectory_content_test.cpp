#include "framework/study/samples/trajectory_content.hpp"

#include <gtest/gtest.h>

#include "framework/experiment/files/experiment_file.hpp"
#include "framework/study/samples/model_store.hpp"

namespace twinmap {
namespace {

const std::string kTable1 = std::string(TWINMAP_SOURCE_DIR) + "/experiments/two_beam/table1.yaml";

ResponseLayout makeLayout() {
  return {{"y", "theta"}, {"m", "rad"}, Eigen::VectorXd::LinSpaced(3, 0.1, 0.3), 0};
}

std::string write(const std::vector<std::string>& overrides) {
  return writeTrajectoryContent(loadExperiment(kTable1, overrides).model, makeLayout());
}

TEST(TrajectoryContent, WhatDeterminesAResponseChangesIt) {
  const std::string reference = write({});
  for (const char* change : {"constants.m1=3.4", "system.springs[0].rest=0.1", "system.gravity=[0, 0, -9.8]",
                             "simulation.duration=6", "excitation.F.pulses[0].amplitude=6", "initial={}",
                             "initial.equilibrium.at=sample", "initial.equilibrium.parameters.k_y=6",
                             "outputs.y={speed: y}", "simulation.engine=simbody",
                             "simulation.relative_tolerance=1e-7", "simulation.absolute_tolerance=1e-8",
                             "simulation.max_steps=50000", "parameters.k_y.bounds=[5, 16]"}) {
    EXPECT_NE(write({change}), reference) << change;
  }
}

/// Of experiments/python_plant.
std::string writePlant(const std::string& override) {
  const std::string file = std::string(TWINMAP_SOURCE_DIR) + "/experiments/python_plant/python_plant.yaml";
  const std::vector<std::string> overrides(override.empty() ? 0 : 1, override);
  return writeTrajectoryContent(loadExperiment(file, overrides).model, makeLayout());
}

TEST(TrajectoryContent, OfAProgramIsItsCommandAndTheFilesThatItReads) {
  const std::string reference = writePlant("");
  for (const char* change :
       {"model.program.command=[/usr/bin/python3, python_plant.yaml]",
        "model.program.depends_on=[python_plant.yaml]", "model.program.environment={A: b}",
        "model.program.excitation_interval=0.1", "parameters.k_y.variable=other"}) {
    EXPECT_NE(writePlant(change), reference) << change;
  }
  for (const char* same : {"model.program.timeout=3", "model.program.batch=7", "model.program.workers=1",
                           "model.program.memory=2", "model.program.start_timeout=5"}) {
    EXPECT_EQ(writePlant(same), reference) << same;
  }
}

TEST(TrajectoryContent, WhatDoesNotChangeAResponseDoesNot) {
  const std::string reference = write({});
  for (const char* same :
       {"name=other", "description=x", "seed=2", "noise.scale=3", "design.train.samples=70",
        "design.train.method=sobol", "transform=[z_score: {}]", "inverse_map.gp.covariance=matern52",
        "parameters.k_y.description=spring", "parameters.k_y.relative_to=range", "simulation.max_wall_time=5",
        "simulation.allowed_failures=0.5", "report.over=[d_y, k_y]",
        "system.bodies.beam1.shapes=[{box: [1, 1, 1]}]", "measurement.start=1",
        "parameters.k_y.bounds=[6, 14]"}) {  // the same centre
    EXPECT_EQ(write({same}), reference) << same;
  }
}

TEST(TrajectoryContent, WhatIsPortableIsNamedByTheCommonInstructionSetAndElseTheSame) {
  const ModelSpec own = loadExperiment(kTable1, {}).model;
  const ModelSpec portable = loadExperiment(kTable1, {"simulation.portable=true"}).model;
  EXPECT_EQ(writeTrajectoryContent(portable, makeLayout()), writeTrajectoryContent(own, makeLayout()));
  EXPECT_NE(writeStoreContent(portable, makeLayout()), writeStoreContent(own, makeLayout()));
  EXPECT_NE(writeStoreContent(portable, makeLayout()).find("portable (x86-64-v3)"), std::string::npos);
}

TEST(TrajectoryContent, BoundsCountOnlyWhereTheInitialStateIsTheCentresEquilibrium) {
  for (const char* initial : {"initial={}", "initial.equilibrium.at=sample"}) {
    EXPECT_EQ(write({initial, "parameters.k_y.bounds=[5, 16]"}), write({initial}));
  }
}

TEST(TrajectoryContent, TheRoleOfAParameterAndTheFileOfATableDoNotCount) {
  const auto without = [](const std::string& role) {
    ModelSpec model = loadExperiment(kTable1).model;
    const ParameterSpec last = model.parameters.back();
    model.parameters.pop_back();
    (role == "nuisance" ? model.nuisance : model.inputs).push_back(last);
    return writeTrajectoryContent(model, makeLayout());
  };
  EXPECT_EQ(without("nuisance"), write({}));
  EXPECT_EQ(without("inputs"), write({}));
  const std::string table = "times: [0, 1], values: [2, 3]}]";
  EXPECT_EQ(write({"excitation.F.tables=[{measured: {file: a, column: b, time: t}, " + table}),
            write({"excitation.F.tables=[{" + table}));
}

TEST(TrajectoryContent, SensorsCount) {
  EXPECT_NE(write({"outputs.y.gain=1.01"}), write({}));
  EXPECT_NE(write({"outputs.y.offset=0.01"}), write({}));
}

// Users may give names that are keys elsewhere: they must not be taken for descriptions or units.
TEST(TrajectoryContent, ConstantsOfAnyNameCount) {
  for (const std::string name : {"description", "unit", "max_wall_time"}) {
    EXPECT_NE(write({"constants." + name + "=1"}), write({"constants." + name + "=2"})) << name;
    EXPECT_EQ(write({"constants." + name + "={value: 1, description: a}"}),
              write({"constants." + name + "={value: 1, description: b, unit: m}"}));
  }
}

TEST(TrajectoryContent, TheRowsOfAResponseCount) {
  const ModelSpec model = loadExperiment(kTable1).model;
  const std::string reference = writeTrajectoryContent(model, makeLayout());
  ResponseLayout times = makeLayout(), modes = makeLayout();
  times.times[1] += 1e-12;
  modes.modes = 2;
  EXPECT_NE(writeTrajectoryContent(model, times), reference);
  EXPECT_NE(writeTrajectoryContent(model, modes), reference);
}

TEST(TrajectoryContent, AResolvedExperimentHasTheSame) {
  const ExperimentSpec experiment = loadExperiment(kTable1);
  const ExperimentSpec again = readExperiment(parseYaml(writeExperiment(experiment), "resolved.yaml"));
  EXPECT_EQ(writeTrajectoryContent(again.model, makeLayout()),
            writeTrajectoryContent(experiment.model, makeLayout()));
}

}  // namespace
}  // namespace twinmap
