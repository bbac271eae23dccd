#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/experiment/experiment_spec.hpp"
#include "framework/optimal_design/signal_measures.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap::experiment_design {

/// One number that must not exceed another.
struct Limit {
  enum class Kind { output_max_abs, signal_max_abs, signal_max_rate, signal_rms };
  Kind kind;
  std::string name;        ///< of the output or signal
  Eigen::Index index = 0;  ///< of it
  double most = 0.0;       ///< in `unit`
  std::string unit;
  SourceLocation where;
};

/// "largest |y|", "largest rate of F", "rms of F".
std::string describe(const Limit& limit);

/// The limits that an experiment's design has, each number one.
std::vector<Limit> listLimits(const ExperimentSpec& experiment);

/// Whether one of them needs the outputs between the features' times.
bool limitsOutputs(const std::vector<Limit>& limits);

/// The largest absolute value of each output over all times and responses (columns, finite).
Eigen::VectorXd calcLargestOutputs(const ResponseLayout& layout, const Eigen::MatrixXd& responses);

/// What each limit bounds, from the signals and the largest outputs.
Eigen::VectorXd measureLimits(const std::vector<Limit>& limits, const std::vector<SignalMeasure>& signals,
                              const Eigen::VectorXd& largest_outputs);

}  // namespace twinmap::experiment_design
