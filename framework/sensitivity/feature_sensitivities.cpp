#include "framework/sensitivity/feature_sensitivities.hpp"

#include <limits>

#include "framework/sensitivity/neighbourhood_simulator.hpp"
#include "framework/sensitivity/stencil.hpp"
#include "framework/simulation/simulator_team.hpp"

namespace twinmap {

using Eigen::MatrixXd;
using Eigen::VectorXd;

LocalModel makeLocalModel(const FeatureExtractor& extractor, const std::vector<ParameterSpec>& parameters,
                          const VectorXd& point, const VectorXd& neighbourhood, const SampleStatus& status) {
  const auto points = 2 * static_cast<Eigen::Index>(parameters.size()) + 1;
  const MatrixXd responses = neighbourhood.reshaped(neighbourhood.size() / points, points);
  const MatrixXd features = extractor.extract(responses);
  LocalModel local{responses.col(0), features.col(0), calcDifferences(features, parameters, point), status};
  if (status.ok && !features.allFinite()) {
    local.status = {false, "a feature is missing in the response"};
  }
  if (!local.status.ok) {
    local.sensitivities.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return local;
}

LocalModel calcLocalModel(Simulator& simulator, const FeatureExtractor& extractor,
                          const std::vector<ParameterSpec>& parameters, const VectorXd& point) {
  const MatrixXd points = makeNeighbours(parameters, point);
  MatrixXd responses(simulator.getLayout().getRowCount(), points.cols());
  const SampleStatus status = simulateNeighbours(simulator, points, responses);
  return makeLocalModel(extractor, parameters, point, responses.reshaped(), status);
}

std::vector<LocalModel> calcLocalModels(const Simulator& prototype, const FeatureExtractor& extractor,
                                        const std::vector<ParameterSpec>& parameters, const MatrixXd& points,
                                        int threads) {
  std::vector<LocalModel> models(points.cols());
  runOnTeam(prototype, static_cast<int>(points.cols()), threads, [&](Simulator& simulator, int i) {
    models[i] = calcLocalModel(simulator, extractor, parameters, points.col(i));
  });
  return models;
}

}  // namespace twinmap
