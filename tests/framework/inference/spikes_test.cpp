#include "framework/inference/measurement/spikes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kSpikedTimes = 500;

ResponseLayout makeTwoSensors() {
  return {{"x", "a"}, {"m", "m/s2"}, VectorXd::LinSpaced(kSpikedTimes, 0.01, 5.0), 0};
}

VectorXd makeSmooth() {
  std::mt19937 generator(3);
  std::normal_distribution<double> noise(0.0, 1e-3);
  const ResponseLayout layout = makeTwoSensors();
  return VectorXd::NullaryExpr(2 * kSpikedTimes, [&](Index i) {
    return std::sin(7.0 * layout.times[i % kSpikedTimes]) + noise(generator);
  });
}

TEST(Spikes, AreThoseThatWereAdded) {
  VectorXd response = makeSmooth();
  EXPECT_TRUE(findSpikes(response, makeTwoSensors()).empty());
  response[40] += 0.05;
  response[60] -= 0.07;
  response[kSpikedTimes + 100] += 0.3;
  const std::vector<SpikedSample> found = findSpikes(response, makeTwoSensors());
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].row, 60);
  EXPECT_EQ(found[1].row, 40);
  EXPECT_EQ(found[2].row, kSpikedTimes + 100);
  EXPECT_NEAR(found[2].height, 0.3, 5e-3);
}

TEST(Spikes, AreNotWhatASensorMeasuresAllTheTime) {
  VectorXd response = makeSmooth();
  for (Index i = 10; i < kSpikedTimes; i += 20) {
    response[i] += 0.5;  // an impact every 0.2 s
  }
  EXPECT_TRUE(findSpikes(response, makeTwoSensors()).empty());
}

TEST(Spikes, AreNamedByTheirFeatures) {
  VectorXd response = makeSmooth();
  response[kSpikedTimes + 100] += 0.3;
  std::vector<FeatureInfo> infos{{"x(1.01 s)", "m", 0, makeTwoSensors().times[100]},
                                 {"a(1.01 s)", "m/s2", 1, makeTwoSensors().times[100]}};
  const SpikedFeatures found = findSpikedFeatures(response, makeTwoSensors(), infos);
  ASSERT_EQ(found.features.size(), 1U);
  EXPECT_EQ(found.features.front(), 1);
  EXPECT_EQ(found.said.front().find("a(1.01 s) (off by 0."), 0U);
}

}  // namespace
}  // namespace twinmap
