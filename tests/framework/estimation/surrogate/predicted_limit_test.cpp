#include "framework/estimation/surrogate/predicted_limit.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// A uniform variable on [-1, 1] has the variance 1/3, the precision 3.
TEST(ScoreLimit, IsTheBoxWhereNothingIsMeasured) {
  const VectorXd stddev = calcScoreLimit(MatrixXd::Zero(2, 2), makeUniformPrior(2));
  EXPECT_NEAR(stddev[0], std::sqrt(1.0 / 3.0), 1e-15);
  EXPECT_NEAR(stddev[1], std::sqrt(1.0 / 3.0), 1e-15);
}

// ((97 + 3, 40), (40, 17 + 3))^-1 has the diagonal (20, 100) / (2000 - 1600).
TEST(ScoreLimit, IsTheInverseOfInformationAndBox) {
  const MatrixXd information = (MatrixXd(2, 2) << 97.0, 40.0, 40.0, 17.0).finished();
  const VectorXd stddev = calcScoreLimit(information, makeUniformPrior(2));
  EXPECT_NEAR(stddev[0], std::sqrt(20.0 / 400.0), 1e-14);
  EXPECT_NEAR(stddev[1], std::sqrt(100.0 / 400.0), 1e-14);
}

}  // namespace
}  // namespace twinmap
