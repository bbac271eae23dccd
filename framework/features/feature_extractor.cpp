#include "framework/features/feature_extractor.hpp"

#include <algorithm>

#include "framework/features/extrema.hpp"
#include "framework/features/frequency_response.hpp"
#include "framework/features/mode_features.hpp"
#include "framework/features/sampled_outputs.hpp"
#include "framework/features/spectrum.hpp"
#include "framework/features/statistics.hpp"

namespace twinmap {
namespace {

using Blocks = std::vector<std::shared_ptr<const FeatureBlock>>;

Blocks makeBlocks(const FeatureSpec& feature, const ResponseLayout& layout, const InputSignals& inputs) {
  if (feature.statistics) {
    return makeStatisticsBlocks(*feature.statistics, layout);
  }
  if (feature.extrema) {
    return {makeExtremaBlock(*feature.extrema, layout)};
  }
  if (feature.spectrum) {
    return {makeSpectrumBlock(*feature.spectrum, layout)};
  }
  if (feature.frequency_response) {
    return {makeFrequencyResponseBlock(*feature.frequency_response, layout, inputs)};
  }
  if (feature.modes) {
    return {makeModesBlock(*feature.modes, layout)};
  }
  return {makeSamplesBlock(*feature.samples, layout)};
}

template <class Samples>
void appendTimes(const Samples& samples, std::vector<double>& times) {
  for (int i = 0; i < samples.count; ++i) {
    times.push_back(calcSampleTime(samples, i));
  }
}

void appendTimes(const FeatureSpec& feature, std::vector<double>& times) {
  if (feature.samples) {
    appendTimes(*feature.samples, times);
  }
  if (feature.statistics) {
    appendTimes(feature.statistics->window, times);
  }
  if (feature.extrema) {
    appendTimes(feature.extrema->window, times);
  }
  if (feature.spectrum) {
    appendTimes(feature.spectrum->window, times);
  }
  if (feature.frequency_response) {
    appendTimes(feature.frequency_response->window, times);
  }
}

}  // namespace

Eigen::VectorXd collectTimes(const std::vector<FeatureSpec>& features) {
  std::vector<double> times;
  for (const FeatureSpec& feature : features) {
    appendTimes(feature, times);
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return Eigen::Map<Eigen::VectorXd>(times.data(), static_cast<Eigen::Index>(times.size()));
}

bool needExcitation(const std::vector<FeatureSpec>& features) {
  return std::any_of(features.begin(), features.end(),
                     [](const FeatureSpec& feature) { return feature.frequency_response.has_value(); });
}

FeatureExtractor::FeatureExtractor(const std::vector<FeatureSpec>& features, const ResponseLayout& layout,
                                   const InputSignals& inputs) {
  for (const FeatureSpec& feature : features) {
    const Blocks blocks = makeBlocks(feature, layout, inputs);
    blocks_.insert(blocks_.end(), blocks.begin(), blocks.end());
  }
  for (const auto& block : blocks_) {
    infos_.insert(infos_.end(), block->getInfos().begin(), block->getInfos().end());
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
