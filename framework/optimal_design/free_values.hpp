#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/experiment/excitation_design_spec.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"

namespace twinmap::experiment_design {

/// One number of the excitation that a design chooses.
struct FreeNumber {
  std::string key;  ///< path in the experiment: "excitation.F.pulses[0].start"
  double lower = 0.0, upper = 0.0;
  double present = 0.0;  ///< what the experiment has, within the bounds
  bool is_phase = false;
  SourceLocation where;  ///< of what makes it free
};

/// The numbers that `free` names, `each` of a list one by one. Lists that the experiment leaves to their
/// defaults (phases and amplitudes of multisines) are written out in `tree` where one of them is free.
/// Throws ExperimentError for a key that is not there, that holds no plain number, or that is named twice.
std::vector<FreeNumber> resolveFreeNumbers(const FreeValues& free, YamlNode& tree);

/// The present values, as fractions of the bounds (0 to 1).
Eigen::VectorXd calcPresentPoint(const std::vector<FreeNumber>& numbers);

/// The values at fractions of the bounds.
Eigen::VectorXd calcValues(const std::vector<FreeNumber>& numbers, const Eigen::VectorXd& fractions);

/// The experiment's tree with other values.
YamlNode setValues(YamlNode tree, const std::vector<FreeNumber>& numbers, const Eigen::VectorXd& values);

}  // namespace twinmap::experiment_design
