#include "framework/models/mechanism/loops/assembly.hpp"

#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void Assembly::assemble(const VectorXd& parameters, MatrixXd& states) {
  const Index n = model_.coordinates;
  const VectorXd closed = close(parameters, states.col(0).head(n));
  const VectorXd rates = calcRates(parameters, closed, states.col(0).segment(n, n));
  const ClosureValues at = program_.calc(parameters, closed, rates);
  if (states.cols() > 1) {
    moveDerivatives(at, states);
  }
  states.col(0).head(n) = closed;
  states.col(0).segment(n, n) = at.speeds;
}

VectorXd Assembly::close(const VectorXd& parameters, const VectorXd& coordinates) {
  VectorXd closed = closeLoops(program_, parameters, coordinates, model_.plan.rows, model_.plan.dependent);
  requireClosed(parameters, closed);
  return closed;
}

VectorXd Assembly::calcRates(const VectorXd& parameters, const VectorXd& closed, VectorXd rates) {
  const LoopPlan& plan = model_.plan;
  const ClosureValues given = program_.calc(parameters, closed, rates);
  const MatrixXd slopes = given.rate_columns(plan.rows, plan.dependent_rates);
  rates(plan.dependent_rates) -= linalg::solveMinimumNorm(slopes, given.rates(plan.rows));
  return rates;
}

/// With c(q, p) = 0 and d(q, v, p) = 0, which is dc/dq v but for rolling, along the solution, what is not
/// held changes as it must.
void Assembly::moveDerivatives(const ClosureValues& at, MatrixXd& states) const {
  const Index n = model_.coordinates, p = states.cols() - 1;
  const LoopPlan& plan = model_.plan;
  MatrixXd coordinates = states.topRightCorner(n, p), rates = states.block(n, 1, n, p);
  const MatrixXd open = at.forced(Eigen::all, directions_) + at.slopes * coordinates;
  const MatrixXd of_coordinates = at.slopes(plan.rows, plan.dependent);
  coordinates(plan.dependent, Eigen::all) -=
      linalg::fitLinear(of_coordinates, open(plan.rows, Eigen::all)).coefficients;
  const MatrixXd moving =
      at.forced_rates(Eigen::all, directions_) + at.rate_slopes * coordinates + at.rate_columns * rates;
  const MatrixXd of_rates = at.rate_columns(plan.rows, plan.dependent_rates);
  rates(plan.dependent_rates, Eigen::all) -=
      linalg::fitLinear(of_rates, moving(plan.rows, Eigen::all)).coefficients;
  states.topRightCorner(n, p) = coordinates;
  states.block(n, 1, n, p) = at.speed_slopes * coordinates + at.speed_columns * rates;
}

void Assembly::requireClosed(const VectorXd& parameters, const VectorXd& coordinates) {
  const std::string open = describeOpenLoops(model_, program_.calc(parameters, coordinates));
  if (!open.empty()) {
    throw SimulationFailure("the loops cannot be closed at the start: " + open);
  }
}

VectorXd Assembly::calcDistances(const VectorXd& parameters, const VectorXd& coordinates) {
  return program_.calc(parameters, coordinates).distances(model_.plan.rows);
}

MatrixXd Assembly::calcSlopes(const VectorXd& parameters, const VectorXd& coordinates) {
  return program_.calc(parameters, coordinates).slopes(model_.plan.rows, Eigen::all);
}

VectorXd getParameters(const ModelContext& context) {
  return VectorXd::NullaryExpr(countSampled(context.model),
                               [&](Index i) { return context.numbers.getValues().get(static_cast<int>(i)); });
}

}  // namespace twinmap
