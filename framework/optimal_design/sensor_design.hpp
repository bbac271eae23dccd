#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/optimal_design/candidate_information.hpp"

namespace twinmap::experiment_design {

/// Candidates that are measured together, and what that leaves unknown.
struct JudgedSubset {
  Subset subset;
  double cost = 0.0;
  Eigen::MatrixXd stddev;  ///< p x points, of the information limit, in the parameters' units
};

/// What a design of sensors has found.
struct SensorDesign {
  std::vector<ParameterSpec> parameters;
  std::vector<std::string> outputs;      ///< candidates
  Eigen::VectorXd times;                 ///< candidates, s
  std::vector<JudgedSubset> by_outputs;  ///< the best 1, 2, 3 ... outputs, at all times
  JudgedSubset chosen_outputs;
  std::vector<JudgedSubset>
      by_times;  ///< of the chosen outputs: more and more of the times; empty where all are taken
  Subset chosen_times;
  std::vector<std::string> warnings;  ///< parameters that stay undetermined
};

}  // namespace twinmap::experiment_design
