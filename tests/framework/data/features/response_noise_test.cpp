#include <gtest/gtest.h>

#include <cmath>

#include "framework/data/noise/feature_noise.hpp"
#include "framework/data/noise/noise.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kTimes = 6;
constexpr double kA = 0.8;

/// Outputs y, white, and z, a first-order autoregression of stddev 0.2; modes behind them.
ResponseLayout makeTwoOutputs() {
  return {{"y", "z"}, {"m", "m"}, (VectorXd(kTimes) << 0.1, 0.2, 0.3, 0.4, 0.5, 0.6).finished(), 1};
}

NoiseSpec makeTwoNoises() {
  NoiseSpec spec;
  spec.stddev = {{{"y", {}}, 3.0}, {{"z", {}}, 0.2}};
  spec.modes = ModesNoiseSpec{0.01, 0.02};
  spec.correlation = {{{"z", {}}, {kA}, {}, 0.1}};
  return spec;
}

TEST(ResponseNoise, DrawsFollowTheAutoregression) {
  const ResponseNoise noise(makeTwoNoises(), makeTwoOutputs());
  const VectorXd white = calcNoiseStddev(makeTwoNoises(), makeTwoOutputs());
  const MatrixXd clean = MatrixXd::Zero(white.size(), 3);
  const RandomStream stream(1, RandomPurpose::kTrainNoise);
  const MatrixXd draws = addNoise(clean, noise, stream, 2), independent = addNoise(clean, white, stream, 2);
  EXPECT_LT((draws.topRows(kTimes) - independent.topRows(kTimes)).norm(), 1e-14);
  EXPECT_LT((draws.bottomRows(2) - independent.bottomRows(2)).norm(), 1e-14);
  for (Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(draws(kTimes, i), independent(kTimes, i), 1e-15);
    for (Index k = kTimes + 1; k < 2 * kTimes; ++k) {
      const double expected = kA * draws(k - 1, i) + std::sqrt(1.0 - kA * kA) * independent(k, i);
      EXPECT_NEAR(draws(k, i), expected, 1e-14);
    }
  }
  EXPECT_EQ(addNoise(clean.leftCols(1), noise, stream, 2), draws.leftCols(1));
}

TEST(ResponseNoise, OfRoundedReadingsHasTheirVarianceAndTheirSteps) {
  constexpr double kQuantum = 0.5;
  NoiseSpec spec = makeTwoNoises();
  spec.rounded = {{"z", kQuantum}};
  const ResponseNoise noise(spec, makeTwoOutputs());
  EXPECT_DOUBLE_EQ(noise.getStddev()[kTimes], std::sqrt(0.04 + kQuantum * kQuantum / 12.0));
  EXPECT_DOUBLE_EQ(noise.getStddev()[0], 3.0);
  const FeatureMatrix all = MatrixXd::Identity(2 * kTimes + 2, 2 * kTimes + 2).sparseView();
  const MatrixXd more = noise.calcCovariance(all).toMatrix() -
                        ResponseNoise(makeTwoNoises(), makeTwoOutputs()).calcCovariance(all).toMatrix();
  VectorXd expected = VectorXd::Zero(2 * kTimes + 2);
  expected.segment(kTimes, kTimes).setConstant(kQuantum * kQuantum / 12.0);
  EXPECT_LT((more - MatrixXd(expected.asDiagonal())).norm(), 1e-14);
  const MatrixXd clean = MatrixXd::Constant(2 * kTimes + 2, 3, 0.1);
  const RandomStream stream(1, RandomPurpose::kTrainNoise);
  const MatrixXd readings = addNoise(clean, noise, stream).middleRows(kTimes, kTimes);
  const MatrixXd steps = readings / kQuantum;
  EXPECT_EQ(steps, steps.array().round().matrix());
}

TEST(ResponseNoise, OfFeaturesHasTheCovarianceOfTheAutoregression) {
  const FeatureSpec feature = SamplesFeatureSpec{{{"y", {}}, {"z", {}}}, 0.1, 0.2, 3};
  const FeatureExtractor extractor({feature}, makeTwoOutputs());
  const MatrixXd covariance = FeatureNoise(extractor, ResponseNoise(makeTwoNoises(), makeTwoOutputs()), 1)
                                  .calcCovariance({})
                                  .toMatrix();
  MatrixXd expected = MatrixXd::Zero(6, 6);
  expected.diagonal().head(3).setConstant(9.0);
  for (Index i = 0; i < 3; ++i) {
    for (Index j = 0; j < 3; ++j) {
      expected(3 + i, 3 + j) = 0.04 * std::pow(kA, 2.0 * std::abs(static_cast<double>(i - j)));
    }
  }
  EXPECT_LT((covariance - expected).norm(), 1e-14);
}

TEST(ResponseNoise, OfTimesOffTheGridIsIndependentOfThoseOnIt) {
  ResponseLayout layout = makeTwoOutputs();
  layout.times[3] = 0.43;
  const VectorXd stddev = calcNoiseStddev(makeTwoNoises(), layout);
  FeatureMatrix identity(stddev.size(), stddev.size());
  identity.setIdentity();
  const MatrixXd covariance = ResponseNoise(makeTwoNoises(), layout).calcCovariance(identity).toMatrix();
  EXPECT_EQ(covariance.row(kTimes + 3).cwiseAbs().sum(), covariance(kTimes + 3, kTimes + 3));
  EXPECT_NEAR(covariance(kTimes + 2, kTimes + 4), 0.04 * kA * kA, 1e-15);
}

TEST(ResponseNoise, WithoutCorrelationIsWhite) {
  NoiseSpec spec = makeTwoNoises();
  spec.correlation.clear();
  const MatrixXd clean = MatrixXd::Random(2 * kTimes + 2, 3);
  const RandomStream stream(1, RandomPurpose::kTestNoise);
  EXPECT_EQ(addNoise(clean, ResponseNoise(spec, makeTwoOutputs()), stream),
            addNoise(clean, calcNoiseStddev(spec, makeTwoOutputs()), stream));
}

TEST(ResponseNoise, ThatIsPerfectlyCorrelatedIsRefused) {
  NoiseSpec spec = makeTwoNoises();
  spec.correlation = {{{"z", {}}, {}, {1.0, 1.0, 1.0}, 0.1}};
  EXPECT_THROW(ResponseNoise(spec, makeTwoOutputs()), std::invalid_argument);
}

}  // namespace
}  // namespace twinmap
