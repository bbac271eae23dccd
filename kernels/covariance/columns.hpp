#pragma once

#include <algorithm>

#include "kernels/covariance/radial.hpp"
#include "kernels/linalg/view.hpp"

namespace twinmap::gp {

/// The first row of the cache line that holds row j.
inline Eigen::Index first_of_line(Eigen::Index j) {
  return j / linalg::kColumnPadding * linalg::kColumnPadding;
}

/// Column j of a lower triangular matrix, from the cache line of its diagonal element to its padded end.
inline AlignedColumn lower_column(linalg::View matrix, Eigen::Index j) {
  const Eigen::Index first = first_of_line(j);
  return AlignedColumn(matrix.col(j) + first, linalg::padded(matrix.rows) - first);
}

inline ConstAlignedColumn lower_column(const Eigen::MatrixXd& matrix, Eigen::Index j) {
  const Eigen::Index first = first_of_line(j);
  return ConstAlignedColumn(matrix.data() + j * matrix.rows() + first, matrix.rows() - first);
}

/// Zeroes what lower_column(matrix, j) holds outside the strict lower triangle.
inline void clear_outside_strict_lower(linalg::View matrix, Eigen::Index j) {
  const Eigen::Index first = first_of_line(j);
  std::fill(matrix.col(j) + first, matrix.col(j) + j + 1, 0.0);
  std::fill(matrix.col(j) + matrix.rows, matrix.col(j) + linalg::padded(matrix.rows), 0.0);
}

}  // namespace twinmap::gp
