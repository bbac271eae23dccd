#include "framework/inference/measurement/spikes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

double calcCubic(const VectorXd& samples, Index i) {
  return (4.0 * (samples[i - 1] + samples[i + 1]) - samples[i - 2] - samples[i + 2]) / 6.0;
}

/// Heights above the cubic; 0 where a neighbour is missing.
VectorXd calcHeights(const VectorXd& samples) {
  VectorXd heights = VectorXd::Zero(samples.size());
  for (Index i = 2; i + 2 < samples.size(); ++i) {
    const double height = samples[i] - calcCubic(samples, i);
    heights[i] = std::isfinite(height) ? height : 0.0;
  }
  return heights;
}

double calcMedianSize(const VectorXd& heights) {
  std::vector<double> sizes;
  for (const double height : heights) {
    if (height != 0.0) {
      sizes.push_back(std::abs(height));
    }
  }
  return calcMedian(std::move(sizes));
}

/// Of one output; rows count from its first.
std::vector<SpikedSample> findSpikesOf(VectorXd samples) {
  constexpr double kStandsOut = 10.0;
  std::vector<SpikedSample> spikes;
  const double least = kStandsOut * calcMedianSize(calcHeights(samples));
  for (Index i = 0; i < samples.size() && least > 0.0; ++i) {
    const VectorXd heights = calcHeights(samples);
    Index at = 0;
    if (heights.cwiseAbs().maxCoeff(&at) <= least) {
      break;
    }
    if (static_cast<Index>(spikes.size()) >= std::max<Index>(3, samples.size() / 50)) {
      return {};
    }
    const auto known = std::find_if(spikes.begin(), spikes.end(),
                                    [at](const SpikedSample& spike) { return spike.row == at; });
    if (known == spikes.end()) {
      spikes.push_back({at, heights[at]});
    } else {
      known->height += heights[at];  // one beside it had moved what its neighbours say
    }
    samples[at] -= heights[at];
  }
  spikes.erase(std::remove_if(spikes.begin(), spikes.end(),
                              [least](const SpikedSample& spike) { return std::abs(spike.height) <= least; }),
               spikes.end());  // what one beside them had made of them, until it was corrected
  return spikes;
}

}  // namespace

std::vector<SpikedSample> findSpikes(const VectorXd& measured, const ResponseLayout& layout) {
  std::vector<SpikedSample> all;
  for (Index output = 0; output < layout.getOutputCount(); ++output) {
    const Index first = layout.getRow(output, 0);
    for (const SpikedSample& spike : findSpikesOf(measured.segment(first, layout.times.size()))) {
      all.push_back({first + spike.row, spike.height});
    }
  }
  return all;
}

SpikedFeatures findSpikedFeatures(const VectorXd& measured, const ResponseLayout& layout,
                                  const std::vector<FeatureInfo>& infos) {
  SpikedFeatures found;
  for (const SpikedSample& spike : findSpikes(measured, layout)) {
    for (std::size_t i = 0; i < infos.size(); ++i) {
      const FeatureInfo& info = infos[i];
      if (!info.isSample()) {
        continue;
      }
      const Index time = spike.row - layout.getRow(info.output, 0);
      if (time >= 0 && time < layout.times.size() && layout.times[time] == info.time) {
        found.features.push_back(static_cast<Index>(i));
        found.rows.push_back(spike.row);
        found.said.push_back(fmt::format("{} (off by {} {})", info.name, toShortText(spike.height, 3),
                                         layout.output_units[static_cast<std::size_t>(info.output)]));
      }
    }
  }
  return found;
}

}  // namespace twinmap
