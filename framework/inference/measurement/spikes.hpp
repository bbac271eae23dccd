#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/data/features/feature_block.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// A sample of an output that its neighbours contradict.
struct SpikedSample {
  Eigen::Index row = 0;  ///< of the response
  double height = 0.0;   ///< above the cubic through the two samples on either side
};

/// The spikes of a measured response (rows of the layout, NaN where missing), of evenly spaced samples, the
/// highest of each output first: heights of more than ten times the median one, which of normal noise is none
/// in a billion. None of an output where they are more than three and more than a fiftieth of its
/// samples: that is what it measures. O(samples * spikes).
std::vector<SpikedSample> findSpikes(const Eigen::VectorXd& measured, const ResponseLayout& layout);

/// The features that are these samples (their numbers), their rows, and what is said of each, "x(1.6 s) (off
/// by 0.3 m)".
struct SpikedFeatures {
  std::vector<Eigen::Index> features, rows;
  std::vector<std::string> said;
};
SpikedFeatures findSpikedFeatures(const Eigen::VectorXd& measured, const ResponseLayout& layout,
                                  const std::vector<FeatureInfo>& infos);

}  // namespace twinmap
