#pragma once

#include "kernels/linalg/gemm.hpp"

namespace twinmap::linalg {

/// From this inner dimension on, products are OpenBLAS's in the optional build (CMake option
/// TWINMAP_OPENBLAS). Smaller ones stay with gemm(), which does not allocate.
constexpr Index kOpenblasDepth = 512;

/// gemm() by OpenBLAS on one thread. Its sums depend on the size of a call, so the optional build does not
/// share products among threads (TriangularScratch): results would depend on their number.
void multiplyByOpenblas(double alpha, ConstView a, ConstView b, double beta, View c, Part part);

}  // namespace twinmap::linalg
