#pragma once

#include "framework/estimation/posterior/simulator_posterior.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/inference/inferrer.hpp"

namespace twinmap {

/// What several recordings say together, as an answer of one: without start, trust and statuses of its own.
/// experiment: that of one of them, whose parameters are the first unknown ones of the problem. Cost: where
/// there may be ridges, 33 simulations of each recording with derivatives.
InferredMeasurement describeTogether(const ExperimentSpec& experiment, const PosteriorProblem& problem,
                                     const SimulatorPosterior& joint);

}  // namespace twinmap
