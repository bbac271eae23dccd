#include "framework/base/random/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

namespace twinmap {
namespace {

/// FNV-1a of the numbers' bytes.
std::uint64_t hash(const std::vector<double>& values) {
  std::uint64_t found = 0xcbf29ce484222325;
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  for (std::size_t i = 0; i < values.size() * sizeof(double); ++i) {
    found = (found ^ bytes[i]) * 0x100000001b3;
  }
  return found;
}

TEST(RandomStream, NumbersDependOnTheKeyAlone) {
  const RandomStream stream(1, RandomPurpose::kTrainNoise);
  const double value = stream.calcUniform(3, 5);
  stream.calcUniform(4, 5);
  EXPECT_EQ(stream.calcUniform(3, 5), value);
  std::set<double> others{value, stream.calcUniform(5, 3), stream.calcUniform(3, 6),
                          RandomStream(2, RandomPurpose::kTrainNoise).calcUniform(3, 5),
                          RandomStream(1, RandomPurpose::kTestNoise).calcUniform(3, 5)};
  EXPECT_EQ(others.size(), 5u);
}

// Philox 4x64-10 with counter 0 and key 0 begins with 0x16554d9eca36314c: known-answer test of Random123.
TEST(RandomStream, IsPhilox) {
  const double expected = static_cast<double>(0x16554d9eca36314cULL) * 0x1p-64;
  EXPECT_NEAR(RandomStream(0, static_cast<RandomPurpose>(0)).calcUniform(0, 0), expected, 1e-15);
}

TEST(RandomStream, UniformAndNormalHaveTheirMoments) {
  constexpr int kSeeds = 20, kSamples = 50000;
  constexpr double kCount = kSeeds * kSamples;
  double uniform_sum = 0, normal_sum = 0, normal_squares = 0, normal_fourths = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const RandomStream stream(seed, RandomPurpose::kTrainNoise);
    for (int i = 0; i < kSamples; ++i) {
      const double u = stream.calcUniform(i, 0), z = stream.calcNormal(i, 1);
      ASSERT_GT(u, 0.0);
      ASSERT_LT(u, 1.0);
      uniform_sum += u;
      normal_sum += z;
      normal_squares += z * z;
      normal_fourths += z * z * z * z;
    }
  }
  // Four standard errors of each mean.
  const double root = std::sqrt(kCount);
  EXPECT_NEAR(uniform_sum / kCount, 0.5, 4 * std::sqrt(1.0 / 12) / root);
  EXPECT_NEAR(normal_sum / kCount, 0.0, 4 / root);
  EXPECT_NEAR(normal_squares / kCount, 1.0, 4 * std::sqrt(2.0) / root);
  EXPECT_NEAR(normal_fourths / kCount, 3.0, 4 * std::sqrt(96.0) / root);
}

// The normal is the quantile of the uniform at the same key.
TEST(RandomStream, NormalIsTheQuantileOfTheUniform) {
  const RandomStream stream(3, RandomPurpose::kTestNoise);
  for (int i = 0; i < 1000; ++i) {
    const double z = stream.calcNormal(i, 2);
    EXPECT_NEAR(0.5 * std::erfc(-z / std::sqrt(2.0)), stream.calcUniform(i, 2), 1e-14);
  }
}

// 200000 numbers: moments to five standard errors.
TEST(RandomStream, ManyNormalsAreIndependentAndNormal) {
  constexpr std::size_t kCount = 200000;
  const RandomStream stream(1, RandomPurpose::kNetworkNoise);
  std::vector<double> values(kCount);
  stream.drawNormals(3, 5, values.data(), kCount);
  double mean = 0.0, square = 0.0, neighbours = 0.0, beyond_two = 0.0;
  for (std::size_t i = 0; i < kCount; ++i) {
    mean += values[i] / kCount;
    square += values[i] * values[i] / kCount;
    neighbours += i > 0 ? values[i] * values[i - 1] / kCount : 0.0;
    beyond_two += std::abs(values[i]) > 2.0 ? 1.0 / kCount : 0.0;
  }
  EXPECT_NEAR(mean, 0.0, 5.0 / std::sqrt(kCount));
  EXPECT_NEAR(square, 1.0, 5.0 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(neighbours, 0.0, 5.0 / std::sqrt(kCount));
  EXPECT_NEAR(beyond_two, 0.0455, 5.0 * std::sqrt(0.0455 / kCount));

  std::vector<double> fewer(7);
  stream.drawNormals(3, 5, fewer.data(), fewer.size());
  EXPECT_TRUE(std::equal(fewer.begin(), fewer.end(), values.begin()));
  stream.drawNormals(3, 6, fewer.data(), fewer.size());
  EXPECT_NE(fewer[0], values[0]);
}

// Kolmogorov's distance of 10^6 numbers to the normal distribution function stays below its 99.99 % quantile,
// and as many lie in the tail, which the ziggurat draws in another way from 3.44 on, as should.
TEST(RandomStream, ManyNormalsHaveTheNormalDistribution) {
  constexpr std::size_t kCount = 1000000;
  constexpr double kTail = 3.5;
  std::vector<double> values(kCount);
  RandomStream(7, RandomPurpose::kTestNoise).drawNormals(1, 0, values.data(), kCount);
  std::sort(values.begin(), values.end());
  double distance = 0.0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const double expected = 0.5 * std::erfc(-values[i] / std::sqrt(2.0));
    distance = std::max(distance, std::abs(expected - (static_cast<double>(i) + 0.5) / kCount));
  }
  EXPECT_LT(distance, 2.2 / std::sqrt(kCount));
  const auto above =
      static_cast<double>(values.end() - std::upper_bound(values.begin(), values.end(), kTail));
  const auto below =
      static_cast<double>(std::lower_bound(values.begin(), values.end(), -kTail) - values.begin());
  const double expected = kCount * 0.5 * std::erfc(kTail / std::sqrt(2.0));
  EXPECT_NEAR(above, expected, 4.0 * std::sqrt(expected));
  EXPECT_NEAR(below, expected, 4.0 * std::sqrt(expected));
}

// The same on every processor and for every compiler: Boost's ziggurat on Philox, without fused
// multiply-adds.
TEST(RandomStream, ManyNormalsKeepTheirBits) {
  std::vector<double> values(1000);
  RandomStream(1, RandomPurpose::kTrainNoise).drawNormals(0, 0, values.data(), values.size());
  EXPECT_EQ(hash(values), 14062641236397765909u);
}

}  // namespace
}  // namespace twinmap
