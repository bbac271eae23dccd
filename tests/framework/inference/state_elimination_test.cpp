#include "framework/inference/segments/state_elimination.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cstdlib>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kRows = 30, kStates = 3, kParameters = 2;

/// A segment's linear model, from reproducible numbers.
struct Segment {
  Segment() {
    std::srand(7);
    by_state = MatrixXd::Random(kRows, kStates);
    by_parameters = MatrixXd::Random(kRows, kParameters);
    residual = VectorXd::Random(kRows);
  }

  StateElimination eliminate(double precision, const VectorXd& ahead) const {
    return eliminateState(residual, by_state, by_parameters, {VectorXd::Constant(kStates, precision), ahead});
  }

  MatrixXd by_state, by_parameters;
  VectorXd residual;
};

TEST(StateElimination, ProjectsTheColumnsOfTheStateOut) {
  const Segment segment;
  const StateElimination found = segment.eliminate(1e-8, VectorXd::Zero(kStates));
  const MatrixXd q = segment.by_state.householderQr().householderQ() * MatrixXd::Identity(kRows, kStates);
  const MatrixXd projector = MatrixXd::Identity(kRows, kRows) - q * q.transpose();
  const MatrixXd& j = segment.by_parameters;
  EXPECT_LT((found.jacobian.transpose() * found.jacobian - j.transpose() * projector * j).norm(), 1e-12);
  EXPECT_LT(
      (found.jacobian.transpose() * found.residual - j.transpose() * projector * segment.residual).norm(),
      1e-12);
  EXPECT_NEAR(found.residual.squaredNorm(), segment.residual.dot(projector * segment.residual), 1e-12);
  EXPECT_NEAR(found.gain, segment.residual.squaredNorm() - found.residual.squaredNorm(), 1e-12);
  EXPECT_NEAR(found.told, kStates, 1e-12);
  const VectorXd best = segment.by_state.colPivHouseholderQr().solve(segment.residual);
  EXPECT_LT((found.step - best).norm(), 1e-12);
  const MatrixXd slopes = segment.by_state.colPivHouseholderQr().solve(-j);
  EXPECT_LT((found.slopes - slopes).norm(), 1e-12);
}

// Row t is what a fit to the rows before it leaves, over the standard deviation of that prediction.
TEST(StateElimination, LeavesRecursiveResiduals) {
  const Segment segment;
  const StateElimination found = segment.eliminate(1e-8, VectorXd::Zero(kStates));
  for (const Index t : {kStates, kStates + 5, kRows - 1}) {
    const MatrixXd before = segment.by_state.topRows(t);
    const VectorXd state = before.colPivHouseholderQr().solve(segment.residual.head(t));
    const VectorXd row = segment.by_state.row(t).transpose();
    const double variance = 1.0 + row.dot((before.transpose() * before).ldlt().solve(row));
    EXPECT_NEAR(std::abs(found.residual[t]),
                std::abs(segment.residual[t] - row.dot(state)) / std::sqrt(variance), 1e-9);
  }
}

TEST(StateElimination, TakesThePriorAsRowsOfItsOwn) {
  const Segment segment;
  const VectorXd ahead = VectorXd::LinSpaced(kStates, -0.5, 0.5);
  constexpr double kPrecision = 2.0;
  const StateElimination found = segment.eliminate(kPrecision, ahead);
  MatrixXd rows(kRows + kStates, kStates);
  rows << segment.by_state, kPrecision * MatrixXd::Identity(kStates, kStates);
  VectorXd all(kRows + kStates);
  all << segment.residual, kPrecision * ahead;
  const VectorXd best = rows.colPivHouseholderQr().solve(all);
  EXPECT_LT((found.step - best).norm(), 1e-12);
  EXPECT_NEAR(found.residual.squaredNorm(), (all - rows * best).squaredNorm(), 1e-12);
  EXPECT_LT(found.told, kStates);
}

TEST(StateElimination, LeavesAStateThatNoRowTellsWhereThePriorHasIt) {
  Segment segment;
  segment.by_state.col(1).setZero();
  const VectorXd ahead = VectorXd::Constant(kStates, 0.25);
  const StateElimination found = segment.eliminate(1e-3, ahead);
  EXPECT_NEAR(found.step[1], 0.25, 1e-12);
  EXPECT_NEAR(found.told, kStates - 1, 1e-5);
}

}  // namespace
}  // namespace twinmap
