#include <Eigen/Cholesky>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap::linalg {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Cholesky calcCholesky(const MatrixXd& a) {
  const Eigen::LLT<MatrixXd> factor(a);
  // Eigen takes a pivot that is not a number for a positive one
  const bool positive_definite = factor.info() == Eigen::Success && factor.matrixLLT().diagonal().allFinite();
  return {factor.matrixL(), positive_definite, positive_definite ? factor.rcond() : 0.0};
}

MatrixXd solveLower(const MatrixXd& lower, const MatrixXd& b) {
  return lower.triangularView<Eigen::Lower>().solve(b);
}

MatrixXd solveCholesky(const MatrixXd& lower, const MatrixXd& b) {
  MatrixXd x = solveLower(lower, b);
  lower.transpose().triangularView<Eigen::Upper>().solveInPlace(x);
  return x;
}

MatrixXd invertPositiveDefinite(const MatrixXd& a) {
  return solveCholesky(calcCholesky(a).lower, MatrixXd::Identity(a.rows(), a.cols()));
}

VectorXd solvePositiveDefinite(const MatrixXd& a, const VectorXd& b) {
  return a.llt().solve(b);
}

MatrixXd solveSemidefinite(const MatrixXd& a, const MatrixXd& b) {
  return a.ldlt().solve(b);
}

}  // namespace twinmap::linalg
