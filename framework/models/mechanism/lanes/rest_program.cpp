#include "framework/models/mechanism/lanes/rest_program.hpp"

#include "framework/simulation/simulation_failure.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::MatrixXd;
using Eigen::VectorXd;

RestProgram::RestProgram(const LaneModel& model)
    : count_(model.counts.states / 2), directions_(model.directions), program_(model.rest) {}

VectorXd RestProgram::calcAll(const VectorXd& coordinates) {
  const VectorXd all = program_.calc({parameters_, coordinates});
  if ((all.segment(count_, count_).array() <= 0.0)
          .any()) {  // false for NaN, which is not an equilibrium anyway
    throw SimulationFailure(kSingularMassMatrix);
  }
  return all;
}

VectorXd RestProgram::calc(const VectorXd& coordinates) {
  return calcAll(coordinates).head(count_);
}

MatrixXd RestProgram::calcJacobian(const VectorXd& coordinates) {
  return calcAll(coordinates).segment(2 * count_, count_ * count_).reshaped(count_, count_);
}

MatrixXd RestProgram::calcSlopes(const VectorXd& coordinates, const MatrixXd& start_slopes) {
  const VectorXd all = calcAll(coordinates);
  const MatrixXd jacobian = all.segment(2 * count_, count_ * count_).reshaped(count_, count_);
  const MatrixXd forced = all.tail(count_ * directions_).reshaped(count_, directions_);
  return start_slopes - linalg::fitLinear(jacobian, forced + jacobian * start_slopes).coefficients;
}

}  // namespace twinmap
