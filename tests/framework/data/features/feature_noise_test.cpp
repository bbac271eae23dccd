// How noise propagates into features, against closed forms. A variance from 2000 draws has the relative
// standard deviation sqrt((kurtosis - 1) / 2000), 3.2 % for a normal feature; tests allow four of them.
#include "framework/data/noise/feature_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

constexpr double kNoiseStddev = 0.3;
constexpr double kRelative = 4 * 0.032;
constexpr double kPi = 3.141592653589793;

FeatureSpec takeSamples(double start, int count) {
  return SamplesFeatureSpec{{{"a", {}}}, start, 1.0, count};
}

FeatureSpec takeStatistics(int count, std::vector<Statistic> quantities) {
  return StatisticsFeatureSpec{{{"a", {}}}, {0.0, 1.0, count}, std::move(quantities)};
}

ResponseLayout makeSecondsLayout(int count) {
  return {{"a"}, {"m"}, Eigen::VectorXd::LinSpaced(count, 0.0, count - 1.0)};
}

/// The covariance of features of `response`, all of whose rows have noise of kNoiseStddev.
Eigen::MatrixXd calcCovariance(const std::vector<FeatureSpec>& features, const Eigen::VectorXd& response) {
  const FeatureExtractor extractor(features, makeSecondsLayout(static_cast<int>(response.size())));
  const FeatureNoise noise(extractor, Eigen::VectorXd::Constant(response.size(), kNoiseStddev), 1);
  return noise.calcCovariance(response).toMatrix();
}

TEST(FeatureNoise, OfLinearFeaturesIsExact) {
  const std::vector<FeatureSpec> features{takeSamples(1.0, 2), takeStatistics(4, {Statistic::kMean})};
  const FeatureExtractor extractor(features, makeSecondsLayout(4));
  const Eigen::Vector4d stddev(0.1, 0.2, 0.3, 0.4);
  const FeatureNoise noise(extractor, stddev, 1);
  Eigen::Matrix3d expected;  // samples 1 and 2, and the mean of samples 0 to 3
  expected << 0.04, 0, 0.01, 0, 0.09, 0.0225, 0.01, 0.0225, 0.3 / 16;
  EXPECT_TRUE(noise.isConstant());
  EXPECT_LT((noise.calcCovariance(Eigen::Vector4d::Random()).toMatrix() - expected).norm(), 1e-16);
  EXPECT_LT((noise.calcMeanCovariance(Eigen::MatrixXd::Random(4, 3)).toMatrix() - expected).norm(), 1e-16);
}

TEST(FeatureNoise, OfTheRootMeanSquareOfNoiseIsThatOfTheChiDistribution) {
  constexpr int kCount = 6;
  const double mean = std::sqrt(2.0) * std::tgamma(0.5 * (kCount + 1)) / std::tgamma(0.5 * kCount);
  const double expected = kNoiseStddev * kNoiseStddev * (kCount - mean * mean) / kCount;
  const double found =
      calcCovariance({takeStatistics(kCount, {Statistic::kRms})}, Eigen::VectorXd::Zero(kCount))(0, 0);
  EXPECT_NEAR(found, expected, kRelative * expected);
}

TEST(FeatureNoise, OfTheRootMeanSquareOfALargeSignalIsThatOfItsLinearisation) {
  const Eigen::VectorXd response = Eigen::Vector3d(300, -400, 500);
  const double expected = kNoiseStddev * kNoiseStddev / 3.0;  // gradient y / (n rms), of squared length 1 / n
  EXPECT_NEAR(calcCovariance({takeStatistics(3, {Statistic::kRms})}, response)(0, 0), expected,
              kRelative * expected);
}

TEST(FeatureNoise, OfExtremesOfTwoEqualSamplesIsTheClosedForm) {
  const Eigen::MatrixXd found =
      calcCovariance({takeStatistics(2, {Statistic::kMax, Statistic::kMin, Statistic::kPeakToPeak})},
                     Eigen::VectorXd::Ones(2));
  const double variance = kNoiseStddev * kNoiseStddev;
  EXPECT_NEAR(found(0, 0), variance * (1 - 1 / kPi), kRelative * variance);
  EXPECT_NEAR(found(0, 1), variance / kPi, kRelative * variance);
  EXPECT_NEAR(found(2, 2), variance * (2 - 4 / kPi), kRelative * variance);
}

TEST(FeatureNoise, OfAMaximumAndItsSamplesIsConsistent) {
  // max(n1, n2) has covariance 1/2 with each sample; the linear part of the matrix stays exact
  const Eigen::MatrixXd found =
      calcCovariance({takeSamples(0.0, 2), takeStatistics(2, {Statistic::kMax})}, Eigen::VectorXd::Zero(2));
  const double variance = kNoiseStddev * kNoiseStddev;
  EXPECT_EQ(found.topLeftCorner(2, 2), variance * Eigen::Matrix2d::Identity());
  EXPECT_NEAR(found(2, 0), 0.5 * variance, kRelative * variance);
  EXPECT_NEAR(found(2, 1), 0.5 * variance, kRelative * variance);
  EXPECT_NEAR(found(2, 2), (1 - 1 / kPi) * variance, kRelative * variance);
  EXPECT_EQ(found, found.transpose());
}

TEST(FeatureNoise, OfMixturesIsPositiveSemiDefinite) {
  const std::vector<FeatureSpec> features{
      takeStatistics(5, {Statistic::kMean, Statistic::kMax, Statistic::kMin, Statistic::kPeakToPeak}),
      takeSamples(0.0, 5), takeStatistics(5, {Statistic::kMean})};  // several depend on one another
  for (int trial = 0; trial < 5; ++trial) {
    const Eigen::MatrixXd covariance = calcCovariance(features, Eigen::VectorXd::Random(5));
    const Eigen::VectorXd eigenvalues = linalg::calcSymmetricEigenvalues(covariance);
    EXPECT_GT(eigenvalues.minCoeff(), -1e-14 * eigenvalues.maxCoeff());
  }
}

TEST(FeatureNoise, MeanCovarianceLeavesOutFailedSamples) {
  const std::vector<FeatureSpec> features{takeStatistics(3, {Statistic::kMax})};
  const FeatureExtractor extractor(features, makeSecondsLayout(3));
  const FeatureNoise noise(extractor, Eigen::VectorXd::Constant(3, kNoiseStddev), 1);
  Eigen::MatrixXd responses(3, 3);
  responses << 1, std::nan(""), 0, 2, std::nan(""), 0, 9, std::nan(""), 0;
  const Eigen::MatrixXd expected = 0.5 * (noise.calcCovariance(responses.col(0)).toMatrix() +
                                          noise.calcCovariance(responses.col(2)).toMatrix());
  EXPECT_LT((noise.calcMeanCovariance(responses).toMatrix() - expected).norm(), 1e-16);
}

}  // namespace
}  // namespace twinmap
