#include "framework/features/feature_transform.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap {
namespace {

TEST(FeatureTransform, ZScoreByHand) {
  Eigen::MatrixXd features(2, 3);
  features << 1, 2, 3, 10, 10, 40;
  const FeatureTransform transform = fitTransform({TransformStep::kZScore}, features);
  EXPECT_EQ(transform.offset, Eigen::Vector2d(2, 20));
  EXPECT_NEAR(transform.scale[0], 1.0, 1e-15);
  EXPECT_NEAR(transform.scale[1], std::sqrt(300.0), 1e-14);
  const Eigen::MatrixXd inputs = transform.apply(features);
  EXPECT_NEAR(inputs(0, 2), 1.0, 1e-15);
  EXPECT_NEAR(inputs(1, 0), -10.0 / std::sqrt(300.0), 1e-15);
}

TEST(FeatureTransform, ConstantFeaturesSayNothing) {
  Eigen::MatrixXd features(3, 4);
  features.row(0).setConstant(0.1);
  features.row(1) << 1e9, 1e9 + 1e-7, 1e9, 1e9;  // rounding only
  features.row(2).setZero();
  const Eigen::MatrixXd inputs = fitTransform({TransformStep::kZScore}, features).apply(features);
  EXPECT_LT(inputs.cwiseAbs().maxCoeff(), 1e-6);
}

TEST(FeatureTransform, WithoutStepsItChangesNothingAndTwiceIsOnce) {
  const Eigen::MatrixXd features = Eigen::MatrixXd::Random(4, 20);
  EXPECT_EQ(fitTransform({}, features).apply(features), features);
  const Eigen::MatrixXd once = fitTransform({TransformStep::kZScore}, features).apply(features);
  const Eigen::MatrixXd twice =
      fitTransform({TransformStep::kZScore, TransformStep::kZScore}, features).apply(features);
  EXPECT_LT((once - twice).cwiseAbs().maxCoeff(), 1e-14);
}

}  // namespace
}  // namespace twinmap
