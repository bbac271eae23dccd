#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kernels/linalg/view.hpp"

namespace twinmap::linalg {

/// The nearest numbers of 21 significant bits, the upper halves of doubles: within 4.8e-7 of their size.
Eigen::MatrixXd roundToHalves(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

/// A matrix of numbers of 21 significant bits, of which each double's place holds two. A product with a
/// vector is calculated in double; where the matrix lies beyond the first cache it takes half of the time,
/// which is that of reading it. (Numbers of single precision are read as fast, but to convert them takes as
/// long as to read doubles.)
class PairedMatrix {
 public:
  /// The numbers are rounded (roundToHalves).
  explicit PairedMatrix(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

  Index rows() const { return rows_; }
  Index cols() const { return cols_; }

  /// product (rows) = matrix vector (cols). Does not allocate. Cost: 2 rows cols flops; reads 4 rows cols
  /// bytes.
  void multiply(const double* vector, double* product) const;

 private:
  template <int kPackets>
  void multiplyBlock(Index first, const double* vector, double* product) const;

  Index rows_, cols_;
  // blocks of rows below each other, each column by column; aligned, as a read across two cache lines is two
  std::vector<std::uint64_t, Eigen::aligned_allocator<std::uint64_t>> pairs_;
};

}  // namespace twinmap::linalg
