// Covariances from 20000 draws: relative standard deviation 1 %; tests allow five of them.
#include "framework/estimation/network/noisy_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kDraws = 20000;
constexpr double kRelative = 0.05;

MatrixXd drawMany(const NoisySamples& samples, Index sample) {
  MatrixXd inputs(samples.countInputs(), kDraws);
  samples.draw(std::vector<Index>(kDraws, sample), {1, RandomPurpose::kNetworkNoise}, {}, inputs);
  return inputs;
}

void expectCovariance(const MatrixXd& inputs, const MatrixXd& expected) {
  const MatrixXd centered = inputs.colwise() - inputs.rowwise().mean().eval();
  const MatrixXd found = centered * centered.transpose() / static_cast<double>(inputs.cols());
  EXPECT_LT((found - expected).norm(), kRelative * expected.norm());
}

TEST(NormalSamples, HaveTheCovarianceOfNoiseAndError) {
  NormalInputs inputs{MatrixXd::Random(3, 2), MatrixXd::Random(2, 2), MatrixXd::Random(2, 2), MatrixXd(2, 2),
                      MatrixXd(2, 2)};
  inputs.error_stddev << 0.5, 2.0, 0.1, 3.0;
  inputs.error_factor << 1.0, 0.0, 0.6, 0.8;
  const NormalSamples samples(inputs);
  const MatrixXd drawn = drawMany(samples, 1);
  const MatrixXd stddev = inputs.error_stddev.col(1).asDiagonal();
  const MatrixXd correlation = inputs.error_factor * inputs.error_factor.transpose();
  const MatrixXd error = stddev * correlation * stddev;
  expectCovariance(drawn.topRows(2),
                   inputs.factor * inputs.factor.transpose() +
                       inputs.error_projection * error * inputs.error_projection.transpose());
  // the known input has no noise
  EXPECT_EQ(drawn.row(2).minCoeff(), inputs.clean(2, 1));
  EXPECT_EQ(drawn.row(2).maxCoeff(), inputs.clean(2, 1));
}

/// Coloured noise of three samples of an output, projected on two inputs.
TEST(ResponseSamples, HaveTheNoiseOfTheResponse) {
  const std::vector<FeatureSpec> features{SamplesFeatureSpec{{{"y", {}}}, 0.0, 1.0, 3}};
  const ResponseLayout layout{{"y"}, {"m"}, collectTimes(features)};
  const FeatureExtractor extractor(features, layout);
  NoiseSpec spec;
  spec.stddev = {{{"y", {}}, 0.2}};
  NoiseCorrelationSpec correlation;
  correlation.name = {"y", {}};
  correlation.values = {1.0, 0.5};
  correlation.sample_time = 1.0;
  spec.correlation = {correlation};
  const ResponseNoise noise(spec, layout);
  const MatrixXd responses = MatrixXd::Random(3, 4), known(0, 4);
  const NetworkInputs inputs{VectorXd::Zero(3), MatrixXd::Random(2, 3), {VectorXd(0), VectorXd(0)}};
  const ResponseSamples samples(responses, known, extractor, noise, inputs);
  const MatrixXd drawn = drawMany(samples, 2);
  Eigen::Matrix3d expected;
  expected << 0.04, 0.02, 0.0, 0.02, 0.04, 0.02, 0.0, 0.02, 0.04;
  expectCovariance(drawn, inputs.projection * expected * inputs.projection.transpose());
  EXPECT_LT((drawn.rowwise().mean() - inputs.projection * responses.col(2)).norm(), 0.02);
}

TEST(NoisySamples, DependOnTheKeyAndNotOnTheirNeighbours) {
  const NormalSamples samples({MatrixXd::Random(2, 5), MatrixXd::Identity(2, 2), {}, {}, {}});
  const RandomStream random(1, RandomPurpose::kNetworkNoise);
  MatrixXd whole(2, 4), part(2, 2), other(2, 4);
  samples.draw({0, 1, 2, 3}, random, {7, 0}, whole);
  samples.draw({2, 3}, random, {7, 2}, part);
  samples.draw({0, 1, 2, 3}, random, {8, 0}, other);
  EXPECT_EQ(whole.rightCols(2), part);
  EXPECT_NE(whole, other);
}

}  // namespace
}  // namespace twinmap
