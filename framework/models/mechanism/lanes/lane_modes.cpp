#include "framework/models/mechanism/lanes/lane_modes.hpp"

#include "framework/models/mechanism/equilibrium.hpp"

namespace twinmap {

using Eigen::MatrixXd;
using Eigen::VectorXd;

LaneModes::LaneModes(const LaneModel& model) : model_(model) {
  if (model.loops) {
    assembly_.emplace(*model.loops);
  }
}

MatrixXd LaneModes::calcMatrix(const Eigen::Ref<const VectorXd>& parameters, const VectorXd& equilibrium) {
  if (!program_) {
    program_.emplace(model_.at_rest->get().linearization);
  }
  const Eigen::Index n = model_.coordinate_count, all = model_.counts.states - model_.hidden_count;
  VectorXd states = VectorXd::Zero(model_.counts.states);  // the hidden ones take no part
  states.head(all) = insertSpeeds(equilibrium, VectorXd::Zero(n));
  MatrixXd matrix = MatrixXd::Zero(all, all);
  matrix.block(0, n, n, n).setIdentity();
  matrix.bottomRows(all - n) = program_->calc({parameters, states}).reshaped(all - n, all);
  if (!assembly_) {
    return matrix;
  }
  const MatrixXd slopes = assembly_->calcSlopes(parameters, equilibrium.head(n));
  const auto prescribed = static_cast<Eigen::Index>(model_.prescribed.size());
  MatrixXd conditions = MatrixXd::Zero(slopes.rows() + prescribed, n);
  conditions.topRows(slopes.rows()) = slopes;
  for (Eigen::Index i = 0; i < prescribed; ++i) {
    conditions(slopes.rows() + i, model_.prescribed[static_cast<std::size_t>(i)]) = 1.0;
  }
  return reduceToFreedoms(matrix, conditions);
}

VectorXd LaneModes::calc(const Eigen::Ref<const VectorXd>& parameters, const VectorXd& equilibrium,
                         int count) {
  return collectLowestModes(calcMatrix(parameters, equilibrium), count);
}

}  // namespace twinmap
