#pragma once

#include <cstdint>
#include <vector>

#include "framework/base/random/random.hpp"

namespace twinmap {

/// A random permutation of 0 .. n - 1: the ranks of n numbers of the stream's (channel, replicate).
std::vector<int> makePermutation(int n, const RandomStream& random, std::uint64_t channel,
                                 std::uint64_t replicate = 0);

/// Which of n equal slices of [0, 1) holds x. Twice as many slices split each in two exactly, also in
/// floating point.
int findSlice(double x, int n);

/// A point of slice `slice` of n, at the fraction `u` of its width; its middle where rounding would move the
/// point to a neighbour.
double placeInSlice(int slice, int n, double u);

}  // namespace twinmap
