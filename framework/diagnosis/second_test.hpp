#pragma once

#include <string>
#include <vector>

#include "framework/diagnosis/diagnosis.hpp"

namespace twinmap {

/// Which further test would tell terms apart that these recordings do not: a sentence. Tests are the same
/// with all signals multiplied by one number; judged by the linear model at `point` (u), whichever of `tied`
/// is what is missing. Cost: two simulations with derivatives a recording for each number tried.
std::string adviseSecondTest(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                             const Eigen::VectorXd& point, const std::vector<TermFinding>& tied);

}  // namespace twinmap
