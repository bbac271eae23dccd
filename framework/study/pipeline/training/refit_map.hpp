#pragma once

#include <filesystem>

#include "framework/estimation/gp/gp_map.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// The exact processes that a finished run's map was compressed from (`deployed`, which has their
/// hyperparameters), fitted again to the training samples of the run's samples.h5. Throws std::runtime_error
/// where that file is missing or is not one. Cost: that of refitGpMap().
GpMap refitExactMap(const std::filesystem::path& run, const ExperimentSpec& experiment,
                    const GpMap& deployed);

}  // namespace twinmap
