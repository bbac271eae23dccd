#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/data/features/feature_block.hpp"
#include "framework/data/features/noise_covariance.hpp"

namespace twinmap {

/// One matrix above the other; one without rows may have any number of columns.
inline Eigen::MatrixXd stackRows(const Eigen::MatrixXd& top, const Eigen::MatrixXd& bottom) {
  if (bottom.rows() == 0) {
    return top;
  }
  Eigen::MatrixXd stacked(top.rows() + bottom.rows(), bottom.cols());
  stacked.topRows(top.rows()) = top;
  stacked.bottomRows(bottom.rows()) = bottom;
  return stacked;
}

/// Features of samples whose parameters are known, one column a sample; several draws of the noise
/// (replicates) stand draw by draw.
struct LabelledFeatures {
  std::vector<FeatureInfo> infos;    ///< d
  Eigen::MatrixXd features;          ///< d x n, noisy
  Eigen::MatrixXd parameters;        ///< p x n, updating
  NoiseCovariance noise_covariance;  ///< d x d, of the features; where it differs among samples, its mean
  int replicates = 1;
  /// Sensitivities of the features to the unknown parameters (d x u each: updating, then nuisance) at some
  /// points of the box, in features per width of the parameters' bounds; only where a selection by
  /// information needs them.
  std::vector<Eigen::MatrixXd> sensitivities;
  Eigen::MatrixXd nuisance{};           ///< u - p x n, parameters that are not inferred; may be empty
  Eigen::MatrixXd inputs{};             ///< q x n, known; may be empty
  Eigen::MatrixXd prior_information{};  ///< u x u, per width, mean over the samples; empty: uniform

  Eigen::MatrixXd collectUnknown() const { return stackRows(parameters, nuisance); }  ///< u x n
  Eigen::MatrixXd collectPoints() const { return stackRows(collectUnknown(), inputs); }
};

}  // namespace twinmap
