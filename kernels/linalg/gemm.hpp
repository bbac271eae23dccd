#pragma once

#include <Eigen/Core>

#include "kernels/linalg/view.hpp"

namespace twinmap::linalg {

/// Packing buffers of one thread's matrix products; allocated once, so that no product allocates.
class GemmScratch {
 public:
  GemmScratch();
  double* left() { return left_.data(); }
  double* right() { return right_.data(); }

 private:
  Eigen::VectorXd left_;
  Eigen::VectorXd right_;
};

/// Which elements of the result a product computes. kLower skips the register tiles that lie wholly above the
/// diagonal; elements above it in the tiles that touch it are overwritten with unspecified finite values.
enum class Part { kAll, kLower };

/// C = beta C + alpha A B, with A m x k, B k x n and beta 0 or 1 (at 0, C is not read). Transposed operands
/// are views with swapped strides.
///
/// Eigen's product is as fast, but it allocates for blocks above 128 KiB, chooses its blocking by the OpenMP
/// thread count and cannot skip the upper triangle of A B. Here the order of every sum depends on the sizes
/// only. Cost: 2 m n k flops (half with kLower). C must not overlap A or B.
void gemm(double alpha, ConstView a, ConstView b, double beta, View c, GemmScratch& scratch,
          Part part = Part::kAll);

}  // namespace twinmap::linalg
