#include <Eigen/Eigenvalues>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap::linalg {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Solver = Eigen::SelfAdjointEigenSolver<MatrixXd>;

SymmetricEigen calcSymmetricEigen(const MatrixXd& a) {
  const Solver solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

VectorXd calcSymmetricEigenvalues(const MatrixXd& a) {
  return Solver(a, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace twinmap::linalg
