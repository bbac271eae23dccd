#include "framework/data/noise/noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap {
namespace {

constexpr int kTimesEach = 50;
/// Two outputs.
const Eigen::VectorXd kOutputStddev =
    (Eigen::VectorXd(2 * kTimesEach) << Eigen::VectorXd::Constant(kTimesEach, 0.1),
     Eigen::VectorXd::Constant(kTimesEach, 3.0))
        .finished();

TEST(Noise, HasEachOutputsStandardDeviation) {
  constexpr int kSamples = 400;
  const Eigen::MatrixXd clean = Eigen::MatrixXd::Constant(2 * kTimesEach, kSamples, 7.0);
  const Eigen::MatrixXd noise = addNoise(clean, kOutputStddev, {1, RandomPurpose::kTrainNoise}) - clean;
  for (int output = 0; output < 2; ++output) {
    const auto block = noise.middleRows(output * kTimesEach, kTimesEach).array();
    const double relative = std::sqrt(block.square().mean()) / kOutputStddev[output * kTimesEach];
    EXPECT_NEAR(relative, 1.0, 4 / std::sqrt(2.0 * block.size()));
  }
}

TEST(Noise, OfASampleDoesNotDependOnTheOthers) {
  const Eigen::MatrixXd clean = Eigen::MatrixXd::Random(2 * kTimesEach, 6);
  const RandomStream stream(1, RandomPurpose::kTrainNoise);
  const Eigen::MatrixXd noisy = addNoise(clean, kOutputStddev, stream);
  EXPECT_EQ(addNoise(clean.leftCols(3), kOutputStddev, stream), noisy.leftCols(3));
  Eigen::MatrixXd with_failure = clean;
  with_failure.col(1).setConstant(std::nan(""));
  EXPECT_EQ(addNoise(with_failure, kOutputStddev, stream).rightCols(4), noisy.rightCols(4));
}

TEST(Noise, ReplicatesAreOtherDraws) {
  const Eigen::MatrixXd clean = Eigen::MatrixXd::Zero(2 * kTimesEach, 4);
  const RandomStream stream(1, RandomPurpose::kTrainNoise);
  EXPECT_EQ(addNoise(clean, kOutputStddev, stream, 0), addNoise(clean, kOutputStddev, stream));
  EXPECT_GT((addNoise(clean, kOutputStddev, stream, 1) - addNoise(clean, kOutputStddev, stream)).norm(), 1.0);
}

TEST(Noise, ScaleMultipliesEveryOutputAndZeroIsNone) {
  const ResponseLayout layout{{"y", "theta"}, {"m", "rad"}, Eigen::Vector2d(0.1, 0.2)};
  NoiseSpec spec;
  spec.scale = 2.0;
  spec.stddev = {{{"theta", {}}, 3.0}, {{"y", {}}, 0.1}};
  EXPECT_EQ(calcNoiseStddev(spec, layout), Eigen::Vector4d(0.2, 0.2, 6.0, 6.0));
  const Eigen::MatrixXd clean = Eigen::MatrixXd::Random(2 * kTimesEach, 3);
  EXPECT_EQ(addNoise(clean, Eigen::VectorXd::Zero(2 * kTimesEach), {1, RandomPurpose::kTrainNoise}), clean);
}

TEST(Noise, OfModesFillsTheirRows) {
  const ResponseLayout layout{{"y"}, {"m"}, Eigen::Vector2d(0.1, 0.2), 2};
  NoiseSpec spec;
  spec.scale = 2.0;
  spec.stddev = {{{"y", {}}, 0.1}};
  EXPECT_THROW(calcNoiseStddev(spec, layout), std::invalid_argument);
  spec.modes = ModesNoiseSpec{0.01, 3e-4};
  const Eigen::VectorXd expected = (Eigen::VectorXd(6) << 0.2, 0.2, 0.02, 0.02, 6e-4, 6e-4).finished();
  EXPECT_LT((calcNoiseStddev(spec, layout) - expected).norm(), 1e-17);
}

TEST(Noise, OfOutputsThatNobodyLooksAtNeedNotBeGiven) {
  const ResponseLayout layout{{"y"}, {"m"}, Eigen::VectorXd(), 1};
  NoiseSpec spec;
  spec.modes = ModesNoiseSpec{0.01, 3e-4};
  EXPECT_EQ(calcNoiseStddev(spec, layout), Eigen::Vector2d(0.01, 3e-4));
}

}  // namespace
}  // namespace twinmap
