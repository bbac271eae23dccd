#pragma once

#include <optional>
#include <vector>

#include "framework/inference/posterior_estimate.hpp"
#include "framework/inference/segments/segment_states.hpp"

namespace twinmap {

/// What a recording in segments is inferred from: its experiment and samples, as they are supposed to be.
struct SupposedSegments {
  ExperimentSpec experiment;            ///< of the whole recording
  SegmentSamples samples;               ///< NaN where missing
  std::vector<std::string> outliers{};  ///< that were left out
  std::vector<NoiseReport> noise{};     ///< other than stated; an offset is filled in by takeOffsets()
};

/// How it was fitted: the residual, which the states at the starts are eliminated from, with its samples.
struct SegmentResidual {
  const Eigen::VectorXd& residual;
  const std::vector<FeatureInfo>& infos;
  const ResponseLayout& layout;  ///< of a segment
};

/// Without the spikes of each segment (findSpikes); none where there are none.
std::optional<SupposedSegments> leaveSpikes(const SupposedSegments& from, const ResponseLayout& layout,
                                            const Eigen::VectorXd& starts);

/// What else than stated the noise may be, the simplest first, as listNoiseHypotheses() has it of others. It
/// is of another size, or sensors have an offset each, a nuisance parameter. Or it has the colour of the
/// residual (fitAutoregression): where no samples are missing and it is at most as large as stated.
std::vector<SupposedSegments> supposeNoise(const SupposedSegments& from, const SegmentResidual& fitted);

/// The reports of offsets that were supposed, from the draws: they are taken off the nuisance parameters.
/// Those within 3.3 of their standard deviations are no offsets; false where nothing else was supposed.
bool takeOffsets(PosteriorEstimate& estimate, SupposedSegments& supposed);

}  // namespace twinmap
