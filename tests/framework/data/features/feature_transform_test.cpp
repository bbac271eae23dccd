#include "framework/data/reduction/feature_transform.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "framework/base/random/random.hpp"
#include "framework/data/reduction/principal_components.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

TransformStepSpec makeZScore() {
  return {ZScoreSpec{}, {}};
}

TransformStepSpec makeWhiten(WhitenBy by = WhitenBy::kStddev) {
  return {WhitenSpec{by}, {}};
}

TransformStepSpec makePrincipalComponents(std::optional<int> components = {},
                                          std::optional<double> explained_variance = {}) {
  return {PrincipalComponentsSpec{components, explained_variance}, {}};
}

/// Samples whose features have independent noise.
LabelledFeatures makeNoisySamples(const MatrixXd& features, const VectorXd& noise_stddev) {
  LabelledFeatures samples;
  samples.features = features;
  samples.noise_covariance = noise_stddev.cwiseAbs2().asDiagonal();
  return samples;
}

LabelledFeatures makeUnitNoiseSamples(const MatrixXd& features) {
  return makeNoisySamples(features, VectorXd::Ones(features.rows()));
}

MatrixXd makeNoise(int rows, int columns, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::kTrainNoise);
  return MatrixXd::NullaryExpr(rows, columns, [&](Eigen::Index i, Eigen::Index j) {
    return random.calcNormal(static_cast<std::uint64_t>(j), static_cast<std::uint64_t>(i));
  });
}

/// Two directions of standard deviation 20 and 5 in ten dimensions, plus unit noise.
MatrixXd makeTwoDirections(int samples) {
  MatrixXd data = makeNoise(10, samples, 1);
  const MatrixXd signal = makeNoise(2, samples, 2);
  data.row(3) += 20.0 * signal.row(0);
  data.row(7) += 5.0 * signal.row(1);
  return data;
}

TEST(FeatureTransform, ZScoreByHand) {
  MatrixXd features(2, 3);
  features << 1, 2, 3, 10, 10, 40;
  const FeatureTransform transform = fitTransform({makeZScore()}, makeUnitNoiseSamples(features));
  EXPECT_EQ(transform.steps[0].offset, Eigen::Vector2d(2, 20));
  EXPECT_NEAR(transform.steps[0].scale[0], 1.0, 1e-15);
  EXPECT_NEAR(transform.steps[0].scale[1], std::sqrt(300.0), 1e-14);
  const MatrixXd inputs = transform.apply(features);
  EXPECT_NEAR(inputs(0, 2), 1.0, 1e-15);
  EXPECT_NEAR(inputs(1, 0), -10.0 / std::sqrt(300.0), 1e-15);
}

TEST(FeatureTransform, ConstantFeaturesSayNothing) {
  MatrixXd features(3, 4);
  features.row(0).setConstant(0.1);
  features.row(1) << 1e9, 1e9 + 1e-7, 1e9, 1e9;  // rounding only
  features.row(2).setZero();
  const MatrixXd inputs =
      fitTransform({makeZScore()}, makeNoisySamples(features, VectorXd::Zero(3))).apply(features);
  EXPECT_LT(inputs.cwiseAbs().maxCoeff(), 1e-6);
}

