#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/simulation/response_layout.hpp"

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

}  // namespace twinmap
