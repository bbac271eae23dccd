#pragma once

#include <vector>

#include "framework/experiment/experiment_spec.hpp"
#include "framework/results/responses_csv.hpp"
#include "framework/results/run_summary.hpp"
#include "framework/simulation/sample_generator.hpp"

namespace twinmap {

/// The test samples with the smallest, the median and the largest error (each parameter's in units of its
/// root mean square over the test set): the measured response, noise included, and those of the model at the
/// centre of the box (nominal) and at the inferred parameters (updated), with the sample's own nuisance and
/// inputs. A model that cannot be simulated there leaves NaN. `test_indices`: columns of `test` that
/// `evaluation` has. Cost: six simulations.
std::vector<ExampleResponse> simulateExamples(const ExperimentSpec& experiment, const Simulator& simulator,
                                              const Trajectories& test, const std::vector<int>& test_indices,
                                              const Evaluation& evaluation, int threads);

}  // namespace twinmap
