#include <Eigen/LU>
#include <Eigen/QR>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap::linalg {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Orthogonal = Eigen::CompleteOrthogonalDecomposition<MatrixXd>;

VectorXd solveLinear(const MatrixXd& a, const VectorXd& b) {
  return a.partialPivLu().solve(b);
}

LogDeterminant calcLogDeterminant(const MatrixXd& a) {
  const Eigen::PartialPivLU<MatrixXd> factors(a);
  const VectorXd diagonal = factors.matrixLU().diagonal();
  return {diagonal.array().abs().log().sum(),
          static_cast<double>(factors.permutationP().determinant()) * diagonal.array().sign().prod()};
}

LinearFit fitLinear(const MatrixXd& a, const MatrixXd& b) {
  const Orthogonal decomposition(a);
  return {decomposition.solve(b), decomposition.rank()};
}

VectorXd solveMinimumNorm(const MatrixXd& a, const VectorXd& b) {
  return a.size() == 0 ? VectorXd::Zero(a.cols()) : VectorXd(Orthogonal(a).solve(b));
}

MatrixXd calcOrthonormalBasis(const MatrixXd& a) {
  return Eigen::HouseholderQR<MatrixXd>(a).householderQ();
}

}  // namespace twinmap::linalg
