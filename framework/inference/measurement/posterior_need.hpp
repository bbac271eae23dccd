#pragma once

#include <vector>

#include "framework/inference/inferrer.hpp"

namespace twinmap {

/// Whether the posterior may lie elsewhere than a refined estimate: the refinement was not accepted, the
/// estimator knows of other basins, or the refined test samples of the run had intervals that held less than
/// they say.
bool mayBeElsewhere(const InferredMeasurement& inferred);

/// Whether the posterior on the simulator should take its place: it may lie elsewhere, an interval crosses
/// a bound, or the residual is not of the noise that is stated. infos: of its features.
bool needsPosterior(const InferredMeasurement& inferred, const std::vector<ParameterSpec>& parameters,
                    const std::vector<FeatureInfo>& infos);

}  // namespace twinmap
