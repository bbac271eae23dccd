#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace twinmap {

/// An autocorrelation that noise may have, and what it counts among others.
struct NoiseColour {
  Eigen::VectorXd autoregression;  ///< a_1 .. a_p, stationary
  double log_weight = 0.0;
};

/// What is supposed of the noise of one output's samples in time, but for what the experiment states.
struct OutputNoise {
  int output = -1;
  /// Its size over the one that is stated. None: not known; it is integrated out under a prior that is
  /// uniform in its logarithm (Jeffreys).
  std::optional<double> factor = 1.0;
  bool has_offset = false;             ///< a constant, integrated out under a uniform prior
  std::vector<NoiseColour> colours{};  ///< integrated over; none: as stated
};

/// A feature of which a measurement says that it is at its measured value or beyond: a sensor clips.
struct CensoredFeature {
  Eigen::Index feature = 0;  ///< of those that are fitted
  double side = 1.0;         ///< 1: at or above, -1: at or below
};

/// How the residuals of one measurement count. Default: normal noise as it is stated.
struct NoiseHypothesis {
  /// A hundredth of the samples may be anything; not of outputs that have an offset or colours.
  bool has_outliers = false;
  std::vector<OutputNoise> outputs{};  ///< those of which something else than stated is supposed

  /// Of noise as it is stated, or of the factor that is given; left out where the size is not known.
  std::vector<CensoredFeature> censored{};

  bool isPlain() const { return !has_outliers && outputs.empty() && censored.empty(); }
};

/// What was found of an output's noise.
struct FoundNoise {
  int output = -1;
  double factor = 1.0;  ///< size over that stated
  bool size_was_inferred = false;
  double effective_samples = 0.0;  ///< independent ones that would know the size as well
  bool has_offset = false;
  double offset = 0.0, offset_stddev = 0.0;  ///< in the output's unit
  Eigen::VectorXd autoregression{};          ///< of what is not white
};

}  // namespace twinmap
