#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// What the integration does to the features of one point, in units of independent noise of variance 1.
struct FeatureError {
  Eigen::VectorXd error;          ///< k
  Eigen::MatrixXd sensitivities;  ///< k x u, per width of the bounds, those of the updating parameters first
};

/// What the errors of the integration do to an estimate, beside what the noise does: the largest over points.
struct IntegrationError {
  /// An estimate moves by at most so many of its standard deviations at the information limit. An error far
  /// below the noise can move it far if it is coherent: .1 noise sd in each of 200 samples by 1.4.
  double shift = 0.0;
  Eigen::Index parameter = 0;  ///< the one that moves most
  double rise = 0.0;           ///< of chi-square, in its standard deviations: |error|^2 / sqrt(2 k)

  /// How many powers of ten the error is above a tenth, below which either adds less than 0.5 % to what noise
  /// scatters; at most 0 where it is negligible.
  double calcDecades() const;
  bool isNegligible() const { return calcDecades() <= 0.0; }
};

/// What needs no sensitivities: an estimate moves by no more than the length of the error.
IntegrationError boundIntegrationError(const std::vector<FeatureError>& points);

/// With J the sensitivities and e the error of a point, the estimate moves by (J'J + 12)^-1 J'e, the box as
/// in the information limit (fisher_information.hpp). count: of the updating parameters.
IntegrationError calcIntegrationError(const std::vector<FeatureError>& points, Eigen::Index count);

}  // namespace twinmap
