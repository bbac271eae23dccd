#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "framework/models/mechanism/model_context.hpp"
#include "kernels/lanes/program/program.hpp"

namespace twinmap {

/// How loops are closed. Decided once, at the centre of the bounds, so that all samples are assembled alike.
struct LoopPlan {
  std::vector<int> rows;             ///< conditions that are independent; the others follow from them
  std::vector<int> dependent;        ///< coordinates that are solved for, as many as rows
  std::vector<int> dependent_rates;  ///< rates of coordinates that are solved for
};

/// Where a condition comes from, for messages.
struct ClosureLabel {
  std::string text;  ///< "constraint 'loop'", "system.constraints[2] (rod)"
  std::string unit;
  SourceLocation where;
  bool of_speeds = false;  ///< rolling: no condition of the coordinates stands behind it
};

/// The conditions c(q, p) = 0 of a model's constraints, recorded, and how they are met. Immutable; shared by
/// threads.
struct LoopModel {
  Eigen::Index coordinates = 0, parameters = 0;
  std::vector<ClosureLabel> labels;  ///< one a condition
  program::Program program;          ///< reads ClosureProgram
  LoopPlan plan;
};

}  // namespace twinmap
