// Greedy D-optimal selection on the two-beam case, which needs the simulator's sensitivities.
#include <gtest/gtest.h>

#include <cmath>

#include "framework/data/reduction/selections.hpp"
#include "framework/data/sensitivity/feature_sensitivities.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/models/mechanism/simulator/multibody_simulator.hpp"
#include "tests/framework/models/mechanism/two_beam.hpp"
#include "tests/lu.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Mean log det of the information of independent features and the box.
double calcMeanLogDet(const std::vector<Index>& features, const VectorXd& stddev,
                      const std::vector<MatrixXd>& sensitivities) {
  double sum = 0.0;
  for (const MatrixXd& all : sensitivities) {
    const MatrixXd j = VectorXd(stddev(features)).cwiseInverse().asDiagonal() * all(features, Eigen::all);
    const MatrixXd information = j.transpose() * j + 12.0 * MatrixXd::Identity(j.cols(), j.cols());
    sum += std::log(test::calcDeterminant(information));
  }
  return sum / static_cast<double>(sensitivities.size());
}

TEST(FisherSelection, OfTheTwoBeamsTellsMoreThanEquidistantSamples) {
  const ExperimentSpec experiment =
      loadExperiment(std::string(TWINMAP_SOURCE_DIR) + "/experiments/two_beam/table1.yaml");
  const MultibodySimulator simulator(experiment.model, collectTimes(experiment.features));
  const FeatureExtractor extractor(experiment.features, simulator.getLayout());
  std::vector<MatrixXd> sensitivities;
  for (const LocalModel& local :
       calcLocalModels(simulator, extractor, experiment.model.parameters, testing::makeTwoBeamPoints(4), 2)) {
    ASSERT_TRUE(local.status.ok) << local.status.reason;
    sensitivities.push_back(local.sensitivities);
  }
  VectorXd stddev(200);
  stddev << VectorXd::Constant(100, 5e-5), VectorXd::Constant(100, 0.015);
  std::vector<Index> equidistant;
  for (Index i = 9; i < 200; i += 10) {
    equidistant.push_back(i);
  }
  const MatrixXd covariance = stddev.cwiseAbs2().asDiagonal();
  const std::vector<Index> selected = selectByFisherInformation({20}, covariance, sensitivities);
  EXPECT_GT(calcMeanLogDet(selected, stddev, sensitivities),
            calcMeanLogDet(equidistant, stddev, sensitivities) + 1.0);
}

}  // namespace
}  // namespace twinmap
