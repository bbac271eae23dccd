#include "framework/features/feature_extractor.hpp"

#include <algorithm>

#include "framework/features/sampled_outputs.hpp"

namespace twinmap {
namespace {

std::shared_ptr<const FeatureBlock> makeBlock(const FeatureSpec& feature, const ResponseLayout& layout) {
  return makeSamplesBlock(*feature.samples, layout);
}

}  // namespace

Eigen::VectorXd collectTimes(const std::vector<FeatureSpec>& features) {
  std::vector<double> times;
  for (const FeatureSpec& feature : features) {
    for (int i = 0; i < feature.samples->count; ++i) {
      times.push_back(calcSampleTime(*feature.samples, i));
    }
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return Eigen::Map<Eigen::VectorXd>(times.data(), static_cast<Eigen::Index>(times.size()));
}

FeatureExtractor::FeatureExtractor(const std::vector<FeatureSpec>& features, const ResponseLayout& layout) {
  for (const FeatureSpec& feature : features) {
    blocks_.push_back(makeBlock(feature, layout));
    const std::vector<FeatureInfo>& infos = blocks_.back()->getInfos();
    infos_.insert(infos_.end(), infos.begin(), infos.end());
  }
}

bool FeatureExtractor::isLinear() const {
  return std::all_of(blocks_.begin(), blocks_.end(),
                     [](const auto& block) { return block->findMatrix() != nullptr; });
}

Eigen::MatrixXd FeatureExtractor::extract(const Eigen::MatrixXd& responses) const {
  Eigen::MatrixXd features(getFeatureCount(), responses.cols());
  Eigen::Index row = 0;
  for (const auto& block : blocks_) {
    const auto rows = static_cast<Eigen::Index>(block->getInfos().size());
    block->extract(responses, features.middleRows(row, rows));
    row += rows;
  }
  return features;
}

}  // namespace twinmap
