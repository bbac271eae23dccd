#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <random>

#include "kernels/gp/model.hpp"

namespace twinmap::test {

/// Uniform on [-1, 1], the same on every platform.
inline Eigen::MatrixXd randomMatrix(Eigen::Index rows, Eigen::Index cols, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  Eigen::MatrixXd matrix(rows, cols);
  for (Eigen::Index j = 0; j < cols; ++j) {
    for (Eigen::Index i = 0; i < rows; ++i) {
      matrix(i, j) = 2.0 * static_cast<double>(engine() >> 11) * 0x1p-53 - 1.0;
    }
  }
  return matrix;
}

/// A smooth function of the first two features plus noise of the given size.
inline Eigen::VectorXd smoothTarget(const Eigen::MatrixXd& inputs, double noise, std::uint64_t seed) {
  const Eigen::MatrixXd disturbance = randomMatrix(1, inputs.cols(), seed);
  Eigen::VectorXd target(inputs.cols());
  for (Eigen::Index i = 0; i < inputs.cols(); ++i) {
    target(i) = std::sin(2.0 * inputs(0, i)) + inputs(1, i) * inputs(1, i) + noise * disturbance(0, i);
  }
  return target;
}

/// Feature f in group f % count.
inline std::vector<int> cyclicGroups(int features, int count) {
  std::vector<int> groups(features);
  for (int f = 0; f < features; ++f) {
    groups[f] = f % count;
  }
  return groups;
}

}  // namespace twinmap::test
