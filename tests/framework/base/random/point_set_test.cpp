#include "framework/experiment/points/point_set.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace twinmap {
namespace {

using Eigen::MatrixXd;

MatrixXd sampleCube(DesignMethod method, int samples, std::uint64_t seed = 1) {
  return sampleUnitCube({method, samples, {}}, 3, seed, RandomPurpose::kTrainDesign);
}

TEST(PointSet, LatinHypercubeHasOnePointInEachSlice) {
  constexpr int kSamples = 37;
  const MatrixXd points = sampleCube(DesignMethod::kLatinHypercube, kSamples);
  for (int d = 0; d < points.rows(); ++d) {
    std::vector<int> count(kSamples, 0);
    for (int i = 0; i < kSamples; ++i) {
      ++count[static_cast<int>(points(d, i) * kSamples)];
    }
    EXPECT_EQ(count, std::vector<int>(kSamples, 1));
  }
}

TEST(PointSet, SobolAndUniformPrefixesAreSmallerSets) {
  for (const DesignMethod method : {DesignMethod::kSobol, DesignMethod::kUniform}) {
    EXPECT_EQ(sampleCube(method, 64).leftCols(20), sampleCube(method, 20));
  }
}

// A (shifted) Sobol sequence's mean converges much faster than the 1/sqrt(n) of random points.
TEST(PointSet, SobolFillsTheCubeEvenly) {
  const MatrixXd points = sampleCube(DesignMethod::kSobol, 1024);
  for (int d = 0; d < points.rows(); ++d) {
    EXPECT_NEAR(points.row(d).mean(), 0.5, 2e-3);
    for (int slice = 0; slice < 16; ++slice) {
      const auto inside = points.row(d).array() >= slice / 16.0 && points.row(d).array() < (slice + 1) / 16.0;
      EXPECT_NEAR(inside.count(), 64, 2);
    }
  }
}

TEST(PointSet, PointsStayInTheCubeAndChangeWithTheSeed) {
  for (const DesignMethod method : {DesignMethod::kLatinHypercube, DesignMethod::kNestedLatinHypercube,
                                    DesignMethod::kSobol, DesignMethod::kUniform}) {
    const MatrixXd points = sampleCube(method, 100);
    EXPECT_GE(points.minCoeff(), 0.0);
    EXPECT_LT(points.maxCoeff(), 1.0);
    EXPECT_NE(points, sampleCube(method, 100, 2));
  }
}

TEST(PointSet, IsScaledToTheBounds) {
  std::vector<ParameterSpec> parameters(2);
  parameters[0].bounds = {5.0, 15.0, {}};
  parameters[1].bounds = {-1e-4, 1e-4, {}};
  const PointSetSpec spec{DesignMethod::kUniform, 50, {}};
  const MatrixXd unit = sampleUnitCube(spec, 2, 1, RandomPurpose::kTestDesign);
  const MatrixXd points = samplePoints(spec, parameters, 1, RandomPurpose::kTestDesign);
  EXPECT_TRUE(points.row(0).isApprox(MatrixXd((5.0 + 10.0 * unit.row(0).array()).matrix()), 1e-15));
  EXPECT_GE(points.row(1).minCoeff(), -1e-4);
  EXPECT_LE(points.row(1).maxCoeff(), 1e-4);
}

}  // namespace
}  // namespace twinmap
