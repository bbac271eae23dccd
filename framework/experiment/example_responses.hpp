#pragma once

#include "framework/experiment/simulated_sets.hpp"

namespace twinmap {

/// Writes responses.csv: of the test samples with the smallest, the median and the largest error (each
/// parameter's in units of its root mean square over the test set) the measured response, noise included, and
/// those of the model at the centre of the box (nominal) and at the inferred parameters (updated), with the
/// sample's own nuisance and inputs. A model that cannot be simulated there leaves its column empty. Cost:
/// six simulations.
void writeExampleResponses(const ExperimentSpec& experiment, const SimulatedSets& sets,
                           const Simulator& simulator, const RunOptions& options, RunSummary& run);

}  // namespace twinmap
