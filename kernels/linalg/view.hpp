#pragma once

#include <Eigen/Core>

namespace twinmap::linalg {

using Index = Eigen::Index;

/// A read-only window on a dense matrix: element (i, j) lies at data[i * row_stride + j * col_stride].
/// Transposing swaps the strides and moves nothing.
struct ConstView {
  const double* data = nullptr;
  Index rows = 0;
  Index cols = 0;
  Index row_stride = 1;
  Index col_stride = 0;

  ConstView block(Index row, Index col, Index block_rows, Index block_cols) const {
    return {data + row * row_stride + col * col_stride, block_rows, block_cols, row_stride, col_stride};
  }
  ConstView transposed() const { return {data, cols, rows, col_stride, row_stride}; }
  double operator()(Index row, Index col) const { return data[row * row_stride + col * col_stride]; }
};

/// A writable window on a column-major matrix with leading dimension `stride`.
struct View {
  double* data = nullptr;
  Index rows = 0;
  Index cols = 0;
  Index stride = 0;

  View block(Index row, Index col, Index block_rows, Index block_cols) const {
    return {data + row + col * stride, block_rows, block_cols, stride};
  }
  double& operator()(Index row, Index col) const { return data[row + col * stride]; }
  double* col(Index j) const { return data + j * stride; }
  operator ConstView() const { return {data, rows, cols, 1, stride}; }
  ConstView transposed() const { return ConstView(*this).transposed(); }
};

inline View viewOf(Eigen::MatrixXd& matrix) {
  return {matrix.data(), matrix.rows(), matrix.cols(), matrix.rows()};
}
inline ConstView viewOf(const Eigen::MatrixXd& matrix) {
  return {matrix.data(), matrix.rows(), matrix.cols(), 1, matrix.rows()};
}

/// Doubles per cache line: columns padded to a multiple of it all start on the same alignment, so that a
/// vectorised pass treats them alike and its result does not depend on where the matrix lies.
constexpr Index kColumnPadding = 8;
constexpr Index padded(Index rows) {
  return (rows + kColumnPadding - 1) / kColumnPadding * kColumnPadding;
}

}  // namespace twinmap::linalg
