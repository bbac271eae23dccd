#include <gtest/gtest.h>

#include "framework/data/sensitivity/stencil_simulator.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/models/external/program_simulator.hpp"
#include "framework/simulation/sample_generator.hpp"
#include "tests/framework/models/mechanism/two_beam.hpp"

namespace twinmap::testing {
namespace {

ModelSpec loadPlant(int batch) {
  return loadExperiment(TWINMAP_SOURCE_DIR "/experiments/python_plant/python_plant.yaml",
                        {"model.program.batch=" + std::to_string(batch),
                         "model.program.command=[/usr/bin/python3, plant.py]"})  // that of the packages
      .model;
}

Trajectories simulatePlant(int batch, int threads, int samples) {
  const ModelSpec model = loadPlant(batch);
  GeneratorOptions options;
  options.threads = threads;
  return generateSamples(ProgramSimulator(model, makeTwoBeamTimes(), 0), makeTwoBeamPoints(samples), options);
}

TEST(PythonPlant, FollowsTheClosedFormOfTheTwoBeams) {
  const Trajectories result = simulatePlant(4, 1, 4);
  const Eigen::Index times = result.layout.times.size();
  for (Eigen::Index j = 0; j < result.parameters.cols(); ++j) {
    ASSERT_TRUE(result.statuses[j].ok) << result.statuses[j].reason;
    const Eigen::MatrixXd exact = integrateTwoBeam(result.parameters.col(j), result.layout.times);
    for (Eigen::Index o = 0; o < 2; ++o) {
      const double range = exact.row(o).maxCoeff() - exact.row(o).minCoeff();
      const Eigen::VectorXd error =
          result.responses.col(j).segment(o * times, times) - exact.row(o).transpose();
      EXPECT_LT(error.cwiseAbs().maxCoeff(), 2e-5 * range);  // what the built-in model is asked for
    }
  }
}

TEST(PythonPlant, GivesTheSameBitsInAnyBatchAndOnAnyNumberOfThreads) {
  const Trajectories one = simulatePlant(1, 1, 6);
  EXPECT_EQ(one.responses, simulatePlant(4, 2, 6).responses);
  EXPECT_EQ(one.responses, simulatePlant(6, 1, 6).responses);
}

Eigen::MatrixXd simulatePlantsStencils(int batch, int threads) {
  const ModelSpec model = loadPlant(batch);
  const ProgramSimulator simulator(model, makeTwoBeamTimes(), 0);
  GeneratorOptions options;
  options.threads = threads;
  return generateSamples(StencilSimulator(simulator, model.parameters), makeTwoBeamPoints(5), options)
      .responses;
}

TEST(PythonPlant, GivesTheSameStencilsWhetherTheyShareRequestsOrNot) {
  const Eigen::MatrixXd alone = simulatePlantsStencils(1, 1);
  ASSERT_TRUE(alone.allFinite());
  EXPECT_EQ(alone, simulatePlantsStencils(20, 2));  // two points a request, and one for the last
  EXPECT_EQ(alone, simulatePlantsStencils(7, 1));   // a point's neighbours in two requests
}

TEST(PythonPlant, TakesAsManyPointsAsHaveTheirNeighboursInOneRequest) {
  const ModelSpec model = loadPlant(50);
  const ProgramSimulator simulator(model, makeTwoBeamTimes(), 0);
  EXPECT_EQ(StencilSimulator(simulator, model.parameters).getBatchSize(), 5);
}

}  // namespace
}  // namespace twinmap::testing
