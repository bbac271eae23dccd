#include "framework/estimation/ridges/simulated_ridges.hpp"

#include <algorithm>

#include "framework/data/noise/noise_whitener.hpp"
#include "framework/data/sensitivity/feature_sensitivities.hpp"
#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/sampling/weighted_draws.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<MatrixXd> calcInformation(const Simulator& simulator, const FeatureExtractor& extractor,
                                      const FeatureNoise& noise, const ModelSpec& model,
                                      const MatrixXd& points, int threads) {
  const auto p = static_cast<Index>(model.parameters.size());
  std::vector<MatrixXd> information;
  for (const LocalModel& local :
       calcLocalModels(simulator, extractor, collectUnknown(model), points, threads)) {
    information.emplace_back();
    if (local.status.ok) {
      const NoiseWhitener whitener(noise.calcCovariance(local.response));
      information.back() = calcMarginalInformation(calcFisherInformation(whitener, local.sensitivities), p);
    }
  }
  return information;
}

bool mayHaveRidges(const BoundedDraws& draws, const std::vector<ParameterSpec>& parameters) {
  const VectorXd widths = calcWidths(parameters);
  return mayBeFlat(importance::calcCovariance(
      {widths.cwiseInverse().asDiagonal() * draws.points.topRows(widths.size()), draws.weights}));
}

std::vector<Ridge> simulateRidges(const Simulator& simulator, const FeatureExtractor& extractor,
                                  const FeatureNoise& noise, const ModelSpec& model, const MatrixXd& points,
                                  int threads) {
  const auto most = hasManyForNames(model) ? Index{1} : kStandingDraws;
  const MatrixXd chosen = points.leftCols(std::min(most, points.cols()));
  const auto p = static_cast<Index>(model.parameters.size());
  return findRidges(calcInformation(simulator, extractor, noise, model, chosen, threads), chosen.topRows(p),
                    model, RidgePoints::kOfOneMeasurement);
}

}  // namespace twinmap
