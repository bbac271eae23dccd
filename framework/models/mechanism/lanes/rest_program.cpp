#include "framework/models/mechanism/lanes/rest_program.hpp"

#include "framework/simulation/simulation_failure.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::MatrixXd;
using Eigen::VectorXd;

RestProgram::RestProgram(const LaneModel& model)
    : coordinates_(model.coordinate_count),
      count_(model.coordinate_count + model.getFirstOrderCount()),
      residuals_(count_ + model.getClosureCount()),
      directions_(model.countDirections()),
      prescribed_(model.prescribed),
      singular_(getSingularReason(model)),
      at_rest_(model.at_rest) {}

VectorXd RestProgram::calcAll(const VectorXd& equilibrium) {
  if (!program_) {
    const RestPrograms& programs = at_rest_->get();
    pivots_ = programs.pivot_count;
    program_.emplace(programs.residuals);
  }
  const VectorXd all = program_->calc({parameters_, insertSpeeds(equilibrium, VectorXd::Zero(coordinates_))});
  if ((all.segment(residuals_, pivots_).array() <= 0.0)
          .any()) {  // false for NaN, which is not an equilibrium anyway
    throw SimulationFailure(singular_);
  }
  return all;
}

void RestProgram::hold(const VectorXd& all, MatrixXd& jacobian) const {
  holdIndifferentStates(all.head(count_), coordinates_, jacobian);
  for (const int coordinate : prescribed_) {
    jacobian.col(coordinate).setZero();
  }
}

VectorXd RestProgram::calc(const VectorXd& equilibrium) {
  return calcAll(equilibrium).head(residuals_);
}

MatrixXd RestProgram::calcJacobian(const VectorXd& equilibrium) {
  const VectorXd all = calcAll(equilibrium);
  MatrixXd jacobian = all.segment(residuals_ + pivots_, residuals_ * count_).reshaped(residuals_, count_);
  hold(all, jacobian);
  return jacobian;
}

MatrixXd RestProgram::calcSlopes(const VectorXd& equilibrium, const MatrixXd& start_slopes) {
  const VectorXd all = calcAll(equilibrium);
  MatrixXd jacobian = all.segment(residuals_ + pivots_, residuals_ * count_).reshaped(residuals_, count_);
  const MatrixXd forced = all.tail(residuals_ * directions_).reshaped(residuals_, directions_);
  const MatrixXd changes = forced + jacobian * start_slopes;
  hold(all, jacobian);
  return start_slopes - linalg::fitLinear(jacobian, changes).coefficients;
}

}  // namespace twinmap
