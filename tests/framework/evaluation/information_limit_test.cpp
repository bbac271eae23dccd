#include "framework/evaluation/information_limit.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "framework/evaluation/identifiability.hpp"
#include "tests/framework/support/linear_simulator.hpp"

namespace twinmap::testing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLower = 1.0, kUpper = 3.0, kWidth = 2.0, kNoise = 0.1;

InformationLimit calcLimit(const MatrixXd& matrix, const MatrixXd& points, double noise = kNoise,
                           double fails_above = 1e300) {
  const LinearSimulator simulator(matrix, fails_above);
  const FeatureExtractor extractor(makeAllFeatures(simulator), simulator.getLayout());
  const auto parameters = makeParameters(static_cast<int>(matrix.cols()), kLower, kUpper);
  const FeatureNoise feature_noise(extractor, VectorXd::Constant(matrix.rows(), noise), 1);
  return calcInformationLimit(calcLocalModels(simulator, extractor, parameters, points, 1), feature_noise,
                              parameters);
}

MatrixXd makePoints(int dimensions, int count) {
  return (MatrixXd::Random(dimensions, count).array() + 2.0).matrix();
}

MatrixXd makeMatrix() {
  MatrixXd matrix(3, 2);
  matrix << 1, 2, 0, 1, 0.5, -1;
  return matrix;
}

TEST(InformationLimit, OfALinearModelIsTheRidgeCovariance) {
  const InformationLimit limit = calcLimit(makeMatrix(), makePoints(2, 5));
  const MatrixXd information = makeMatrix().transpose() * makeMatrix() / (kNoise * kNoise);
  const MatrixXd box = 12.0 / (kWidth * kWidth) * MatrixXd::Identity(2, 2);
  const VectorXd expected = (information + box).inverse().diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < 5; ++i) {
    EXPECT_LT((limit.stddev.col(i) - expected).cwiseAbs().maxCoeff(), 1e-8);
  }
  EXPECT_LT((limit.mean_information - kWidth * kWidth * information).norm(), 1e-6 * information.norm());
  EXPECT_LT((limit.relevance - makeMatrix().cwiseAbs() * kWidth / kNoise).norm(), 1e-6);
}

TEST(InformationLimit, LeavesOutFailedSamplesAndCountsThem) {
  MatrixXd points = makePoints(2, 3);
  points(0, 1) = 2.9;
  points(0, 0) = points(0, 2) = 1.5;
  const InformationLimit limit = calcLimit(makeMatrix(), points, kNoise, 2.5);
  EXPECT_EQ(limit.failures, 1);
  EXPECT_TRUE(std::isnan(limit.stddev(0, 1)));
  EXPECT_TRUE(limit.mean_information.allFinite());
  EXPECT_THROW(calcLimit(makeMatrix(), points, kNoise, 0.0), std::runtime_error);
}

TEST(InformationLimit, NeedsNoise) {
  EXPECT_THROW(calcLimit(makeMatrix(), makePoints(2, 2), 0.0), std::invalid_argument);
}

TEST(Identifiability, NamesAParameterThatNoFeatureFollows) {
  MatrixXd matrix(2, 2);
  matrix << 1, 0, 2, 0;
  const auto result =
      calcIdentifiability(calcLimit(matrix, makePoints(2, 4)), makeParameters(2, kLower, kUpper));
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_NE(result.warnings[0].find("parameter 'b'"), std::string::npos);
  EXPECT_NE(result.warnings[0].find("no feature follows it"), std::string::npos);
  EXPECT_NEAR(result.remaining[1], 1.0, 1e-12);
  EXPECT_LT(result.remaining[0], 0.1);
}

TEST(Identifiability, NamesThoseThatLookAlike) {
  MatrixXd matrix(2, 3);  // only a - b and c are seen
  matrix << 1, -1, 0, 2, -2, 1;
  const auto result =
      calcIdentifiability(calcLimit(matrix, makePoints(3, 4)), makeParameters(3, kLower, kUpper));
  ASSERT_EQ(result.warnings.size(), 2U);
  EXPECT_NE(result.warnings[0].find("parameter 'a'"), std::string::npos);
  EXPECT_NE(result.warnings[0].find("looks like a change of 'b' (correlation 0.97)"), std::string::npos)
      << result.warnings[0];
  EXPECT_GT(result.correlation(0, 1), 0.97);
  EXPECT_NEAR(result.eigenvalues[0], 0.0, 1e-6);
  EXPECT_NEAR(std::abs(result.eigenvectors(0, 0)), std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(result.eigenvectors(0, 0), result.eigenvectors(1, 0), 1e-6);
}

TEST(Identifiability, IsSilentWhereTheDataSuffice) {
  const auto limit = calcLimit(makeMatrix(), makePoints(2, 4));
  EXPECT_TRUE(calcIdentifiability(limit, makeParameters(2, kLower, kUpper)).warnings.empty());
}

}  // namespace
}  // namespace twinmap::testing
