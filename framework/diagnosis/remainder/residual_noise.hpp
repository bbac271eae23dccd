#pragma once

#include <string>
#include <vector>

#include "framework/data/features/feature_block.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

bool hasUnknownNoise(const NoiseSpec& noise);

/// The outputs whose noise has no size yet.
std::vector<std::string> listUnknownNoise(const NoiseSpec& noise);

/// Throws ExperimentError where it has, as nobody knows then what `question` asks.
void requireKnownNoise(const ExperimentSpec& experiment, const std::string& question);

/// A fit's residual, whitened with the noise that `used` says.
struct WhitenedResidual {
  const NoiseSpec& used;
  const Eigen::VectorXd& residual;
  double degrees = 0.0;                   ///< of freedom
  const std::vector<FeatureInfo>& infos;  ///< of each; outputs are counted on over recordings
};

/// Noise whose unknown sizes are those of the residual, which what the model lacks makes larger. outputs: the
/// name of each output that the infos number.
NoiseSpec sizeNoise(const NoiseSpec& stated, const WhitenedResidual& fit,
                    const std::vector<std::string>& outputs);

/// "0.0002 (x), 0.01 (y)": the sizes that `sized` gives to what is unknown in `stated`.
std::string describeSizes(const NoiseSpec& stated, const NoiseSpec& sized);

/// Which one is smallest, by the product of its outputs' sizes. All of the same outputs.
std::size_t findLeastNoise(const std::vector<NoiseSpec>& sized);

/// The noise of `from`, in all trials.
void copyNoise(const ExperimentSpec& from, ExperimentSpec& to);

}  // namespace twinmap
