#pragma once

#include "framework/multibody/simbody_engine.hpp"

namespace twinmap {

/// What reached the step limit of an explicit method may be stiff: this tries it once more by CPodes, through
/// Simbody.
class SecondTry {
 public:
  /// Both must outlive this.
  SecondTry(const ModelSpec& model, SimbodyEngine& simbody) : model_(model), simbody_(simbody) {}

  /// One column; `status`: of the first try, becomes that of the second.
  void simulate(const Eigen::Ref<const Eigen::VectorXd>& parameters, Eigen::Ref<Eigen::VectorXd> response,
                SampleStatus& status) const;

 private:
  const ModelSpec& model_;
  SimbodyEngine& simbody_;
};

}  // namespace twinmap
