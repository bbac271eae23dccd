#include "framework/estimation/bounded_information.hpp"

#include <algorithm>

#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

MatrixXd scale(const MatrixXd& jacobian, const VectorXd& half_widths) {
  const MatrixXd scaled = jacobian * half_widths.asDiagonal();
  return scaled.transpose() * scaled;
}

}  // namespace

BoundedInformation::BoundedInformation(const MatrixXd& measured)
    : measured_(measured), lower_(linalg::calcCholesky(addBounds(measured)).lower) {}

BoundedInformation::BoundedInformation(const MatrixXd& jacobian, const VectorXd& half_widths)
    : BoundedInformation(scale(jacobian, half_widths)) {}

MatrixXd BoundedInformation::solve(const MatrixXd& b) const {
  return linalg::solveCholesky(lower_, b);
}

MatrixXd BoundedInformation::calcCovariance() const {
  return solve(MatrixXd::Identity(lower_.rows(), lower_.cols()));
}

double BoundedInformation::calcLogDeterminant() const {
  return 2.0 * lower_.diagonal().array().log().sum();
}

double calcDegrees(Eigen::Index residuals, const BoundedInformation& information) {
  return std::max(1.0, static_cast<double>(residuals) - information.countDetermined());
}

MatrixXd addBounds(MatrixXd information) {
  information.diagonal().array() += kHalfWidthInformation;
  return information;
}

}  // namespace twinmap
