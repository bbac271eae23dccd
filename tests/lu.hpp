#pragma once

#include <Eigen/Core>

namespace twinmap::test {

/// A^-1 and det A of a square matrix by LU factors, oracles of whatever avoids both. Compiled once for all
/// tests.
Eigen::MatrixXd calcInverse(const Eigen::MatrixXd& a);
double calcDeterminant(const Eigen::MatrixXd& a);

}  // namespace twinmap::test
