#pragma once

#include <cstring>

#include "kernels/linalg/view.hpp"

namespace twinmap::linalg {

#ifdef __AVX512F__
constexpr Index kLanes = 8;
#else
constexpr Index kLanes = 4;
#endif

/// One vector register of doubles (a GCC and clang extension: + - * / act on every lane).
using Packet = double __attribute__((vector_size(kLanes * sizeof(double)), may_alias));

/// From and to any address; one unaligned move. (clang ignores a smaller alignment of a vector type's alias.)
inline Packet load(const double* source) {
  Packet packet;
  std::memcpy(&packet, source, sizeof(packet));
  return packet;
}
inline void store(double* target, Packet value) {
  std::memcpy(target, &value, sizeof(value));
}

/// Copies the kLanes x kLanes block whose row r is contiguous at source + r * stride, transposed: its column
/// p becomes contiguous at target + p * target_stride.
inline void copyTransposed(const double* source, Index stride, double* target, Index target_stride) {
  Packet row[kLanes];
  for (Index r = 0; r < kLanes; ++r) {
    row[r] = load(source + r * stride);
  }
#ifdef __AVX512F__
  Packet pair[kLanes], quad[kLanes];
  for (Index r = 0; r < 8; r += 2) {
    pair[r] = __builtin_shufflevector(row[r], row[r + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    pair[r + 1] = __builtin_shufflevector(row[r], row[r + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (Index r = 0; r < 8; r += 4) {
    for (Index odd = 0; odd < 2; ++odd) {
      quad[r + odd] = __builtin_shufflevector(pair[r + odd], pair[r + 2 + odd], 0, 1, 8, 9, 4, 5, 12, 13);
      quad[r + 2 + odd] =
          __builtin_shufflevector(pair[r + odd], pair[r + 2 + odd], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  }
  for (Index c = 0; c < 4; ++c) {
    store(target + c * target_stride,
          __builtin_shufflevector(quad[c], quad[c + 4], 0, 1, 2, 3, 8, 9, 10, 11));
    store(target + (c + 4) * target_stride,
          __builtin_shufflevector(quad[c], quad[c + 4], 4, 5, 6, 7, 12, 13, 14, 15));
  }
#else
  Packet pair[kLanes];
  for (Index r = 0; r < 4; r += 2) {
    pair[r] = __builtin_shufflevector(row[r], row[r + 1], 0, 4, 2, 6);
    pair[r + 1] = __builtin_shufflevector(row[r], row[r + 1], 1, 5, 3, 7);
  }
  for (Index c = 0; c < 2; ++c) {
    store(target + c * target_stride, __builtin_shufflevector(pair[c], pair[c + 2], 0, 1, 4, 5));
    store(target + (c + 2) * target_stride, __builtin_shufflevector(pair[c], pair[c + 2], 2, 3, 6, 7));
  }
#endif
}

}  // namespace twinmap::linalg
