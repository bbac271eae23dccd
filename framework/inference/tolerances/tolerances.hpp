#pragma once

#include <vector>

#include "framework/experiment/experiment_spec.hpp"
#include "framework/experiment/files/sweep_cases.hpp"

namespace twinmap {

/// The experiment with tolerances of the integration as its noise asks for. At 16 points of the box responses
/// are compared with those of hundredfold tighter tolerances: where their difference moves an estimate
/// noticeably (IntegrationError), those that are automatic are tightened by powers of ten until it does not,
/// and the log says from what, to what and why. Those that the file gives stay: too coarse ones are a
/// warning, which names their place and what would do. Afterwards none is automatic. Nothing is compared
/// where features have no noise, nothing is integrated, or a program has an accuracy of its own. Warns of
/// onset speeds of friction on which estimates depend (onset_speeds.hpp). The result depends on model,
/// features and noise alone. Throws ExperimentError where the model cannot be simulated. Cost: 32
/// simulations, 16 with derivatives where the error is not far below the noise, and 32 for each further
/// tolerance that is tried; in lanes some milliseconds.
ExperimentSpec followNoise(ExperimentSpec experiment);

/// The same of the cases of a sweep, once for those that differ in none of the three. Cases of one model
/// whose tolerances come out different have different models then (SweepCase::model).
void followNoise(std::vector<SweepCase>& cases);

}  // namespace twinmap
