#pragma once

#include <memory>
#include <optional>

#include "framework/models/mechanism/equilibrium.hpp"
#include "framework/models/mechanism/lanes/lane_model.hpp"
#include "framework/models/mechanism/single_program.hpp"

namespace twinmap {

/// The accelerations and rates at rest, and what loops are open by, by the recorded program, with exact
/// derivatives.
class RestProgram : public RestAccelerations {
 public:
  explicit RestProgram(const LaneModel& model);

  void setParameters(const Eigen::Ref<const Eigen::VectorXd>& parameters) { parameters_ = parameters; }
  Eigen::VectorXd calc(const Eigen::VectorXd& equilibrium) override;
  Eigen::MatrixXd calcJacobian(const Eigen::VectorXd& equilibrium) override;

  /// How the equilibrium, found from `start`, changes with each parameter (its size x parameters):
  /// -J^+ da/dp, and the start's own change along directions that no force depends on.
  Eigen::MatrixXd calcSlopes(const Eigen::VectorXd& equilibrium, const Eigen::MatrixXd& start_slopes);

 private:
  Eigen::VectorXd calcAll(const Eigen::VectorXd& equilibrium);
  /// What does not move towards an equilibrium has no column: what is prescribed, and indifferent states.
  void hold(const Eigen::VectorXd& all, Eigen::MatrixXd& jacobian) const;

  Eigen::Index coordinates_, count_;  ///< count_: with the states of first order
  Eigen::Index residuals_;            ///< with the conditions of loops
  Eigen::Index pivots_ = 0, directions_;
  std::vector<int> prescribed_;
  const char* singular_;
  Eigen::VectorXd parameters_;
  std::shared_ptr<DeferredRest> at_rest_;
  std::optional<SingleProgram> program_;  ///< when first used
};

}  // namespace twinmap
