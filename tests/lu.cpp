#include "tests/lu.hpp"

#include <Eigen/LU>

namespace twinmap::test {

Eigen::MatrixXd calcInverse(const Eigen::MatrixXd& a) {
  return a.inverse();
}

double calcDeterminant(const Eigen::MatrixXd& a) {
  return a.determinant();
}

}  // namespace twinmap::test
