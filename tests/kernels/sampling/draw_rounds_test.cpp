#include "kernels/sampling/draw_rounds.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace twinmap::importance {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// `even` draws of equal weight a round; the others are impossible.
int countRounds(Eigen::Index even) {
  return drawInRounds(
             [&](int round) {
               VectorXd log_weights = VectorXd::Constant(80, -std::numeric_limits<double>::infinity());
               log_weights.head(even).setZero();
               return Round{MatrixXd::Constant(2, 80, round), log_weights};
             },
             4)
      .rounds;
}

TEST(DrawInRounds, GoesOnWhileTooFewCountAndMoreMayHelp) {
  EXPECT_EQ(countRounds(80), 2);
  EXPECT_EQ(countRounds(30), 4);
  EXPECT_EQ(countRounds(10), 1);  // four times as many would be too few
}

TEST(DrawInRounds, KeepsAllDraws) {
  const AdaptiveDraws drawn = drawInRounds(
      [](int round) {
        return Round{MatrixXd::Constant(1, 60, round), VectorXd::Zero(60)};
      },
      4);
  EXPECT_EQ(drawn.draws.points.cols(), 120);
  EXPECT_NEAR(calcMean(drawn.draws)[0], 0.5, 1e-12);
  EXPECT_NEAR(drawn.effective_sample_size, 120.0, 1e-9);
}

}  // namespace
}  // namespace twinmap::importance
