#pragma once

#include <Eigen/Core>

namespace twinmap {

/// What measurements say of u coordinates in half-widths of their bounds, J'J, with the bounds beside it as a
/// normal distribution of their variance (information 3 each), so that what is not measured keeps the width
/// of its bounds: J'J + 3 by its Cholesky factor. Immutable. Cost: u^3 / 3 flops, each solution 2 u^2.
class BoundedInformation {
 public:
  /// measured: J'J (u x u), of which the lower triangle is read.
  explicit BoundedInformation(const Eigen::MatrixXd& measured);
  /// Of derivatives per unit (n x u) of parameters with these half-widths (u).
  BoundedInformation(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& half_widths);

  const Eigen::MatrixXd& getLower() const { return lower_; }  ///< the factor, u x u
  /// (J'J + 3)^-1 b, of u x m.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  Eigen::MatrixXd calcCovariance() const;  ///< u x u, in half-widths
  double calcLogDeterminant() const;
  /// How many of the coordinates the measurements determine, not the bounds: trace of J'J (J'J + 3)^-1.
  double countDetermined() const { return calcCovariance().cwiseProduct(measured_).sum(); }

 private:
  Eigen::MatrixXd measured_, lower_;
};

/// Residuals less the coordinates that they determine, at least one.
double calcDegrees(Eigen::Index residuals, const BoundedInformation& information);

/// `information` with that of the bounds.
Eigen::MatrixXd addBounds(Eigen::MatrixXd information);

}  // namespace twinmap
