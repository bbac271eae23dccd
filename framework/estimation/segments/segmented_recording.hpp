#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/data/noise/noise_whitener.hpp"
#include "framework/experiment/model/parameter_spec.hpp"

namespace twinmap {

/// A recording cut into segments of equal length, each of which starts at a state of its own. Segments are
/// simulated at points [parameters u; state s; known inputs q; the segment's start in the recording].
struct SegmentedRecording {
  std::vector<ParameterSpec> unknown;    ///< u, the same in all segments
  Eigen::VectorXd known;                 ///< q
  FeatureExtractor extractor;            ///< of a segment's samples, linear in the response
  std::vector<NoiseWhitener> whiteners;  ///< of each segment, or one of all
  std::vector<Eigen::Index> order;       ///< whitened rows, in the order of time
  Eigen::MatrixXd features;              ///< d x S, NaN where missing
  Eigen::VectorXd starts;                ///< S, s
  Eigen::MatrixXd states;                ///< s x S, about where they are
  Eigen::VectorXd scales;                ///< s, how far a state may be from there

  const NoiseWhitener& getWhitener(Eigen::Index segment) const {
    return whiteners.size() == 1 ? whiteners.front() : whiteners[static_cast<std::size_t>(segment)];
  }
};

/// What is known of a state beside the samples: so many scales are its standard deviation. A state that the
/// samples do not tell stays where it is; one that they tell is not moved by more than a hundredth of its own
/// standard deviation unless that is above 1.4 scales.
constexpr double kStateScales = 10.0;

}  // namespace twinmap
