#pragma once

#include "framework/experiment/files/sweep_cases.hpp"

namespace twinmap {

/// Experiments with their measured excitation read (loadMeasuredSignals): what every command simulates.
/// Throw ExperimentError for the first thing wrong.
ExperimentSpec readExperimentWithSignals(const YamlNode& root);

/// The cases of expandCases().
std::vector<SweepCase> expandCasesWithSignals(const YamlNode& root);

}  // namespace twinmap
