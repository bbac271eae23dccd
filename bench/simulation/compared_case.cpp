#include "bench/simulation/compared_case.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/points/experiment_points.hpp"

namespace twinmap::bench {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kErrorPoints = 12;
constexpr double kTightest = 1e-13;

MatrixXd solve(const ExperimentSpec& experiment, const VectorXd& times, const MatrixXd& points) {
  MultibodySimulator simulator(withTolerance(experiment.model, kTightest), times);
  return simulateAll(simulator, points.leftCols(kErrorPoints));
}

}  // namespace

ExperimentSpec loadMechanism(const Mechanism& mechanism, int points) {
  std::vector<std::string> overrides = mechanism.overrides;
  overrides.emplace_back("design.test.method=uniform");
  overrides.push_back("design.test.samples=" + std::to_string(points));
  return loadExperiment(mechanism.experiment, overrides);
}

ModelSpec withTolerance(ModelSpec model, double relative) {
  const SimulationSpec defaults;
  model.simulation.relative_tolerance = relative;
  model.simulation.absolute_tolerance = relative * defaults.absolute_tolerance / defaults.relative_tolerance;
  return model;
}

void requireSuccess(const std::vector<SampleStatus>& statuses) {
  for (const SampleStatus& status : statuses) {
    if (!status.ok) {
      throw std::runtime_error("a simulation failed: " + status.reason);
    }
  }
}

MatrixXd simulateAll(MultibodySimulator& simulator, const MatrixXd& points) {
  MatrixXd responses(simulator.getLayout().getRowCount(), points.cols());
  std::vector<SampleStatus> statuses(points.cols());
  for (Index i = 0; i < points.cols(); i += simulator.getBatchSize()) {
    const Index count = std::min<Index>(simulator.getBatchSize(), points.cols() - i);
    simulator.simulate(points.middleCols(i, count), responses.middleCols(i, count), &statuses[i]);
  }
  requireSuccess(statuses);
  return responses;
}

ComparedCase::ComparedCase(const Mechanism& mechanism, int points)
    : mechanism_(mechanism),
      experiment_(loadMechanism(mechanism, points)),
      times_(collectTimes(experiment_.features)),
      points_(sampleTestPoints(experiment_)),
      reference_(solve(experiment_, times_, points_)) {}

VectorXd ComparedCase::calcStart() const {
  MultibodySimulator simulator(experiment_.model, VectorXd::Zero(1));
  return simulateAll(simulator, points_.leftCols(1));
}

double ComparedCase::calcError(const std::function<MatrixXd(Index)>& simulate) const {
  double largest = 0.0;
  for (Index i = 0; i < kErrorPoints; ++i) {
    const MatrixXd expected = reference_.col(i).reshaped(times_.size(), reference_.rows() / times_.size());
    const MatrixXd found = simulate(i).reshaped(expected.rows(), expected.cols());
    const auto range = expected.colwise().maxCoeff() - expected.colwise().minCoeff();
    const auto error = (found - expected).cwiseAbs().colwise().maxCoeff();
    largest = std::max(largest, error.cwiseQuotient(range).maxCoeff());
  }
  return largest;
}

}  // namespace twinmap::bench
