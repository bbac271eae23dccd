#include "framework/estimation/estimate.hpp"

#include <gtest/gtest.h>

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;

const Vector2d kCenter(10.0, -1.0), kHalfWidth(2.0, 0.5);

TEST(ShrinkToBounds, LeavesAnswersNoWiderThanTheBounds) {
  Eigen::VectorXd mean = Vector2d(13.0, -1.2), stddev = Vector2d(1.9, 0.5);
  shrinkToBounds(kCenter, kHalfWidth, mean, stddev);
  EXPECT_EQ(mean, Vector2d(13.0, -1.2));
  EXPECT_EQ(stddev, Vector2d(1.9, 0.5));
}

TEST(ShrinkToBounds, DrawsWiderOnesTowardsTheCenter) {
  Eigen::VectorXd mean = Vector2d(-190.0, -1.2), stddev = Vector2d(200.0, 0.1);
  shrinkToBounds(kCenter, kHalfWidth, mean, stddev);
  EXPECT_EQ(mean, Vector2d(8.0, -1.2));  // a deviation of 200, a hundredth of it
  EXPECT_EQ(stddev, Vector2d(2.0, 0.1));
}

/// Of two parameters, the first of two far answers.
Estimates makeMixed() {
  const Mixture mixture{Vector2d(0.25, 0.75),
                        (MatrixXd(2, 2) << -90.0, 110.0, -1.0, -0.9).finished(),
                        (MatrixXd(2, 2) << 4.0, 30.0, 0.1, 0.2).finished(),
                        {MatrixXd::Identity(2, 2), MatrixXd::Identity(2, 2)}};
  const MatrixXd covariance = calcCovariance(mixture);
  return {calcMean(mixture), covariance.diagonal().cwiseSqrt(), {calcCorrelation(covariance)}, {mixture}};
}

TEST(ShrinkToBounds, ShrinksMixturesAsAWhole) {
  Estimates found = makeMixed();
  const MatrixXd correlation = found.correlations.front();
  shrinkToBounds(kCenter, kHalfWidth, found);
  const Mixture& mixture = found.mixtures.front();
  EXPECT_NEAR(found.stddev(0, 0), 2.0, 1e-12);
  EXPECT_LT((calcMean(mixture) - found.mean).norm(), 1e-12);
  const MatrixXd covariance = calcCovariance(mixture);
  EXPECT_LT((covariance.diagonal().cwiseSqrt() - found.stddev).norm(), 1e-12);
  EXPECT_LT((calcCorrelation(covariance) - correlation).norm(), 1e-12);
  EXPECT_LT((mixture.means.row(1) - makeMixed().mixtures.front().means.row(1)).norm(), 1e-12);
}

}  // namespace
}  // namespace twinmap
