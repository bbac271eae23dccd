#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/experiment/experiment_spec.hpp"
#include "framework/results/run_summary.hpp"
#include "framework/simulation/response_layout.hpp"
#include "framework/simulation/sample_generator.hpp"

namespace twinmap {

/// A test sample beside its models.
struct ExampleResponse {
  std::string name;  ///< "best", "median", "worst"
  int sample = 0;    ///< index in the test set
  Eigen::VectorXd measured, nominal,
      updated;  ///< rows of the layout; NaN where a model could not be simulated
};

/// responses.csv: case, sample, output, unit, time, measured, nominal, updated, noise_stddev; one row for
/// each output and time of each example. `row_stddev`: the noise of each row of the layout.
std::string makeResponsesCsv(const std::vector<ExampleResponse>& examples, const ResponseLayout& layout,
                             const Eigen::VectorXd& row_stddev);

/// The test samples with the smallest, the median and the largest error (each parameter's in units of its
/// root mean square over the test set): the measured response, noise included, and those of the model at the
/// centre of the box (nominal) and at the inferred parameters (updated), with the sample's own nuisance and
/// inputs. A model that cannot be simulated there leaves NaN. `test_indices`: columns of `test` that
/// `evaluation` has. Cost: six simulations.
std::vector<ExampleResponse> simulateExamples(const ExperimentSpec& experiment, const Simulator& simulator,
                                              const Trajectories& test, const std::vector<int>& test_indices,
                                              const Evaluation& evaluation, int threads);

}  // namespace twinmap
