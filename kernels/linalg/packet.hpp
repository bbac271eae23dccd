#pragma once

#include "kernels/linalg/view.hpp"

namespace twinmap::linalg {

#ifdef __AVX512F__
constexpr Index kLanes = 8;
#else
constexpr Index kLanes = 4;
#endif

/// One vector register of doubles (a GCC and clang extension: + - * / act on every lane).
using Packet = double __attribute__((vector_size(kLanes * sizeof(double)), may_alias));
using UnalignedPacket =
    double __attribute__((vector_size(kLanes * sizeof(double)), may_alias, aligned(sizeof(double))));

inline Packet load(const double* source) {
  return *reinterpret_cast<const UnalignedPacket*>(source);
}
inline void store(double* target, Packet value) {
  *reinterpret_cast<UnalignedPacket*>(target) = value;
}

}  // namespace twinmap::linalg
