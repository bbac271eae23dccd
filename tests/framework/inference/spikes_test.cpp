#include "framework/inference/measurement/spikes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kTimes = 500;

ResponseLayout makeLayout() {
  return {{"x", "a"}, {"m", "m/s2"}, VectorXd::LinSpaced(kTimes, 0.01, 5.0), 0};
}

VectorXd makeResponse() {
  std::mt19937 generator(3);
  std::normal_distribution<double> noise(0.0, 1e-3);
  const ResponseLayout layout = makeLayout();
  return VectorXd::NullaryExpr(
      2 * kTimes, [&](Index i) { return std::sin(7.0 * layout.times[i % kTimes]) + noise(generator); });
}

TEST(Spikes, AreThoseThatWereAdded) {
  VectorXd response = makeResponse();
  EXPECT_TRUE(findSpikes(response, makeLayout()).empty());
  response[40] += 0.05;
  response[41] -= 0.07;
  response[kTimes + 100] += 0.3;
  const std::vector<SpikedSample> found = findSpikes(response, makeLayout());
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].row, 41);
  EXPECT_EQ(found[1].row, 40);
  EXPECT_EQ(found[2].row, kTimes + 100);
  EXPECT_NEAR(found[2].height, 0.3, 5e-3);
}

TEST(Spikes, AreNotWhatASensorMeasuresAllTheTime) {
  VectorXd response = makeResponse();
  for (Index i = 10; i < kTimes; i += 20) {
    response[i] += 0.5;  // an impact every 0.2 s
  }
  EXPECT_TRUE(findSpikes(response, makeLayout()).empty());
}

TEST(Spikes, AreNamedByTheirFeatures) {
  VectorXd response = makeResponse();
  response[kTimes + 100] += 0.3;
  std::vector<FeatureInfo> infos{{"x(1.01 s)", "m", 0, makeLayout().times[100]},
                                 {"a(1.01 s)", "m/s2", 1, makeLayout().times[100]}};
  const SpikedFeatures found = findSpikedFeatures(response, makeLayout(), infos);
  ASSERT_EQ(found.features.size(), 1U);
  EXPECT_EQ(found.features.front(), 1);
  EXPECT_EQ(found.said.front().find("a(1.01 s) (off by 0."), 0U);
}

}  // namespace
}  // namespace twinmap
