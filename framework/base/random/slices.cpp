#include "framework/base/random/slices.hpp"

#include <algorithm>
#include <numeric>

namespace twinmap {

std::vector<int> makePermutation(int n, const RandomStream& random, std::uint64_t channel,
                                 std::uint64_t replicate) {
  std::vector<double> keys(n);
  for (int i = 0; i < n; ++i) {
    keys[i] = random.calcUniform(i, channel, replicate);
  }
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return keys[a] < keys[b]; });
  std::vector<int> rank(n);
  for (int i = 0; i < n; ++i) {
    rank[order[i]] = i;
  }
  return rank;
}

int findSlice(double x, int n) {
  return static_cast<int>(x * n);
}

double placeInSlice(int slice, int n, double u) {
  const double x = (slice + u) / n;
  return findSlice(x, n) == slice ? x : (slice + 0.5) / n;
}

}  // namespace twinmap
