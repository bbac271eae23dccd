#pragma once

#include <vector>

#include "kernels/linalg/gemm.hpp"
#include "kernels/linalg/view.hpp"

namespace twinmap::linalg {

/// Buffers of blocked factorisations of matrices up to `size`, and the team of threads that shares their
/// products; nothing below allocates. Every element of a product is summed in an order that depends on the
/// sizes only, so the number of threads changes no bit of a result.
class TriangularScratch {
 public:
  explicit TriangularScratch(Index size, int threads = 1);
  GemmScratch& gemm(int thread = 0) { return gemm_[thread]; }
  int threads() const { return static_cast<int>(gemm_.size()); }

  /// gemm(alpha, a, b, beta, c), by the whole team where it is large enough to be worth it.
  void multiply(double alpha, ConstView a, ConstView b, double beta, View c, Part part = Part::kAll);

  /// rows x cols of scratch, one of them at most 64 and the other at most `size`.
  View block(Index rows, Index cols);

 private:
  std::vector<GemmScratch> gemm_;  // one per thread
  Eigen::VectorXd block_;
};

/// Factorises the symmetric positive definite a = L L' in place; reads and writes the lower triangle (what
/// lies above the diagonal is overwritten with unspecified finite values). False if a pivot is not positive
/// and finite: a is then destroyed. Cost: n^3 / 3 flops.
[[nodiscard]] bool factorizeCholesky(View a, TriangularScratch& scratch);

/// b = b L^-T for lower triangular L (n x n) and b (m x n). Cost: m n^2 flops.
void solveTransposedFromRight(ConstView lower, View b, TriangularScratch& scratch);

/// x = L^-1 x for one vector. Cost: n^2 flops.
void solveLower(ConstView lower, double* x);

/// x = L^-T x for one vector. Cost: n^2 flops.
void solveLowerTransposed(ConstView lower, double* x);

/// Replaces the lower triangular L by its inverse, and what lies above the diagonal by zeros.
/// Cost: n^3 / 3 flops.
void invertLower(View lower, TriangularScratch& scratch);

/// Replaces the lower triangular M (zeros above) by the lower triangle of M' M. With M = L^-1 this is the
/// inverse of L L'. Cost: n^3 / 3 flops.
void multiplyTransposedBySelf(View lower, TriangularScratch& scratch);

}  // namespace twinmap::linalg
