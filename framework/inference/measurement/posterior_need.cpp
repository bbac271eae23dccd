#include "framework/inference/measurement/posterior_need.hpp"

#include "framework/estimation/posterior/noise/residual_test.hpp"
#include "framework/inference/select_estimate.hpp"

namespace twinmap {
namespace {

/// Whether a 95 % interval of a normal distribution ends outside the bounds: it is not the posterior's then.
bool crossesBounds(const Estimate& estimate, const std::vector<ParameterSpec>& parameters) {
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto i = static_cast<Eigen::Index>(p);
    const double reach = kNormal95 * estimate.stddev[i];
    if (estimate.mean[i] - reach < parameters[p].bounds.lower ||
        estimate.mean[i] + reach > parameters[p].bounds.upper) {
      return true;
    }
  }
  return false;
}

bool isOfStatedNoise(const InferredMeasurement& inferred, const std::vector<FeatureInfo>& infos) {
  const bool misfits = inferred.trust && inferred.trust->statuses.front() == TrustStatus::kModelMismatch;
  const Refined& refined = *inferred.refined;
  return !misfits && testResidual(refined.residual, refined.degrees, infos).isPlausible();
}

}  // namespace

bool mayBeElsewhere(const InferredMeasurement& inferred) {
  return !inferred.refined->isAccepted() || inferred.basins.cols() > 1 || inferred.coverage_is_short;
}

bool needsPosterior(const InferredMeasurement& inferred, const std::vector<ParameterSpec>& parameters,
                    const std::vector<FeatureInfo>& infos) {
  return mayBeElsewhere(inferred) || crossesBounds(selectEstimate(inferred), parameters) ||
         !isOfStatedNoise(inferred, infos);
}

}  // namespace twinmap
