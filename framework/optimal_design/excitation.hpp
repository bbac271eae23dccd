#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/base/log/run_control.hpp"
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

/// Designs the excitation of an experiment (its design.excitation) and writes to `folder`: designed.yaml, the
/// whole experiment with the values found; signal.csv, its signals over time; design.csv, what was tried;
/// limits.csv, the information limit before and after; design.html. The criterion is averaged over a Latin
/// hypercube of the box; nuisance parameters are marginalised, known inputs averaged, the box is the prior.
/// Then the limits are held against 1000 random points and the corners; where they are broken the search goes
/// on with tighter ones. What design.csv has from an interrupted design of the same experiment is not
/// computed again. Throws ExperimentError for what cannot be free, for limits that no design keeps (naming
/// the one and the least violation found), and for a folder of another experiment; Interrupted where
/// `control` asks to stop, after the best so far has been written.
ExcitationDesign designExcitation(const YamlNode& tree, const std::filesystem::path& folder,
                                  const RunControl& control);

}  // namespace twinmap::experiment_design
