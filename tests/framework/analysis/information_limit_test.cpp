#include "framework/analysis/information_limit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "framework/analysis/identifiability.hpp"
#include "tests/framework/support/linear_simulator.hpp"
#include "tests/lu.hpp"

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
  const VectorXd expected = test::calcInverse(information + box).diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < 5; ++i) {
    EXPECT_LT((limit.stddev.col(i) - expected).cwiseAbs().maxCoeff(), 1e-8);
  }
  EXPECT_LT((limit.mean_information - kWidth * kWidth * information).norm(), 1e-6 * information.norm());
  EXPECT_LT((limit.relevance - makeMatrix().cwiseAbs() * kWidth / kNoise).norm(), 1e-6);
}

// y_i = k s_i + offset + g u: with k inferred, the offset unknown in wide bounds and u known, the variance of
// k is that of the slope of a regression line, sigma^2 / sum (s_i - mean s)^2.
TEST(InformationLimit, OfASlopeBesideAnUnknownOffsetIsThatOfARegressionLine) {
  constexpr double kWide = 1e4;
  MatrixXd matrix(4, 3);
  matrix << 1, 1, 7, 2, 1, -3, 4, 1, 2, 9, 1, 5;
  const LinearSimulator simulator(matrix);
  const FeatureExtractor extractor(makeAllFeatures(simulator), simulator.getLayout());
  const auto unknown = makeParameters(2, -kWide, kWide);
  const FeatureNoise noise(extractor, VectorXd::Constant(4, kNoise), 1);
  const MatrixXd points = MatrixXd::Random(3, 2);
  const std::vector<LocalModel> models = calcLocalModels(simulator, extractor, unknown, points, 1);
  ASSERT_EQ(models[0].sensitivities.cols(), 2);
  const InformationLimit limit = calcInformationLimit(models, noise, {unknown[0]});
  const Eigen::ArrayXd s = matrix.col(0).array();
  const double information = (s - s.mean()).square().sum() / (kNoise * kNoise);
  ASSERT_EQ(limit.stddev.rows(), 1);
  EXPECT_NEAR(limit.stddev(0, 0) * std::sqrt(information), 1.0, 1e-6);
  EXPECT_NEAR(limit.mean_information(0, 0) / (4.0 * kWide * kWide * information), 1.0, 1e-6);
  EXPECT_EQ(limit.relevance.cols(), 1);
  EXPECT_EQ(calcIdentifiability(limit, {unknown[0]}).remaining.size(), 1);
}

TEST(InformationLimit, OfTheParametersIsTheirBlockOfTheCovarianceOfAllUnknown) {
  MatrixXd matrix(4, 3);
  matrix << 1, 2, 0.3, 0, 1, -1, 0.5, -1, 2, 1, 1, 1;
  matrix *= 0.1;
  const LinearSimulator simulator(matrix);
  const FeatureExtractor extractor(makeAllFeatures(simulator), simulator.getLayout());
  const auto unknown = makeParameters(3, kLower, kUpper);
  const FeatureNoise noise(extractor, VectorXd::Constant(4, kNoise), 1);
  const InformationLimit limit = calcInformationLimit(
      calcLocalModels(simulator, extractor, unknown, makePoints(3, 1), 1), noise, {unknown[0], unknown[1]});
  const MatrixXd information = matrix.transpose() * matrix / (kNoise * kNoise);
  const MatrixXd box = 12.0 / (kWidth * kWidth) * MatrixXd::Identity(3, 3);
  const MatrixXd expected = test::calcInverse(information + box).topLeftCorner(2, 2);
  EXPECT_LT((limit.mean_covariance * kWidth * kWidth - expected).norm(), 1e-8);
}

TEST(InformationLimit, WithPriorsIsThatOfTheirInformation) {
  MatrixXd matrix(1, 2);  // the sum alone is measured
  matrix << 1, 1;
  const LinearSimulator simulator(matrix);
  const FeatureExtractor extractor(makeAllFeatures(simulator), simulator.getLayout());
  const auto parameters = makeParameters(2, kLower, kUpper);
  const FeatureNoise noise(extractor, VectorXd::Constant(1, kNoise), 1);
  MatrixXd prior(2, 2);  // per width: of the first, a standard deviation of .02 widths
  prior << 2500, 0, 0, 12;
  const InformationLimit limit =
      calcInformationLimit(calcLocalModels(simulator, extractor, parameters, makePoints(2, 3), 1), noise,
                           parameters, {prior, prior, prior});
  const MatrixXd information = kWidth * kWidth * matrix.transpose() * matrix / (kNoise * kNoise);
  const VectorXd expected = kWidth * test::calcInverse(information + prior).diagonal().cwiseSqrt();
  EXPECT_LT((limit.stddev.col(2) - expected).norm(), 1e-8);
  EXPECT_LT((limit.calcPriorCovariance() - test::calcInverse(prior)).norm(), 1e-12);
  const Identifiability found = calcIdentifiability(limit, parameters);
  EXPECT_GT(found.remaining[0], 0.8);  // nearly all of .02 widths: the data say little of it
  EXPECT_LT(found.remaining[1], 0.25);
  ASSERT_EQ(found.warnings.size(), 1U);
  EXPECT_NE(found.warnings[0].find("the uncertainty of a by only"), std::string::npos);
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
  EXPECT_NE(result.warnings[0].find("the uncertainty of b by only"), std::string::npos);
  EXPECT_NE(result.warnings[0].find("even if all other parameters were known"), std::string::npos);
  EXPECT_NEAR(result.remaining[1], 1.0, 1e-12);
  EXPECT_LT(result.remaining[0], 0.1);
}

TEST(Identifiability, NamesThoseThatLookAlike) {
  MatrixXd matrix(2, 3);  // only a - b and c are seen
  matrix << 1, -1, 0, 2, -2, 1;
  const auto result =
      calcIdentifiability(calcLimit(matrix, makePoints(3, 4)), makeParameters(3, kLower, kUpper));
  ASSERT_EQ(result.warnings.size(), 2U);
  EXPECT_NE(result.warnings[0].find("the uncertainty of a by only"), std::string::npos);
  EXPECT_NE(result.warnings[0].find("its effect looks like that of 'b' (correlation 0.97)"),
            std::string::npos)
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
