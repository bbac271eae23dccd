#include "framework/estimation/refined/refinement_model.hpp"

#include <algorithm>

#include "kernels/linalg/order.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Samples after 0 and until `end`; what has no time of its own says something about the whole response.
std::vector<Index> findSamplesUntil(const std::vector<FeatureInfo>& infos,
                                    const std::vector<Index>& available, double end) {
  std::vector<Index> found;
  for (const Index i : available) {
    const double time = infos[static_cast<std::size_t>(i)].time;
    if (time > 0.0 && time <= end) {
      found.push_back(i);
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
    : RefinementModel(std::move(unknown), extractor, noise, {}) {}

RefinementModel::RefinementModel(std::vector<ParameterSpec> unknown, const FeatureExtractor& extractor,
                                 const FeatureNoise& noise, std::vector<Index> available)
    : unknown_(std::move(unknown)), features_(extractor), noise_(noise.getLinearForm()) {
  const std::vector<FeatureInfo>& infos = getExtractor().getInfos();
  if (available.empty()) {
    available = listIndices(infos.size());
  }
  const double last = findLastTime(infos);
  for (const double fraction : {0.125, 0.25, 0.5}) {
    std::vector<Index> samples = findSamplesUntil(infos, available, fraction * last);
    const std::size_t known = windows_.empty() ? unknown_.size() : windows_.back().features.size();
    if (samples.size() > known) {
      addWindow(std::move(samples));
    }
  }
  addWindow(std::move(available));
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
  return NoiseWhitener(noise_.calcCovariance(response).take(window.features));
}

}  // namespace twinmap