TEST(FeatureTransform, WithoutStepsItChangesNothingAndTwiceIsOnce) {
  const MatrixXd features = MatrixXd::Random(4, 20);
  const VectorXd noise = VectorXd::Ones(4);
  EXPECT_EQ(fitTransform({}, makeNoisySamples(features, noise)).apply(features), features);
  const MatrixXd once = fitTransform({makeZScore()}, makeNoisySamples(features, noise)).apply(features);
  const MatrixXd twice =
      fitTransform({makeZScore(), makeZScore()}, makeNoisySamples(features, noise)).apply(features);
  EXPECT_LT((once - twice).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(FeatureTransform, WhitenDividesByTheNoiseAlsoBehindAZScore) {
  const MatrixXd features = MatrixXd::Random(2, 20);
  const VectorXd noise = Eigen::Vector2d(0.1, 4.0);
  const MatrixXd whitened = fitTransform({makeWhiten()}, makeNoisySamples(features, noise)).apply(features);
  EXPECT_LT((whitened.row(0) - features.row(0) / 0.1).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_LT((whitened.row(1) - features.row(1) / 4.0).cwiseAbs().maxCoeff(), 1e-14);
  const MatrixXd behind =
      fitTransform({makeZScore(), makeWhiten()}, makeNoisySamples(features, noise)).apply(features);
  const VectorXd shift = whitened.col(0) - behind.col(0);
  EXPECT_LT(((whitened - behind).colwise() - shift).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_THROW(fitTransform({makeWhiten()}, makeNoisySamples(features, Eigen::Vector2d(0.1, 0.0))),
               std::invalid_argument);
}

/// 50 samples of 4 features whose noise is correlated.
LabelledFeatures makeCorrelatedSamples() {
  const MatrixXd mixing = makeNoise(4, 4, 6);
  LabelledFeatures samples;
  samples.features = makeNoise(4, 50, 7);
  samples.noise_covariance = mixing * mixing.transpose();
  return samples;
}

TEST(FeatureTransform, WhitenByCovarianceMakesNoiseIndependentAlsoBehindAProjection) {
  LabelledFeatures samples = makeCorrelatedSamples();
  const TransformStepSpec whiten = makeWhiten(WhitenBy::kCovariance);
  for (const std::vector<TransformStepSpec>& steps :
       {std::vector{whiten}, {makeZScore(), whiten}, {makePrincipalComponents(3), whiten}}) {
    NoiseCovariance noise = samples.noise_covariance;
    for (const AffineStep& step : fitTransform(steps, samples).steps) {
      noise = step.applyToCovariance(noise);
    }
    EXPECT_LT((noise.toMatrix() - MatrixXd::Identity(noise.size(), noise.size())).norm(), 1e-11);
  }
  MatrixXd silent = samples.noise_covariance.toMatrix();
  silent(2, 2) = 0.0;
  samples.noise_covariance = silent;
  EXPECT_THROW(fitTransform({whiten}, samples), std::invalid_argument);
}

TEST(FeatureTransform, ItsMatrixMapsDifferences) {
  const LabelledFeatures samples = makeCorrelatedSamples();
  const TransformStepSpec whiten = makeWhiten(WhitenBy::kCovariance);
  for (const std::vector<TransformStepSpec>& steps : {std::vector{makeZScore()},
                                                      {makeZScore(), whiten},
                                                      {whiten, makePrincipalComponents(3), makeZScore()}}) {
    const FeatureTransform transform = fitTransform(steps, samples);
    const MatrixXd origin = transform.apply(VectorXd::Zero(4));
    const MatrixXd expected = transform.apply(samples.features).colwise() - origin.col(0);
    const MatrixXd mapped = transform.calcMatrix() * samples.features;
    ASSERT_EQ(mapped.rows(), expected.rows());
    EXPECT_LT((mapped - expected).norm(), 1e-11 * expected.norm());
  }
}

TEST(FeatureTransform, ByCovarianceOfIndependentNoiseIsByStddev) {
  const MatrixXd features = MatrixXd::Random(2, 20);
  const LabelledFeatures samples = makeNoisySamples(features, Eigen::Vector2d(0.1, 4.0));
  const MatrixXd by_stddev = fitTransform({makeWhiten()}, samples).apply(features);
  EXPECT_EQ(fitTransform({makeWhiten(WhitenBy::kCovariance)}, samples).apply(features), by_stddev);
}

TEST(FeatureTransform, AutomaticRankKeepsWhatStandsAboveTheNoise) {
  const MatrixXd data = makeTwoDirections(400);
  const FeatureTransform transform = fitTransform({makePrincipalComponents()}, makeUnitNoiseSamples(data));
  ASSERT_EQ(transform.steps[0].projection.rows(), 2);
  EXPECT_GT(transform.steps[0].projection(0, 3), 0.99);
  EXPECT_GT(transform.steps[0].projection(1, 7), 0.99);
  const MatrixXd noise_only = makeNoise(10, 400, 3);
  EXPECT_LE(fitTransform({makePrincipalComponents()}, makeUnitNoiseSamples(noise_only)).apply(data).rows(),
            2);
}

TEST(FeatureTransform, RankAsGivenOrByExplainedVariance) {
  const MatrixXd data = makeTwoDirections(400);
  const auto count = [&](const TransformStepSpec& step) {
    return fitTransform({step}, makeUnitNoiseSamples(data)).apply(data).rows();
  };
  EXPECT_EQ(count(makePrincipalComponents(5)), 5);
  EXPECT_EQ(count(makePrincipalComponents({}, 0.9)), 1);   // 400 of about 434
  EXPECT_EQ(count(makePrincipalComponents({}, 0.97)), 2);  // and 25
  EXPECT_THROW(count(makePrincipalComponents(11)), std::invalid_argument);
}

TEST(PrincipalComponents, AreOrthonormalUncorrelatedAndTheSameFromEitherSide) {
  for (const int samples : {6, 40}) {  // fewer and more samples than dimensions
    MatrixXd centered = makeNoise(12, samples, 4);
    centered.colwise() -= VectorXd(centered.rowwise().mean());
    const PrincipalComponents components = calcPrincipalComponents(centered);
    const Eigen::Index rank = std::min(12, samples - 1);
    const MatrixXd directions = components.directions.leftCols(rank);
    EXPECT_LT((directions.transpose() * directions - MatrixXd::Identity(rank, rank)).norm(), 1e-12);
    const MatrixXd projected = directions.transpose() * centered;
    const MatrixXd covariance = projected * projected.transpose() / (samples - 1.0);
    EXPECT_LT((covariance - MatrixXd(components.variances.head(rank).asDiagonal())).norm(), 1e-11);
    EXPECT_NEAR(components.variances.sum(), centered.squaredNorm() / (samples - 1.0), 1e-10);
  }
}

TEST(PrincipalComponents, TheNoiseEdgeIsMarchenkoPasturs) {
  EXPECT_DOUBLE_EQ(calcMarchenkoPasturEdge(100, 400), 2.25);
  MatrixXd noise = makeNoise(100, 400, 5);
  noise.colwise() -= VectorXd(noise.rowwise().mean());
  EXPECT_NEAR(calcPrincipalComponents(noise).variances[0], 2.25, 0.1);
}

}  // namespace
}  // namespace twinmap
