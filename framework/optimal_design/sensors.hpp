#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/base/log/run_control.hpp"
#include "framework/experiment/model/model_spec.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"
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

/// Chooses which outputs to measure, and at which of the features' sample times, for an experiment with
/// design.sensors, and writes to `folder`: designed.yaml, the whole experiment with these as its features;
/// sensors.csv and times.csv, what each further one buys; sensors.html. Each choice is greedy, then improved
/// by exchanges, for 1, 2, 3 ... outputs up to all; the criterion is averaged over a Latin hypercube of the
/// box; nuisance parameters are marginalised, the box is the prior, and correlated noise is what it is among
/// the samples that are chosen. Throws ExperimentError where features are no samples on one grid of times;
/// Interrupted. Cost: a simulation with derivatives for each point.
SensorDesign designSensors(const YamlNode& tree, const std::filesystem::path& folder,
                           const RunControl& control);

}  // namespace twinmap::experiment_design
