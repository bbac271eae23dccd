#include "framework/models/fmu/fmu_simulator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "framework/simulation/sample_generator.hpp"
#include "tests/framework/models/fmu/fmu_case.hpp"

namespace twinmap::testing {
namespace {

/// x' = -x with the faults of fmus/faulty.c, x(0) sampled too.
ModelSpec makeFaulty(const std::string& fmu = "faulty_3") {
  ModelSpec model;
  model.source.emplace().fmu.emplace().file = {findFmu(fmu), {}};
  model.parameters = {{{"fault", {}}, {0.0, 6.0, {}}, "", "", RelativeTo::kRange, {}},
                      {{"x", {}}, {0.5, 1.5, {}}, "", "", RelativeTo::kValue, {}}};
  OutputSpec output;
  output.name = {"x", {}};
  output.variable = Name{"x", {}};
  model.outputs = {output};
  model.simulation.duration = 1.0;
  model.simulation.max_wall_time = 0.5;
  return model;
}

class FmuProcesses : public ::testing::Test {
 protected:
  void SetUp() override { setenv("TWINMAP_WORKER", TWINMAP_EXECUTABLE, 1); }

  FmuSimulator simulator_{makeFaulty(), Eigen::VectorXd::LinSpaced(10, 0.1, 1.0), 0};
};

TEST_F(FmuProcesses, AFaultyNeighbourChangesNoBit) {
  Eigen::MatrixXd points(2, 9);
  points << 0, 1, 0, 6, 0, 5, 3, 4, 0,  //
      1.0, 1.0, 0.7, 1.0, 1.2, 1.0, 1.0, 1.0, 0.9;
  Eigen::MatrixXd responses(10, 9);
  std::vector<SampleStatus> statuses(9);
  simulator_.simulate(points, responses, statuses.data());
  for (const Eigen::Index good : {0, 2, 4, 8}) {
    ASSERT_TRUE(statuses[good].ok) << statuses[good].reason;
    Eigen::MatrixXd alone(10, 1);
    SampleStatus status;
    FmuSimulator(makeFaulty(), simulator_.getLayout().times, 0).simulate(points.col(good), alone, &status);
    EXPECT_EQ(alone, responses.col(good));
    EXPECT_NEAR(alone(9), points(1, good) * std::exp(-1.0), 1e-9);
  }
  for (const Eigen::Index bad : {1, 3, 5, 6, 7}) {
    EXPECT_FALSE(statuses[bad].ok);
    EXPECT_FALSE(statuses[bad].reason.empty());
    EXPECT_TRUE(responses.col(bad).array().isNaN().all());
  }
}

TEST_F(FmuProcesses, SamplesHaveTheSameBitsWithAnyNumberOfThreads) {
  Eigen::MatrixXd points(2, 40);
  for (Eigen::Index j = 0; j < points.cols(); ++j) {
    points.col(j) << (j % 7 == 3 ? 1.0 : 0.0), 0.5 + 0.02 * static_cast<double>(j);
  }
  GeneratorOptions options;
  options.threads = 1;
  const Trajectories one = generateSamples(simulator_, points, options);
  options.threads = 2;
  const Trajectories two = generateSamples(simulator_, points, options);
  for (Eigen::Index j = 0; j < points.cols(); ++j) {
    EXPECT_EQ(one.statuses[j].reason, two.statuses[j].reason);
    EXPECT_TRUE(!one.statuses[j].ok || one.responses.col(j) == two.responses.col(j));
  }
}

TEST_F(FmuProcesses, NeighboursShareTheStepsOfTheirCentre) {
  ModelSpec model = makeFaulty();
  model.source->fmu->kind = FmuKind::kModelExchange;
  FmuSimulator simulator(model, Eigen::VectorXd::LinSpaced(10, 0.1, 1.0), 0);
  const double difference = 1e-7;  // rounding 1e-9 of the slope; steps of their own would leave some 1e-2
  Eigen::MatrixXd points(2, 3);
  points << 0.0, 0.0, 0.0, 1.0, 1.0 - difference, 1.0 + difference;
  Eigen::MatrixXd responses(10, 3);
  std::vector<SampleStatus> statuses(3);
  simulator.simulateAround(points, responses, statuses.data());
  ASSERT_TRUE(statuses[2].ok) << statuses[2].reason;
  for (Eigen::Index i = 0; i < 10; ++i) {
    const double slope = (responses(i, 2) - responses(i, 1)) / (2.0 * difference);
    EXPECT_NEAR(slope, std::exp(-simulator.getLayout().times[i]), 1e-6);
  }
}

TEST_F(FmuProcesses, AHangEndsWithItsTimeAndMayBeTriedAgain) {
  Eigen::MatrixXd response(10, 1);
  SampleStatus status;
  simulator_.simulate(Eigen::Vector2d(2.0, 1.0), response, &status);
  EXPECT_FALSE(status.ok);
  EXPECT_TRUE(status.machine_dependent);
  EXPECT_NE(status.reason.find("within its time"), std::string::npos) << status.reason;
}

TEST_F(FmuProcesses, WhatSamplesBeforeDidToAProcessDecidesNothing) {
  Eigen::MatrixXd points(2, 3);
  points << 0.0, 8.0, 0.0, 1.0, 1.1, 1.2;
  Eigen::MatrixXd responses(10, 3);
  std::vector<SampleStatus> statuses(3);
  simulator_.simulate(points, responses, statuses.data());
  ASSERT_TRUE(statuses[1].ok) << statuses[1].reason;
  EXPECT_NEAR(responses(9, 1), 1.1 * std::exp(-1.0), 1e-9);
}

TEST_F(FmuProcesses, AWorkerThatCannotStartIsAFailedSample) {
  setenv("TWINMAP_WORKER", "/nowhere/twinmap", 1);
  Eigen::MatrixXd response(10, 1);
  SampleStatus status;
  simulator_.simulate(Eigen::Vector2d(0.0, 1.0), response, &status);
  EXPECT_NE(status.reason.find("/nowhere/twinmap"), std::string::npos) << status.reason;
}

}  // namespace
}  // namespace twinmap::testing
