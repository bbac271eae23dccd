#pragma once

#include <string>
#include <vector>

#include "framework/optimal_design/design_search.hpp"

namespace twinmap::experiment_design {

/// One excitation, judged at points of the box that no search has seen.
struct JudgedExcitation {
  Eigen::VectorXd values;  ///< of the free numbers
  DesignLimit limit;
  std::vector<SignalMeasure> signals;
  Eigen::VectorXd largest;  ///< measures of the limits at all points of the check; empty if it failed
};

/// What a design has found.
struct ExcitationDesign {
  std::vector<FreeNumber> numbers;
  std::vector<Limit> limits;
  std::vector<ParameterSpec> parameters;
  JudgedExcitation before, after;
  JudgedExcitation nominal;  ///< designed for the centre of the box alone; no values after an interruption
  std::vector<TriedDesign> path;
  int check_points = 0;       ///< of the box, random ones and corners, at which `after` keeps the limits
  Eigen::VectorXd tightened;  ///< what the search had to keep for that, over the limits
  std::vector<std::string> warnings;  ///< parameters that stay undetermined
  bool interrupted = false;
};

}  // namespace twinmap::experiment_design
