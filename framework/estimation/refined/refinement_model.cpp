#include "framework/estimation/refined/refinement_model.hpp"

#include <algorithm>
#include <numeric>

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Samples after 0 and until `end`; what has no time of its own says something about the whole response.
std::vector<Index> findSamplesUntil(const std::vector<FeatureInfo>& infos, double end) {
  std::vector<Index> found;
  for (std::size_t i = 0; i < infos.size(); ++i) {
    if (infos[i].time > 0.0 && infos[i].time <= end) {
      found.push_back(static_cast<Index>(i));
    }
  }
  return found;
}

double findLastTime(const std::vector<FeatureInfo>& infos) {
  double last = 0.0;
  for (const FeatureInfo& info : infos) {
    last = std::max(last, info.time);
  }
  return last;
}

}  // namespace

RefinementModel::RefinementModel(std::vector<ParameterSpec> unknown, const FeatureExtractor& extractor,
                                 const FeatureNoise& noise)
    : unknown_(std::move(unknown)), features_(extractor), noise_(noise.getLinearForm()) {
  const std::vector<FeatureInfo>& infos = getExtractor().getInfos();
  const double last = findLastTime(infos);
  for (const double fraction : {0.125, 0.25, 0.5}) {
    std::vector<Index> samples = findSamplesUntil(infos, fraction * last);
    const std::size_t known = windows_.empty() ? unknown_.size() : windows_.back().features.size();
    if (samples.size() > known) {
      addWindow(std::move(samples));
    }
  }
  std::vector<Index> all(infos.size());
  std::iota(all.begin(), all.end(), 0);
  addWindow(std::move(all));
}

VectorXd RefinementModel::placeResidual(const VectorXd& residual) const {
  return residual.size() == getExtractor().getFeatureCount() ? features_.placeLinearForm(residual) : residual;
}

void RefinementModel::addWindow(std::vector<Index> features) {
  windows_.push_back({std::move(features), {}});
  if (noise_.isConstant()) {
    windows_.back().whitener = makeWhitener(windows_.back(), {});
  }
}

NoiseWhitener RefinementModel::makeWhitener(const GrowingWindow& window, const VectorXd& response) const {
  const MatrixXd covariance = noise_.calcCovariance(response);
  return NoiseWhitener(covariance(window.features, window.features));
}

}  // namespace twinmap
