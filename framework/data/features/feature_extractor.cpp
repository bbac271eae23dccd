#include "framework/data/features/feature_extractor.hpp"

#include <algorithm>

#include "framework/data/features/extrema.hpp"
#include "framework/data/features/frequency_response.hpp"
#include "framework/data/features/mode_features.hpp"
#include "framework/data/features/sampled_outputs.hpp"
#include "framework/data/features/spectrum.hpp"
#include "framework/data/features/statistics.hpp"

namespace twinmap {
namespace {

using Blocks = std::vector<std::shared_ptr<const FeatureBlock>>;

Blocks makeBlocks(const SamplesFeatureSpec& samples, const ResponseLayout& layout, const InputSignals&) {
  return {makeSamplesBlock(samples, layout)};
}
Blocks makeBlocks(const StatisticsFeatureSpec& statistics, const ResponseLayout& layout,
                  const InputSignals&) {
  return makeStatisticsBlocks(statistics, layout);
}
Blocks makeBlocks(const ExtremaFeatureSpec& extrema, const ResponseLayout& layout, const InputSignals&) {
  return {makeExtremaBlock(extrema, layout)};
}
Blocks makeBlocks(const SpectrumFeatureSpec& spectrum, const ResponseLayout& layout, const InputSignals&) {
  return {makeSpectrumBlock(spectrum, layout)};
}
Blocks makeBlocks(const FrequencyResponseFeatureSpec& response, const ResponseLayout& layout,
                  const InputSignals& inputs) {
  return {makeFrequencyResponseBlock(response, layout, inputs)};
}
Blocks makeBlocks(const ModesFeatureSpec& modes, const ResponseLayout& layout, const InputSignals&) {
  return {makeModesBlock(modes, layout)};
}

/// Where the features of a block stand, and those of its linear form (their own where it has none).
struct BlockRows {
  Eigen::Index first, count, linear_first, linear_count;
};

/// Returns how many features the linear form has.
template <class Function>
Eigen::Index forEachBlock(const Blocks& blocks, const Function& function) {
  BlockRows rows{};
  for (const auto& block : blocks) {
    const auto linear = block->findLinearForm();
    rows.count = static_cast<Eigen::Index>(block->getInfos().size());
    rows.linear_count = static_cast<Eigen::Index>((linear ? linear : block)->getInfos().size());
    function(*block, rows);
    rows.first += rows.count;
    rows.linear_first += rows.linear_count;
  }
  return rows.linear_first;
}

}  // namespace

Eigen::VectorXd collectTimes(const std::vector<FeatureSpec>& features) {
  std::vector<double> times;
  for (const FeatureSpec& feature : features) {
    appendSampleTimes(getWindow(feature), times);
  }
  sortUnique(times);
  return Eigen::Map<Eigen::VectorXd>(times.data(), static_cast<Eigen::Index>(times.size()));
}

std::optional<double> findSampleInterval(const std::vector<FeatureSpec>& features) {
  std::optional<double> smallest;
  for (const FeatureSpec& feature : features) {
    std::vector<double> times;
    appendSampleTimes(getWindow(feature), times);
    for (std::size_t i = 1; i < times.size(); ++i) {
      smallest = std::min(times[i] - times[i - 1], smallest.value_or(times[i] - times[i - 1]));
    }
  }
  return smallest;
}

bool needExcitation(const std::vector<FeatureSpec>& features) {
  return std::any_of(features.begin(), features.end(), [](const FeatureSpec& feature) {
    return std::holds_alternative<FrequencyResponseFeatureSpec>(feature);
  });
}

FeatureExtractor::FeatureExtractor(const std::vector<FeatureSpec>& features, const ResponseLayout& layout,
                                   const InputSignals& inputs) {
  Blocks all;
  for (const FeatureSpec& feature : features) {
    const Blocks blocks =
        std::visit([&](const auto& kind) { return makeBlocks(kind, layout, inputs); }, feature);
    all.insert(all.end(), blocks.begin(), blocks.end());
  }
  *this = FeatureExtractor(std::move(all));
}

bool FeatureExtractor::isLinear() const {
  return std::all_of(blocks_.begin(), blocks_.end(),
                     [](const auto& block) { return block->findMatrix() != nullptr; });
}

FeatureExtractor::FeatureExtractor(Blocks blocks) : blocks_(std::move(blocks)) {
  for (const auto& block : blocks_) {
    infos_.insert(infos_.end(), block->getInfos().begin(), block->getInfos().end());
  }
}

bool FeatureExtractor::hasLinearForm() const {
  return std::any_of(blocks_.begin(), blocks_.end(),
                     [](const auto& block) { return block->findLinearForm() != nullptr; });
}

FeatureExtractor FeatureExtractor::makeLinearForm() const {
  Blocks blocks;
  for (const auto& block : blocks_) {
    const auto linear = block->findLinearForm();
    blocks.push_back(linear ? linear : block);
  }
  return FeatureExtractor(std::move(blocks));
}

Eigen::MatrixXd FeatureExtractor::convertToLinearForm(const Eigen::MatrixXd& features) const {
  Eigen::MatrixXd linear(getFeatureCount(), features.cols());
  const Eigen::Index count = forEachBlock(blocks_, [&](const FeatureBlock& block, const BlockRows& rows) {
    block.convertToLinearForm(features.middleRows(rows.first, rows.count),
                              linear.middleRows(rows.linear_first, rows.linear_count));
  });
  return linear.topRows(count);
}

Eigen::MatrixXd FeatureExtractor::convertFromLinearForm(const Eigen::MatrixXd& linear) const {
  Eigen::MatrixXd features(getFeatureCount(), linear.cols());
  forEachBlock(blocks_, [&](const FeatureBlock& block, const BlockRows& rows) {
    block.convertFromLinearForm(linear.middleRows(rows.linear_first, rows.linear_count),
                                features.middleRows(rows.first, rows.count));
  });
  return features;
}

Eigen::VectorXd FeatureExtractor::placeLinearForm(const Eigen::VectorXd& linear) const {
  Eigen::VectorXd placed = Eigen::VectorXd::Zero(getFeatureCount());
  forEachBlock(blocks_, [&](const FeatureBlock& block, const BlockRows& rows) {
    block.placeLinearForm(linear.segment(rows.linear_first, rows.linear_count),
                          placed.segment(rows.first, rows.count));
  });
  return placed;
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
