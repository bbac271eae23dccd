#pragma once

#include "framework/study/pipeline/preparation/simulated_sets.hpp"
#include "framework/study/verification/check_result.hpp"

namespace twinmap {

/// Checks maps.h5, predictions.csv and the tables (see verifyRun) against what follows from `sets`. `limits`:
/// the test samples whose information limit is computed again.
void checkResults(const ExperimentSpec& experiment, const Simulator& simulator, SimulatedSets sets,
                  const std::vector<int>& limits, int threads, Verification& verification);

}  // namespace twinmap
