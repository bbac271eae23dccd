#pragma once

#include <utility>
#include <vector>

#include "framework/models/mechanism/loops/closure_program.hpp"

namespace twinmap {

/// Initial states of a machine with loops: coordinates and rates that meet its constraints. Not thread safe;
/// one for each thread.
class Assembly {
 public:
  /// `model` must outlive the object. directions: the parameters by which states have derivatives.
  explicit Assembly(const LoopModel& model, std::vector<int> directions = {})
      : model_(model), program_(model), directions_(std::move(directions)) {}

  /// `states`: [coordinates; their rates; states of first order] as the file gives them, then either nothing
  /// or their derivatives with respect to each direction, one column each. They become [coordinates; speeds;
  /// states] that meet the constraints, where the plan's dependent coordinates and rates are moved, and their
  /// derivatives, by implicit differentiation. Throws SimulationFailure, with what stays open and by how
  /// much.
  void assemble(const Eigen::VectorXd& parameters, Eigen::MatrixXd& states);

  /// Coordinates that close the loops, where the dependent ones are moved. Throws as assemble() does.
  Eigen::VectorXd close(const Eigen::VectorXd& parameters, const Eigen::VectorXd& coordinates);
  /// Rates of closed coordinates that keep the loops closed, where the dependent ones are moved.
  Eigen::VectorXd calcRates(const Eigen::VectorXd& parameters, const Eigen::VectorXd& closed,
                            Eigen::VectorXd rates);

  /// Throws SimulationFailure where coordinates, such as those of an equilibrium, leave a constraint open.
  void requireClosed(const Eigen::VectorXd& parameters, const Eigen::VectorXd& coordinates);

  /// Distances from the independent conditions.
  Eigen::VectorXd calcDistances(const Eigen::VectorXd& parameters, const Eigen::VectorXd& coordinates);
  /// Their derivatives with respect to the coordinates.
  Eigen::MatrixXd calcSlopes(const Eigen::VectorXd& parameters, const Eigen::VectorXd& coordinates);

 private:
  void moveDerivatives(const ClosureValues& at, Eigen::MatrixXd& states) const;

  const LoopModel& model_;
  ClosureProgram program_;
  std::vector<int> directions_;
};

/// The parameters that the context's numbers were updated to.
Eigen::VectorXd getParameters(const ModelContext& context);

}  // namespace twinmap
