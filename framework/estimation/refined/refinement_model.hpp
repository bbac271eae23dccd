#pragma once

#include <optional>
#include <vector>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/data/noise/feature_noise.hpp"
#include "framework/data/noise/noise_whitener.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// Features up to a time, and their whitening where their noise is the same for every response.
struct GrowingWindow {
  std::vector<Eigen::Index> features;     ///< rows
  std::optional<NoiseWhitener> whitener;  ///< none where the noise depends on the response
};

/// What refinements of one experiment share. Immutable, for any number of threads.
class RefinementModel {
 public:
  /// `unknown`: collectUnknown(); extractor and noise must outlive the object. Throws std::invalid_argument
  /// for a feature without noise.
  RefinementModel(std::vector<ParameterSpec> unknown, const FeatureExtractor& extractor,
                  const FeatureNoise& noise);
  /// Of some features alone (their numbers, ascending), where a measurement lacks the others.
  RefinementModel(std::vector<ParameterSpec> unknown, const FeatureExtractor& extractor,
                  const FeatureNoise& noise, const std::vector<Eigen::Index>& available);

  const std::vector<ParameterSpec>& getUnknown() const { return unknown_; }
  const FeatureExtractor& getExtractor() const { return extractor_; }

  /// Windows that grow: the samples of the first eighth, quarter and half of the time that samples take,
  /// where these are more than the unknown parameters; the last is all features.
  const std::vector<GrowingWindow>& getWindows() const { return windows_; }
  const GrowingWindow& getWhole() const { return windows_.back(); }

  /// The whitener of a window's features for a response.
  NoiseWhitener makeWhitener(const GrowingWindow& window, const Eigen::VectorXd& response) const;

 private:
  void addWindow(std::vector<Eigen::Index> features);

  const std::vector<ParameterSpec> unknown_;
  const FeatureExtractor& extractor_;
  const FeatureNoise& noise_;
  std::vector<GrowingWindow> windows_;
};

}  // namespace twinmap
