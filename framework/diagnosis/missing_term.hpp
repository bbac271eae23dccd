#pragma once

#include <optional>

#include "framework/diagnosis/problem/recorded_problem.hpp"
#include "framework/inference/inferrer.hpp"

namespace twinmap {

/// The first term that diagnose() would name, of those without states, for a measurement that was inferred
/// and is a model_mismatch or a clock_fault; none where nothing is found, or the model is not a system that
/// is simulated in time. Searched from where the measurement was explained best. Cost: one simulation with
/// derivatives along all candidates, and fits with the three best, some 50 simulations with derivatives.
std::optional<MissingTerm> findMissingTerm(const ExperimentSpec& experiment,
                                           const RecordedFeatures& recording,
                                           const InferredMeasurement& inferred);

}  // namespace twinmap
