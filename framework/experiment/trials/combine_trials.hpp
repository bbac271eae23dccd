#pragma once

#include <functional>
#include <string>
#include <vector>

#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// What is a trial's own, where several are combined: "free.x".
std::string nameInTrial(const std::string& trial, const std::string& name);

/// Several experiments with one machine as one, whose features are those of all of them. Outputs, signals and
/// nuisance parameters are each trial's own and named after it (nameInTrial()); parameters, inputs and what
/// is not of a trial are shared. `base`: all that is shared, such as one of the trials as it was read;
/// trials: with their defaults resolved. Throws ExperimentError where the trials cannot be combined: modes as
/// features of two of them, an input with two bounds, correlated priors of nuisance parameters.
ExperimentSpec combineTrials(ExperimentSpec base, std::vector<TrialExperiment> trials);

/// Changes an experiment, or each of the trials that it combines.
void changeTrials(ExperimentSpec& experiment, const std::function<void(ExperimentSpec&)>& change);

/// Throws ExperimentError: there is no such trial, but those of these names.
[[noreturn]] void throwUnknownTrial(const std::string& trial, const std::vector<std::string>& names);

/// How a user gets the experiment file of one trial.
std::string describeOwnFile(const std::string& trial = "NAME");

/// Throws ExperimentError where the experiment combines trials: for what is of one at a time.
void requireOneTrial(const ExperimentSpec& experiment, const std::string& what);

}  // namespace twinmap
