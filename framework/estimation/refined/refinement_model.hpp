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
  /// `unknown`: collectUnknown(); extractor and noise must outlive the object. Features are fitted in their
  /// linear form where they have one: the noise of magnitude, cosine and sine of a phase has two degrees of
  /// freedom for three numbers, so that no covariance describes it but next to one response, and the misfit
  /// in them is a narrow bent valley. Throws std::invalid_argument for a feature without noise.
  RefinementModel(std::vector<ParameterSpec> unknown, const FeatureExtractor& extractor,
                  const FeatureNoise& noise);

  const std::vector<ParameterSpec>& getUnknown() const { return unknown_; }
  /// Of the features that are fitted, d'.
  const FeatureExtractor& getExtractor() const { return noise_.getExtractor(); }
  /// From the experiment's features (d) to those that are fitted.
  Eigen::VectorXd convert(const Eigen::VectorXd& features) const {
    return features_.convertToLinearForm(features);
  }
  /// A whitened residual of all that are fitted, in the places of the experiment's features (d), 0 in those
  /// left over; as it is where their noise is singular, so that there are fewer.
  Eigen::VectorXd placeResidual(const Eigen::VectorXd& residual) const;

  /// Windows that grow: the samples of the first eighth, quarter and half of the time that samples take,
  /// where these are more than the unknown parameters; the last is all features.
  const std::vector<GrowingWindow>& getWindows() const { return windows_; }
  const GrowingWindow& getWhole() const { return windows_.back(); }

  /// The whitener of a window's features for a response.
  NoiseWhitener makeWhitener(const GrowingWindow& window, const Eigen::VectorXd& response) const;

 private:
  void addWindow(std::vector<Eigen::Index> features);

  const std::vector<ParameterSpec> unknown_;
  const FeatureExtractor& features_;  // of the experiment
  const FeatureNoise& noise_;         // of the features that are fitted
  std::vector<GrowingWindow> windows_;
};

}  // namespace twinmap
