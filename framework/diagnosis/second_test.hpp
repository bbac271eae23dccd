#pragma once

#include <string>
#include <vector>

#include "framework/diagnosis/fitted_term.hpp"

namespace twinmap {

/// Which further test would tell terms apart that these recordings do not, whichever of `tied` is what is
/// missing: a sentence. tied: two or more, fitted beside the same terms. Tests are the same with all signals
/// multiplied by one number: what a model with one term predicts of it, a model with another term follows
/// with its parameters and own scales as far as the linear model about its fit goes. Cost: two simulations
/// with derivatives a term and recording for each number tried.
std::string adviseSecondTest(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                             const std::vector<const FittedTerm*>& tied);

}  // namespace twinmap
