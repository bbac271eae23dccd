#pragma once

#include <stdexcept>

#include "framework/study/pipeline/preparation/simulated_sets.hpp"
#include "framework/study/verification/check_result.hpp"

namespace twinmap {

/// The samples to simulate again.
struct ChosenSamples {
  std::vector<int> train, test;
};

/// samples.h5 cannot be read, or is one of another experiment.
class UnreadableSamples : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Checks samples.h5 and the chunks (see verifyRun), and returns the samples as they should be, as far as
/// that is known. Throws UnreadableSamples.
SimulatedSets checkSamples(const ExperimentSpec& experiment, const Simulator& simulator,
                           const ChosenSamples& chosen, int threads, Verification& verification);

}  // namespace twinmap
