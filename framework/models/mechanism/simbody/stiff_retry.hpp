#pragma once

#include "framework/models/mechanism/simbody/simbody_engine.hpp"

namespace twinmap {

/// What reached the step limit of an explicit method may be stiff: this tries it once more by CPodes, through
/// Simbody.
class StiffRetry {
 public:
  /// Both must outlive this.
  StiffRetry(const ModelSpec& model, SimbodyEngine& simbody) : model_(model), simbody_(simbody) {}

  /// One column; `status`: of the first try, becomes that of the second.
  void simulate(const Eigen::Ref<const Eigen::VectorXd>& parameters, Eigen::Ref<Eigen::VectorXd> response,
                SampleStatus& status) const;

  /// The same with the derivatives (rows of the response x parameters), by differences (makeNeighbours)
  /// of solutions with a thousandth of the tolerance: good to 1 % of the largest. Fails if one of the 2 p + 1
  /// simulations does.
  void simulateWithDerivatives(const Eigen::Ref<const Eigen::VectorXd>& parameters,
                               Eigen::Ref<Eigen::VectorXd> response, Eigen::Ref<Eigen::MatrixXd> derivatives,
                               SampleStatus& status) const;

 private:
  SampleStatus simulateImplicitly(double tolerance_factor,
                                  const Eigen::Ref<const Eigen::VectorXd>& parameters,
                                  Eigen::Ref<Eigen::VectorXd> response) const;

  const ModelSpec& model_;
  SimbodyEngine& simbody_;
};

}  // namespace twinmap
