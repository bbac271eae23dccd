#pragma once

#include "kernels/linalg/gemm.hpp"
#include "kernels/linalg/view.hpp"

namespace twinmap::linalg {

/// Buffers of one thread's blocked factorisations of matrices up to `size`; nothing below allocates.
class TriangularScratch {
 public:
  explicit TriangularScratch(Index size);
  GemmScratch& gemm() { return gemm_; }
  /// rows x cols of scratch, one of them at most 64 and the other at most `size`.
  View block(Index rows, Index cols);

 private:
  GemmScratch gemm_;
  Eigen::VectorXd block_;
};

/// Factorises the symmetric positive definite a = L L' in place; reads and writes the lower triangle (what
/// lies above the diagonal is overwritten with finite rubbish). False if a pivot is not positive and finite:
/// a is then destroyed. Cost: n^3 / 3 flops.
[[nodiscard]] bool factorize_cholesky(View a, TriangularScratch& scratch);

/// b = b L^-T for lower triangular L (n x n) and b (m x n). Cost: m n^2 flops.
void solve_transposed_from_right(ConstView lower, View b, TriangularScratch& scratch);

/// x = L^-1 x for one vector. Cost: n^2 flops.
void solve_lower(ConstView lower, double* x);

/// x = L^-T x for one vector. Cost: n^2 flops.
void solve_lower_transposed(ConstView lower, double* x);

/// Replaces the lower triangular L by its inverse, and what lies above the diagonal by zeros.
/// Cost: n^3 / 3 flops.
void invert_lower(View lower, TriangularScratch& scratch);

/// Replaces the lower triangular M (zeros above) by the lower triangle of M' M. With M = L^-1 this is the
/// inverse of L L'. Cost: n^3 / 3 flops.
void multiply_transposed_by_self(View lower, TriangularScratch& scratch);

}  // namespace twinmap::linalg
