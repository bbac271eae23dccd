#include "framework/optimal_design/criterion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap::experiment_design {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Kind = Criterion::Kind;

MatrixXd makeInformation() {
  MatrixXd information(3, 3);
  information << 5.0, 1.0, 0.5, 1.0, 4.0, -0.3, 0.5, -0.3, 9.0;
  return information;
}

Criterion makeCriterion(Kind kind) {
  return {kind, kind == Kind::weighted ? VectorXd(Eigen::Vector3d(1.0, 0.0, 2.0)) : VectorXd()};
}

TEST(Criterion, IsThatOfIndependentParametersByHand) {
  const MatrixXd information = Eigen::Vector2d(4.0, 16.0).asDiagonal();
  EXPECT_NEAR(calcCost({Kind::d_optimal, {}}, information), -std::log(64.0) / 2.0, 1e-14);
  EXPECT_NEAR(calcCost({Kind::a_optimal, {}}, information), std::log((0.25 + 0.0625) / 2.0), 1e-14);
  EXPECT_NEAR(calcCost({Kind::e_optimal, {}}, information), -std::log(4.0), 1e-14);
  EXPECT_NEAR(calcCost({Kind::weighted, Eigen::Vector2d(0.0, 3.0)}, information), std::log(0.0625), 1e-14);
}

TEST(Criterion, FallsByTheLogarithmOfTheInformation) {
  for (const Kind kind : {Kind::d_optimal, Kind::a_optimal, Kind::e_optimal, Kind::weighted}) {
    const Criterion criterion = makeCriterion(kind);
    EXPECT_NEAR(calcCost(criterion, 3.0 * makeInformation()),
                calcCost(criterion, makeInformation()) - std::log(3.0), 1e-12);
  }
}

TEST(Criterion, IsNanWhereNothingIsDetermined) {
  EXPECT_TRUE(std::isnan(calcCost({Kind::d_optimal, {}}, MatrixXd::Zero(2, 2))));
}

}  // namespace
}  // namespace twinmap::experiment_design
