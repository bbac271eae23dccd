#include "framework/data/sensitivity/feature_sensitivities.hpp"

#include <algorithm>
#include <limits>

#include "framework/data/sensitivity/stencil_simulator.hpp"
#include "framework/simulation/simulator_team.hpp"
#include "framework/simulation/stencil.hpp"

namespace twinmap {

using Eigen::MatrixXd;
using Eigen::VectorXd;

LocalModel makeLocalModel(const FeatureExtractor& extractor, const std::vector<ParameterSpec>& parameters,
                          const VectorXd& point, const Eigen::Ref<const VectorXd>& stencil,
                          const SampleStatus& status) {
  const auto points = 2 * static_cast<Eigen::Index>(parameters.size()) + 1;
  const MatrixXd responses = stencil.reshaped(stencil.size() / points, points);
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

std::vector<LocalModel> calcLocalModels(const Simulator& prototype, const FeatureExtractor& extractor,
                                        const std::vector<ParameterSpec>& parameters, const MatrixXd& points,
                                        int threads) {
  std::vector<LocalModel> models(points.cols());
  const int batch = prototype.getBatchSize(), count = static_cast<int>(points.cols());
  runOnTeam(prototype, (count + batch - 1) / batch, threads, [&](Simulator& simulator, int index) {
    const int first = index * batch, size = std::min(batch, count - first);
    MatrixXd stencils(simulator.getLayout().getRowCount() * countNeighbours(parameters.size()), size);
    std::vector<SampleStatus> statuses(size);
    simulateStencils(simulator, parameters, points.middleCols(first, size), stencils, statuses.data());
    for (int i = 0; i < size; ++i) {
      models[first + i] =
          makeLocalModel(extractor, parameters, points.col(first + i), stencils.col(i), statuses[i]);
    }
  });
  return models;
}

}  // namespace twinmap
