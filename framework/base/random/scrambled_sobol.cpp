#include "framework/base/random/scrambled_sobol.hpp"

#include <boost/random/sobol.hpp>
#include <vector>

namespace twinmap {

namespace {

using Sequence = boost::random::sobol_engine<std::uint32_t, 32>;

std::uint32_t reverseBits(std::uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  return (x >> 16) | (x << 16);
}

/// Flips each bit by what the bits above it and the key say, so that equal halves, quarters ... stay equal.
std::uint32_t scramble(std::uint32_t x, std::uint32_t key) {
  x = reverseBits(x) + key;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return reverseBits(x);
}

std::vector<std::uint32_t> makeKeys(int dimensions, const RandomStream& random, std::uint64_t channel,
                                    std::uint64_t replicate) {
  constexpr double kRange = 4294967296.0;
  std::vector<std::uint32_t> keys;
  for (int d = 0; d < dimensions; ++d) {
    keys.push_back(static_cast<std::uint32_t>(
        kRange * random.calcUniform(static_cast<std::uint64_t>(d), channel, replicate)));
  }
  return keys;
}

}  // namespace

Eigen::MatrixXd drawSobol(int dimensions, Eigen::Index count, const RandomStream& random,
                          std::uint64_t channel, std::uint64_t replicate) {
  constexpr double kScale = 1.0 / 4294967296.0;
  const std::vector<std::uint32_t> keys = makeKeys(dimensions, random, channel, replicate);
  Sequence sequence(static_cast<std::size_t>(dimensions));
  Eigen::MatrixXd points(dimensions, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (int d = 0; d < dimensions; ++d) {
      // Boost leaves out the origin, without which no power of two fills the cube evenly
      const std::uint32_t x = i == 0 ? 0 : sequence();
      points(d, i) = (scramble(x, keys[static_cast<std::size_t>(d)]) + 0.5) * kScale;
    }
  }
  return points;
}

}  // namespace twinmap
