#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/models/mechanism/loops/loop_model.hpp"
#include "framework/models/mechanism/single_program.hpp"

namespace twinmap {

/// The conditions c(q, p) = 0 of all constraints of a model at coordinates q and their rates v, in the file's
/// order, with exact derivatives; and the speeds behind the rates.
struct ClosureValues {
  Eigen::VectorXd distances;                    ///< c; m, or the unit of a gear's coordinate; 0 of rolling
  Eigen::MatrixXd slopes;                       ///< dc/dq
  Eigen::VectorXd rates;                        ///< dc/dq v; of rolling the slip
  Eigen::MatrixXd rate_columns;                 ///< of `rates` with respect to v: `slopes` but for rolling
  Eigen::MatrixXd rate_slopes;                  ///< of `rates` with respect to q
  Eigen::VectorXd speeds;                       ///< as Simbody has them: equations::calcSpeeds
  Eigen::MatrixXd speed_slopes, speed_columns;  ///< of `speeds` with respect to q and v
  Eigen::MatrixXd forced, forced_rates;  ///< d `distances` / dp and d `rates` / dp, one column a parameter
};

/// Evaluates them. Not thread safe.
class ClosureProgram {
 public:
  /// `model` must outlive the object.
  explicit ClosureProgram(const LoopModel& model) : model_(model), program_(model.program) {}

  ClosureValues calc(const Eigen::VectorXd& parameters, const Eigen::VectorXd& coordinates,
                     const Eigen::VectorXd& rates);
  ClosureValues calc(const Eigen::VectorXd& parameters, const Eigen::VectorXd& coordinates) {
    return calc(parameters, coordinates, Eigen::VectorXd::Zero(coordinates.size()));
  }

 private:
  const LoopModel& model_;
  SingleProgram program_;
};

/// The conditions of a model, recorded and labelled, without a plan.
LoopModel recordLoops(const ModelSpec& model, const SystemNames& names);

/// The coordinates that meet the conditions `rows` where only those of `columns` are moved: Newton's method
/// with halved steps from `start`, until rounding stops it. Where it does not converge, the nearest that was
/// found. Usually 3 to 6 iterations.
Eigen::VectorXd closeLoops(ClosureProgram& program, const Eigen::VectorXd& parameters, Eigen::VectorXd start,
                           const std::vector<int>& rows, const std::vector<int>& columns);

/// "constraint 'loop' is open by 0.0123 m" of all conditions that are not met to 1e-9 of the length by which
/// coordinates move them; "" if all are.
std::string describeOpenLoops(const LoopModel& model, const ClosureValues& at);

}  // namespace twinmap
