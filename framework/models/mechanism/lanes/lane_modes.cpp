#include "framework/models/mechanism/lanes/lane_modes.hpp"

namespace twinmap {

using Eigen::MatrixXd;
using Eigen::VectorXd;

LaneModes::LaneModes(const LaneModel& model)
    : coordinate_count_(model.counts.states / 2), program_(model.linearization) {}

VectorXd LaneModes::calc(const Eigen::Ref<const VectorXd>& parameters, const VectorXd& coordinates,
                         int count) {
  const Eigen::Index n = coordinate_count_;
  VectorXd states = VectorXd::Zero(2 * n);
  states.head(n) = coordinates;
  MatrixXd matrix = MatrixXd::Zero(2 * n, 2 * n);
  matrix.topRightCorner(n, n).setIdentity();
  matrix.bottomRows(n) = program_.calc({parameters, states}).reshaped(n, 2 * n);
  return collectLowestModes(matrix, count);
}

}  // namespace twinmap
