#include "framework/estimation/box_points.hpp"

#include <gtest/gtest.h>

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

TEST(BoxPoints, ReachEndsAtTheFirstBoundOnTheWay) {
  EXPECT_DOUBLE_EQ(calcReach(Vector2d(0.5, 0.0), Vector2d(0.25, 1.0)), 1.0);
  EXPECT_DOUBLE_EQ(calcReach(Vector2d(0.5, 0.0), Vector2d(-0.25, 0.0)), 6.0);
  EXPECT_DOUBLE_EQ(calcReach(Vector2d(0.5, 0.0), Vector2d(-0.25, 0.0), 2.0), 2.0);  // at most
  EXPECT_EQ(calcReach(Vector2d(1.0, 0.0), Vector2d(0.1, 0.0)), 0.0);
  EXPECT_TRUE(std::isinf(calcReach(Vector2d(0.5, 0.0), Vector2d(0.0, 0.0))));
}

TEST(BoxPoints, ReachEndsAtLimitsOfOtherBoxes) {
  EXPECT_DOUBLE_EQ(
      calcReach(Vector2d(1.0, 1.0), Vector2d(1.0, -1.0), Vector2d(0.0, 0.5), Vector2d(4.0, 4.0), 9.0), 0.5);
}

TEST(BoxPoints, MapsColumnsAlsoToOtherLengths) {
  const MatrixXd points = (MatrixXd(2, 2) << 1.0, 2.0, 3.0, 4.0).finished();
  const MatrixXd sums = mapColumns(points, [](const VectorXd& x) { return VectorXd::Constant(1, x.sum()); });
  EXPECT_EQ(sums, (MatrixXd(1, 2) << 4.0, 6.0).finished());
  EXPECT_EQ(mapColumns(MatrixXd(2, 0), [](const VectorXd& x) { return x; }).rows(), 2);
}

TEST(BoxPoints, AsksNothingOutsideTheBox) {
  const MatrixXd points = (MatrixXd(1, 4) << -1.0, 1.5, 0.25, -2.0).finished();
  int asked = 0;
  const VectorXd found = calcInBox(points, [&](const MatrixXd& inside) {
    asked += static_cast<int>(inside.cols());
    return VectorXd(2.0 * inside.row(0).transpose());
  });
  const double none = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(found, Eigen::Vector4d(-2.0, none, 0.5, none));
  EXPECT_EQ(asked, 2);
  EXPECT_EQ(calcInBox(points.col(1), [&](const MatrixXd&) { return VectorXd(++asked); })[0], none);
  EXPECT_EQ(asked, 2);
}

}  // namespace
}  // namespace twinmap
