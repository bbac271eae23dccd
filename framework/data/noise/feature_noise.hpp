#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/data/noise/noise.hpp"

namespace twinmap {

/// How the noise of responses propagates into features.
class FeatureNoise {
 public:
  /// `extractor` must outlive the object. stddevs: of the features in their linear form, where a measurement
  /// states them for features themselves (NoiseCovariance::replace); empty: of none.
  FeatureNoise(const FeatureExtractor& extractor, const ResponseNoise& noise, std::uint64_t seed,
               const Eigen::VectorXd& stddevs = {});

  const FeatureExtractor& getExtractor() const { return extractor_; }

  /// That of the features in their linear form (FeatureBlock::findLinearForm), with that extractor; itself
  /// where none has one.
  const FeatureNoise& getLinearForm() const;

  /// Whether the covariance is the same for every response: that of linear features.
  bool isConstant() const { return draws_.cols() == 0; }

  /// Covariance (d x d) of the features of a clean response. Linear features: M C M', C the
  /// covariance of the response's noise, exact. The others by Monte Carlo, with the same noise draws for
  /// every response: their regression on the noise of the linear ones, plus the covariance of what that
  /// leaves, so that the whole stays positive semi-definite and its linear part exact. Features that noise
  /// makes NaN in some draws use the others.
  NoiseCovariance calcCovariance(const Eigen::VectorXd& response) const;

  /// The mean over (at most 32 of) the columns of clean responses without NaN.
  NoiseCovariance calcMeanCovariance(const Eigen::MatrixXd& responses) const;

 private:
  Eigen::MatrixXd calcSampledCovariance(const Eigen::VectorXd& response) const;

  struct LinearForm;

  const FeatureExtractor& extractor_;
  std::shared_ptr<const LinearForm> linear_form_;  // null where no feature has one
  std::vector<Eigen::Index> linear_, nonlinear_;   // features
  NoiseCovariance linear_covariance_;
  Eigen::MatrixXd draws_;  // noise of the response, rows x draws; empty if all features are linear
};

}  // namespace twinmap
