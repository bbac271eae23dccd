#pragma once

#include <vector>

#include "framework/inference/inferrer.hpp"

namespace twinmap {

/// Whether a refined estimate may be wrong: the refinement was not accepted, the estimator knows of other
/// basins, the refined test samples of the run had intervals that held less than they say, or the residual is
/// not of the noise that is stated. inferred: refined; infos: of its features.
bool mayBeWrong(const InferredMeasurement& inferred, const std::vector<FeatureInfo>& infos);

/// Whether the posterior on the simulator should take its place: it may be wrong, or an interval crosses a
/// bound.
bool needsPosterior(const InferredMeasurement& inferred, const std::vector<ParameterSpec>& parameters,
                    const std::vector<FeatureInfo>& infos);

}  // namespace twinmap
