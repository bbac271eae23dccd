#include "tests/framework/data/features/golden/transform_golden.hpp"

#include <gtest/gtest.h>

#include "framework/data/reduction/affine_step.hpp"
#include "framework/data/reduction/feature_transform.hpp"
#include "framework/data/reduction/mutual_information.hpp"
#include "framework/data/reduction/partial_least_squares.hpp"
#include "framework/data/reduction/selections.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Values written sample by sample -> rows x samples.
MatrixXd toMatrix(const std::vector<double>& values, Index rows) {
  return Eigen::Map<const MatrixXd>(values.data(), rows, static_cast<Index>(values.size()) / rows);
}

LabelledFeatures makeGoldenSamples() {
  LabelledFeatures samples;
  samples.features = toMatrix(golden::kFeatures, golden::kFeatureCount);
  samples.parameters = toMatrix(golden::kParameters, 2);
  samples.noise_covariance = toMatrix(golden::kNoiseCovariance, golden::kFeatureCount);
  samples.replicates = golden::kReplicates;
  return samples;
}

MatrixXd transform(const TransformStepSpec& step) {
  const LabelledFeatures samples = makeGoldenSamples();
  return fitTransform({step}, samples).apply(samples.features);
}

/// Equal up to the sign of each row: numbers of order 1 to 100 in some hundred operations of either side.
void expectSameRows(const MatrixXd& rows, const MatrixXd& expected) {
  ASSERT_EQ(rows.rows(), expected.rows());
  for (Index i = 0; i < rows.rows(); ++i) {
    const double sign = rows.row(i).dot(expected.row(i)) < 0.0 ? -1.0 : 1.0;
    EXPECT_LT((sign * rows.row(i) - expected.row(i)).norm(), 1e-11 * expected.row(i).norm()) << i;
  }
}

TEST(TransformGolden, ZScore) {
  const MatrixXd expected = toMatrix(golden::kStandardised, golden::kFeatureCount);
  EXPECT_LT((transform({ZScoreSpec{}, {}}) - expected).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(TransformGolden, WhitenByStddevAndByCovariance) {
  const MatrixXd by_stddev = toMatrix(golden::kWhitenedByStddev, golden::kFeatureCount);
  EXPECT_LT((transform({WhitenSpec{}, {}}) - by_stddev).norm(), 1e-13 * by_stddev.norm());
  const MatrixXd by_covariance = toMatrix(golden::kWhitenedByCovariance, golden::kFeatureCount);
  EXPECT_LT((transform({WhitenSpec{WhitenBy::kCovariance}, {}}) - by_covariance).norm(),
            1e-12 * by_covariance.norm());
}

TEST(TransformGolden, PrincipalComponents) {
  const MatrixXd scores = transform({PrincipalComponentsSpec{golden::kComponents, {}}, {}});
  expectSameRows(scores, toMatrix(golden::kPrincipalComponents, golden::kComponents));
  const VectorXd variances = toMatrix(golden::kPrincipalVariances, golden::kComponents);
  const VectorXd mine = scores.rowwise().squaredNorm() / (static_cast<double>(scores.cols()) - 1.0);
  EXPECT_LT((mine - variances).norm(), 1e-12 * variances.norm());
}

TEST(TransformGolden, PartialLeastSquares) {
  expectSameRows(transform({PartialLeastSquaresSpec{golden::kComponents}, {}}),
                 toMatrix(golden::kPartialLeastSquares, golden::kComponents));
}

TEST(TransformGolden, LinearPredictionByPartialLeastSquares) {
  const LabelledFeatures samples = makeGoldenSamples();
  const MatrixXd centered = samples.features.colwise() - samples.features.rowwise().mean().eval();
  const MatrixXd targets = fitZScore(samples.parameters).apply(samples.parameters);
  const PartialLeastSquares model = calcPartialLeastSquares(centered, targets, golden::kComponents);
  const MatrixXd prediction = model.loadings * (model.rotations.transpose() * centered);
  EXPECT_LT((prediction - toMatrix(golden::kLinearPrediction, 2)).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(TransformGolden, CrossValidationOfPartialLeastSquares) {
  const MatrixXd errors = calcCrossValidationErrors(makeGoldenSamples(), golden::kComponents, golden::kFolds);
  const MatrixXd expected = toMatrix(golden::kHeldOutErrors, golden::kComponents).transpose();
  EXPECT_LT((errors - expected).cwiseAbs().maxCoeff(), 1e-11);
}

/// The estimate depends on counts of samples alone, so it is equal to rounding (scikit-learn's jitter of
/// 1e-10 changes no count).
TEST(TransformGolden, MutualInformation) {
  const LabelledFeatures samples = makeGoldenSamples();
  const Index simulations = samples.features.cols() / samples.replicates;
  const auto rank = [&](const MatrixXd& rows, Index row) {
    return rankValues(rows.row(row).head(simulations).transpose());
  };
  for (Index i = 0; i < golden::kFeatureCount; ++i) {
    const RankedValues feature = rank(samples.features, i);
    EXPECT_NEAR(calcMutualInformation(feature, rank(samples.parameters, 0), 3), golden::kWithParameter0[i],
                1e-12);
    EXPECT_NEAR(calcMutualInformation(rank(samples.parameters, 1), feature, 3), golden::kWithParameter1[i],
                1e-12);
    if (i > 0) {
      EXPECT_NEAR(calcMutualInformation(feature, rank(samples.features, 0), 3), golden::kWithFeature0[i - 1],
                  1e-12);
    }
  }
}

TEST(TransformGolden, RelevanceWithoutRedundancy) {
  const std::vector<Index> selected =
      selectByMutualInformation({golden::kComponents, 3}, makeGoldenSamples());
  EXPECT_EQ(std::vector<int>(selected.begin(), selected.end()), golden::kSelected);
}

}  // namespace
}  // namespace twinmap
