#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/data/reduction/feature_transform.hpp"
#include "framework/estimation/estimate.hpp"
#include "framework/estimation/gp/noise_profile.hpp"
#include "framework/estimation/known_inputs.hpp"
#include "kernels/gp/online/process_view.hpp"

namespace twinmap {

/// An inverse map: features and known inputs -> parameters with standard deviation, by one Gaussian process
/// per parameter on the standardised parameter (p - offset) / scale. The inputs of the processes are the
/// transformed features, then the scaled known inputs. A fitted, immutable value.
struct GpMap {
  FeatureTransform transform;
  Eigen::VectorXd target_offset;       ///< p, mean of the training parameters
  Eigen::VectorXd target_scale;        ///< p, their standard deviation
  std::vector<gp::Process> processes;  ///< one per parameter; exact ones share their training inputs
  /// R (p x p), of the errors among the parameters, estimated from the training samples left out
  /// (calcResidualCorrelation): the joint predictive covariance of a sample is D R D, D = diag(stddev).
  Eigen::MatrixXd residual_correlation;
  NoiseProfile noise;
  KnownInputs known_inputs;

  /// What the processes see of features (d x m, untransformed) and known inputs (q x m): k + q x m.
  Eigen::MatrixXd makeProcessInputs(const Eigen::MatrixXd& features, const Eigen::MatrixXd& inputs) const;

  /// Features (d x m, untransformed) and known inputs (q x m, an empty matrix where there are none, else
  /// std::invalid_argument) -> predictions (p x m each). The standard deviation is the predictive one, noise
  /// included: the spread of the parameter given the features.
  Estimates predict(const Eigen::MatrixXd& features, const Eigen::MatrixXd& inputs = {}) const;
};

}  // namespace twinmap
