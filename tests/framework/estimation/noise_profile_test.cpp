#include "framework/estimation/gp/noise_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/random/random.hpp"
#include "framework/estimation/gp/train_gp_map.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;

constexpr double kNoise = 0.02;

/// One feature f = p^2 with constant noise, p in [0.3, 1.3]: the spread of p is kNoise / (2 p).
LabelledFeatures makeSquares(int samples, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::kTrainDesign);
  LabelledFeatures labelled;
  labelled.infos = {{"f", "", 0, 0.0}};
  labelled.features.resize(1, samples);
  labelled.parameters.resize(1, samples);
  for (int i = 0; i < samples; ++i) {
    const double p = 0.3 + random.calcUniform(i, 0);
    labelled.parameters(0, i) = p;
    labelled.features(0, i) = p * p + kNoise * random.calcNormal(i, 1);
  }
  labelled.noise_covariance = MatrixXd::Constant(1, 1, kNoise * kNoise);
  return labelled;
}

GpMap trainWithNoise(const LabelledFeatures& samples, GpNoise noise, GpApproximation approximation) {
  GpMapSpec spec;
  spec.noise = noise;
  spec.approximation = approximation;
  spec.inducing = 30;
  const TransformStepSpec whiten{WhitenSpec{}, {}};
  return trainGpMap(spec, {whiten}, {"p"}, samples, {1}).map;
}

TEST(NoiseProfile, FollowsTheSlopeOfTheMap) {
  const LabelledFeatures samples = makeSquares(300, 1);
  MatrixXd features(1, 3);
  features << 0.16, 0.49, 1.44;  // p = 0.4, 0.7, 1.2
  for (const auto approximation : {GpApproximation::kExact, GpApproximation::kSgpr}) {
    const MatrixXd stddev =
        trainWithNoise(samples, GpNoise::kFollowsSlope, approximation).predict(features).stddev;
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(stddev(0, i) * 2.0 * std::sqrt(features(0, i)) / kNoise, 1.0, 0.15) << i;
    }
    const MatrixXd constant =
        trainWithNoise(samples, GpNoise::kConstant, approximation).predict(features).stddev;
    EXPECT_LT(constant(0, 0) / constant(0, 2), 1.2);
  }
}

TEST(NoiseProfile, MakesCoverageRightWhereTheMapIsSteepAndWhereItIsFlat) {
  const GpMap map = trainWithNoise(makeSquares(300, 1), GpNoise::kFollowsSlope, GpApproximation::kExact);
  const LabelledFeatures test = makeSquares(4000, 2);
  const Estimates predictions = map.predict(test.features);
  for (const bool steep : {true, false}) {
    int covered = 0, count = 0;
    for (Eigen::Index i = 0; i < 4000; ++i) {
      if ((test.parameters(0, i) < 0.6) == steep) {
        const double error = std::abs(predictions.mean(0, i) - test.parameters(0, i));
        covered += error < predictions.stddev(0, i) ? 1 : 0;
        ++count;
      }
    }
    EXPECT_NEAR(covered / static_cast<double>(count), 0.683, 0.04) << steep;
  }
}

TEST(NoiseProfile, WithoutNoiseItIsConstant) {
  LabelledFeatures samples = makeSquares(50, 1);
  samples.noise_covariance = MatrixXd::Zero(samples.noise_covariance.size(), samples.noise_covariance.size());
  GpMapSpec spec;
  const GpMap map = trainGpMap(spec, {}, {"p"}, samples, {1}).map;
  EXPECT_EQ(map.noise.calcFactors(map.processes[0], 0, samples.features).matrix(),
            Eigen::ArrayXd::Ones(50).matrix());
}

}  // namespace
}  // namespace twinmap
