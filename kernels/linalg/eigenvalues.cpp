#include <Eigen/Eigenvalues>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap::linalg {

Eigen::VectorXcd calcEigenvalues(const Eigen::MatrixXd& a) {
  return a.eigenvalues();
}

}  // namespace twinmap::linalg
