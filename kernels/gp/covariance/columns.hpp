#pragma once

#include <algorithm>

#include "kernels/gp/covariance/radial.hpp"
#include "kernels/linalg/view.hpp"

namespace twinmap::gp {

/// The first row of the cache line that holds row j.
inline Eigen::Index firstOfLine(Eigen::Index j) {
  return j / linalg::kColumnPadding * linalg::kColumnPadding;
}

/// Column j of a lower triangular matrix, from the cache line of its diagonal element to its padded end.
inline AlignedColumn lowerColumn(linalg::View matrix, Eigen::Index j) {
  const Eigen::Index first = firstOfLine(j);
  return AlignedColumn(matrix.col(j) + first, linalg::padded(matrix.rows) - first);
}

inline ConstAlignedColumn lowerColumn(const Eigen::MatrixXd& matrix, Eigen::Index j) {
  const Eigen::Index first = firstOfLine(j);
  return ConstAlignedColumn(matrix.data() + j * matrix.rows() + first, matrix.rows() - first);
}

/// Zeroes what lowerColumn(matrix, j) holds outside the strict lower triangle.
inline void clearOutsideStrictLower(linalg::View matrix, Eigen::Index j) {
  const Eigen::Index first = firstOfLine(j);
  std::fill(matrix.col(j) + first, matrix.col(j) + j + 1, 0.0);
  std::fill(matrix.col(j) + matrix.rows, matrix.col(j) + linalg::padded(matrix.rows), 0.0);
}

}  // namespace twinmap::gp
