#include "kernels/gp/leave_one_out.hpp"

#include <cmath>
#include <limits>

#include "kernels/linalg/triangular.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kNormalQuantile975 = 1.959963984540054;

// P's diagonal: the squared column norms of L^-1 less the squared row norms of U = L^-T V R^-T.
VectorXd calcPrecisionDiagonal(const GaussianProcess& process) {
  const Index n = process.getSampleCount();
  linalg::TriangularScratch scratch(n);
  MatrixXd inverse = process.getFactor();
  linalg::invertLower(linalg::viewOf(inverse), scratch);
  VectorXd diagonal = inverse.colwise().squaredNorm();
  if (process.getWhitenedBasis().cols() == 0) return diagonal;
  MatrixXd correction = process.getWhitenedBasis();
  linalg::solveTransposedFromRight(linalg::viewOf(process.getBasisFactor()), linalg::viewOf(correction),
                                   scratch);
  for (Index k = 0; k < correction.cols(); ++k) {
    linalg::solveLowerTransposed(linalg::viewOf(process.getFactor()), correction.col(k).data());
    diagonal -= correction.col(k).cwiseAbs2();
  }
  return diagonal;
}

}  // namespace

LeaveOneOut calcLeaveOneOut(const GaussianProcess& process) {
  // A sample that alone determines a coefficient of the mean has precision 0: its stddev is huge, not NaN.
  const VectorXd precision = calcPrecisionDiagonal(process).cwiseMax(std::numeric_limits<double>::min());
  LeaveOneOut result;
  result.residual = process.getAlpha().cwiseQuotient(precision);
  result.stddev = precision.cwiseSqrt().cwiseInverse();
  const Eigen::ArrayXd standardised = process.getAlpha().array() / precision.array().sqrt();
  result.log_density = -0.5 * (standardised.square() - precision.array().log() + kLogTwoPi);
  result.total_log_density = result.log_density.sum();
  const double covered = (standardised.abs() <= kNormalQuantile975).cast<double>().sum();
  result.coverage95 = covered / static_cast<double>(process.getSampleCount());
  result.root_mean_square = std::sqrt(result.residual.squaredNorm() / double(process.getSampleCount()));
  return result;
}

}  // namespace twinmap::gp
