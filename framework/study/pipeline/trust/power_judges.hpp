#pragma once

#include <memory>

#include "framework/data/noise/noise_whitener.hpp"
#include "framework/study/pipeline/trust/power_stencils.hpp"

namespace twinmap {

/// Judges features of one stencil.
class PowerJudge {
 public:
  virtual ~PowerJudge() = default;
  /// The p-value where the features are moved, by change and noise together (d).
  virtual double calcPValue(const Eigen::VectorXd& moved) const = 0;
};

/// By what the simulator leaves where the run's test samples were refined, else by what the surrogate leaves;
/// parameters take up what they can, linearly. All but the stencil must outlive it.
std::unique_ptr<PowerJudge> makePowerJudge(const Estimator& map, const TrustModel& trust,
                                           const NoiseWhitener& noise, const Stencil& at);

}  // namespace twinmap
