#include "framework/estimation/surrogate/surrogate_file.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "framework/base/files/temporary_folder.hpp"
#include "framework/estimation/surrogate/fit_forward.hpp"
#include "framework/estimation/surrogate/score_inversion.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of an oscillation of 24 samples in three windows.
ForwardSurrogate fitExample() {
  constexpr Index kTimes = 24, kPoints = 40;
  ForwardSamples samples;
  samples.points.resize(2, kPoints);
  samples.clean_features.resize(kTimes, kPoints);
  for (Index j = 0; j < kPoints; ++j) {
    samples.points(0, j) = -1.0 + 2.0 * static_cast<double>(j) / (kPoints - 1);
    samples.points(1, j) = std::sin(7.0 * static_cast<double>(j));
    for (Index i = 0; i < kTimes; ++i) {
      const double t = 0.25 * static_cast<double>(i + 1);
      samples.clean_features(i, j) = std::exp(-(0.2 + 0.1 * samples.points(0, j)) * t) *
                                     std::sin((2.0 + 0.4 * samples.points(1, j)) * t);
    }
  }
  for (Index i = 0; i < kTimes; ++i) {
    samples.infos.push_back({"", "m", 0, 0.25 * static_cast<double>(i + 1)});
  }
  samples.noise_covariance = 4e-4 * MatrixXd::Identity(kTimes, kTimes);
  return fitForward(samples, {}, {}).surrogate;
}

TEST(SurrogateFile, GivesASurrogateThatInfersTheSameBits) {
  const ForwardSurrogate surrogate = fitExample();
  const TemporaryFolder folder;
  const auto path = folder.getPath() / "surrogate.h5";
  Hdf5Writer writer(path);
  writeForward(writer, "/some/surrogate", surrogate);
  writer.close();
  const ForwardSurrogate read = readForward(Hdf5Reader(path), "/some/surrogate");
  ASSERT_EQ(read.windows.size(), surrogate.windows.size());
  EXPECT_EQ(read.projection, surrogate.projection);
  ScoreInversion before(surrogate, makeUniformPrior(2)), after(read, makeUniformPrior(2));
  for (Index i = 0; i < 10; ++i) {
    const VectorXd scores = surrogate.scores.col(4 * i).array() + 0.3;
    const gp::Moments expected = before.infer(scores, VectorXd(0)), found = after.infer(scores, VectorXd(0));
    EXPECT_EQ(found.mean, expected.mean);
    EXPECT_EQ(found.covariance, expected.covariance);
  }
}

TEST(SurrogateFile, RefusesAFileThatHasNone) {
  const TemporaryFolder folder;
  const auto path = folder.getPath() / "other.h5";
  Hdf5Writer writer(path);
  writer.write("/some/number", 1.0);
  writer.close();
  EXPECT_THROW(readForward(Hdf5Reader(path), "/some"), std::runtime_error);
}

}  // namespace
}  // namespace twinmap
