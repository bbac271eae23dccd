#pragma once

#include <string>

#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// The experiment file of a corrected experiment (Diagnosis::corrected). Tolerances that its file does not
/// give follow the noise anew, as the terms' parameters may need smaller ones; what was measured is read from
/// its own file again. Throws ExperimentError as requireSharedSystem().
std::string writeCorrected(ExperimentSpec experiment);

}  // namespace twinmap
