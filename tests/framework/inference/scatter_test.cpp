#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/random/random.hpp"
#include "framework/inference/joint/joint_inference.hpp"

namespace twinmap {
namespace {

using Eigen::VectorXd;

TEST(Scatter, IsNoneWhereValuesAgree) {
  const ScatterEstimate estimate =
      combineScattered(Eigen::Vector3d(1.0, 1.1, 0.9), Eigen::Vector3d(0.2, 0.1, 0.2));
  EXPECT_EQ(estimate.scatter, 0.0);
  EXPECT_NEAR(estimate.mean, (25.0 * 1.0 + 100.0 * 1.1 + 25.0 * 0.9) / 150.0, 1e-12);
  EXPECT_NEAR(estimate.stddev, 1.0 / std::sqrt(150.0), 1e-12);
}

TEST(Scatter, OfEquallyKnownValuesIsTheirSpread) {
  const Eigen::Vector4d values(1.0, 3.0, 2.0, 6.0);
  const ScatterEstimate estimate = combineScattered(values, VectorXd::Constant(4, 0.01));
  const double variance = (values.array() - 3.0).square().sum() / 3.0;
  EXPECT_NEAR(estimate.mean, 3.0, 1e-12);
  EXPECT_NEAR(estimate.scatter * estimate.scatter, variance - 1e-4, 1e-9);
  EXPECT_NEAR(estimate.stddev, std::sqrt(variance / 4.0), 1e-9);
  EXPECT_NEAR(estimate.calcStddevOfNext(), std::sqrt(variance * 5.0 / 4.0 - 1e-4), 1e-9);
  EXPECT_NEAR(estimate.calcFactor().of95, 3.182446, 1e-5);  // t of 3 degrees
}

TEST(Scatter, IsSeenThoughOneValueIsKnownFarBetterThanOthers) {
  const VectorXd values = (VectorXd(5) << 0.0, 1.0, -1.2, 0.9, -0.8).finished();
  const VectorXd stddevs = (VectorXd(5) << 1e-5, 0.1, 0.1, 0.1, 0.1).finished();
  const ScatterEstimate estimate = combineScattered(values, stddevs);
  EXPECT_NEAR(estimate.scatter, 1.0, 0.1);  // that of Cochran's Q is 4e-2
  EXPECT_GT(estimate.ratio, 9.0);
}

/// Of the parameter that a model which lacks something sees in one recording more: it scatters as theirs.
TEST(Scatter, IntervalsHoldWhatTheNextOfFewRecordingsSays) {
  constexpr int kTests = 2000;
  const RandomStream random(5, RandomPurpose::kVerification);
  int holds = 0;
  for (int test = 0; test < kTests; ++test) {
    VectorXd normals(9);
    random.drawNormals(static_cast<std::uint64_t>(test), 0, normals.data(), 9);
    const Eigen::Vector4d stddevs(0.1, 0.2, 0.1, 0.3);
    const VectorXd values = normals.head(4) + stddevs.cwiseProduct(normals.segment(4, 4));
    const ScatterEstimate estimate = combineScattered(values, stddevs);
    const double error = estimate.mean - normals[8];
    holds += std::abs(error) < estimate.calcFactor().of95 * estimate.calcStddevOfNext() ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(holds) / kTests, 0.95, 0.02);
}

/// Two recordings, of which one hardly sees the parameter: its interval is mostly noise, and normal.
TEST(Scatter, OfARecordingIsNormalAsFarAsItsOwnErrorDecides) {
  ScatterEstimate two;
  two.degrees = 1;
  two.scatter = 1.0;
  EXPECT_NEAR(two.widen(0.0), 1.0, 1e-12);
  EXPECT_NEAR(two.calcFactor(0.0).of95, 12.7062, 1e-4);  // t of one degree
  EXPECT_NEAR(two.calcFactor(1.0).of95, 2.7764, 1e-4);   // t of four: (1 + 1)^2 / 1
  EXPECT_NEAR(two.calcFactor(100.0).of95, kNormal95, 1e-6);
  two.scatter = 0.0;
  EXPECT_EQ(two.calcFactor(1.0).of95, kNormal95);
}

TEST(Scatter, IsAsRareByChanceAsItsPValueSays) {
  constexpr int kTests = 4000;
  const RandomStream random(6, RandomPurpose::kVerification);
  int below = 0;
  for (int test = 0; test < kTests; ++test) {
    VectorXd normals(3);
    random.drawNormals(static_cast<std::uint64_t>(test), 0, normals.data(), 3);
    const Eigen::Vector3d stddevs(0.1, 3.0, 1.0);
    below += calcScatterPValue(combineScattered(stddevs.cwiseProduct(normals), stddevs)) < 0.05 ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(below) / kTests, 0.05, 0.012);
}

}  // namespace
}  // namespace twinmap
