#include "framework/experiment/trials/combine_trials.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "framework/base/text/nearest_name.hpp"

namespace twinmap {
namespace {

Name nameInTrial(const std::string& trial, Name name) {
  name.text = twinmap::nameInTrial(trial, name.text);
  return name;
}

template <class Named>
void appendNamed(const std::string& trial, const std::vector<Named>& from, std::vector<Named>& to) {
  for (Named one : from) {
    one.name = nameInTrial(trial, std::move(one.name));
    to.push_back(std::move(one));
  }
}

void appendInputs(const std::vector<ParameterSpec>& from, std::vector<ParameterSpec>& to) {
  for (const ParameterSpec& input : from) {
    const auto same = std::find_if(
        to.begin(), to.end(), [&](const ParameterSpec& other) { return other.name.text == input.name.text; });
    if (same == to.end()) {
      to.push_back(input);
    } else if (same->bounds.lower != input.bounds.lower || same->bounds.upper != input.bounds.upper) {
      throw ExperimentError(input.name.where, input.name.text,
                            "has other bounds in another trial; an input is one value for all trials");
    }
  }
}

/// The constants that have one value in all trials.
std::vector<ConstantSpec> shareConstants(const std::vector<TrialExperiment>& trials) {
  std::vector<ConstantSpec> shared = trials.front().experiment.model.constants;
  for (const TrialExperiment& trial : trials) {
    const std::vector<ConstantSpec>& own = trial.experiment.model.constants;
    shared.erase(std::remove_if(shared.begin(), shared.end(),
                                [&](const ConstantSpec& one) {
                                  return std::none_of(own.begin(), own.end(), [&](const ConstantSpec& other) {
                                    return other.name.text == one.name.text &&
                                           other.value.text == one.value.text;
                                  });
                                }),
                 shared.end());
  }
  return shared;
}

void requireSharedPriors(const ModelSpec& model, const std::vector<ParameterSpec>& nuisance) {
  for (const PriorGroupSpec& group : model.priors) {
    const auto* correlated = std::get_if<CorrelatedPriors>(&group.kind);
    const auto* normal = std::get_if<JointNormalPrior>(&group.kind);
    for (const Name& name : correlated != nullptr ? correlated->names
                            : normal != nullptr   ? normal->names
                                                  : std::vector<Name>{}) {
      if (std::any_of(nuisance.begin(), nuisance.end(),
                      [&](const ParameterSpec& one) { return one.name.text == name.text; })) {
        throw ExperimentError(name.where, name.text,
                              "is a nuisance parameter, of which each trial has one of its own: priors of "
                              "several together are of the parameters that the trials share");
      }
    }
  }
}

template <class Kind>
void rename(const std::string& trial, Kind& kind) {
  for (Name& output : kind.outputs) {
    output = nameInTrial(trial, std::move(output));
  }
}
void rename(const std::string& trial, ExtremaFeatureSpec& extrema) {
  extrema.output = nameInTrial(trial, std::move(extrema.output));
}
void rename(const std::string&, ModesFeatureSpec&) {}
void rename(const std::string& trial, FrequencyResponseFeatureSpec& response) {
  rename<FrequencyResponseFeatureSpec>(trial, response);
  response.excitation = nameInTrial(trial, std::move(response.excitation));
}

bool isReduced(const FeatureSpec& feature) {
  const auto* samples = std::get_if<SamplesFeatureSpec>(&feature);
  return samples != nullptr && samples->isReduced();
}

void appendFeatures(const TrialExperiment& trial, std::vector<FeatureSpec>& features) {
  if (std::any_of(trial.experiment.features.begin(), trial.experiment.features.end(), isReduced)) {
    throw ExperimentError(trial.experiment.name.where, trial.name,
                          "reduces its samples, which one trial alone may: choose it, or give fewer samples");
  }
  const bool has_modes = countModes(trial.experiment.features) > 0;
  if (has_modes && countModes(features) > 0) {
    throw ExperimentError(trial.experiment.name.where, trial.name,
                          "has modes as features, as another trial has; only one of them may");
  }
  for (FeatureSpec feature : trial.experiment.features) {
    std::visit([&](auto& kind) { rename(trial.name, kind); }, feature);
    features.push_back(std::move(feature));
  }
}

void appendNoise(const TrialExperiment& trial, NoiseSpec& noise) {
  const NoiseSpec& own = trial.experiment.noise;
  for (OutputNoiseSpec output : own.stddev) {
    output.name = nameInTrial(trial.name, std::move(output.name));
    output.stddev.value *= own.scale;
    noise.stddev.push_back(std::move(output));
  }
  appendNamed(trial.name, own.correlation, noise.correlation);
  for (const RoundedOutput& rounded : own.rounded) {
    noise.rounded.push_back({twinmap::nameInTrial(trial.name, rounded.name), rounded.quantum});
  }
  if (own.modes && countModes(trial.experiment.features) > 0) {
    noise.modes = {own.scale * own.modes->frequency, own.scale * own.modes->damping_ratio};
  }
}

void appendModel(const TrialExperiment& trial, ModelSpec& model) {
  const ModelSpec& own = trial.experiment.model;
  requireSharedPriors(model, own.nuisance);
  appendNamed(trial.name, own.nuisance, model.nuisance);
  appendInputs(own.inputs, model.inputs);
  appendNamed(trial.name, own.excitation, model.excitation);
  appendNamed(trial.name, own.outputs, model.outputs);
  model.simulation.duration = std::max(model.simulation.duration, own.simulation.duration);
  model.trials.push_back({trial.name, own, countModes(trial.experiment.features)});
}

}  // namespace

std::string nameInTrial(const std::string& trial, const std::string& name) {
  return trial + "." + name;
}

ExperimentSpec combineTrials(ExperimentSpec base, std::vector<TrialExperiment> trials) {
  ModelSpec& model = base.model;
  model.constants = shareConstants(trials);
  model.nuisance.clear();
  model.inputs.clear();
  model.excitation.clear();
  model.outputs.clear();
  model.trials.clear();
  model.simulation = trials.front().experiment.model.simulation;
  base.features.clear();
  NoiseSpec noise;
  noise.replicates = base.noise.replicates;
  base.noise = noise;
  base.measurement = {};
  for (const TrialExperiment& trial : trials) {
    appendModel(trial, model);
    appendFeatures(trial, base.features);
    appendNoise(trial, base.noise);
  }
  base.trials = std::move(trials);
  return base;
}

void changeTrials(ExperimentSpec& experiment, const std::function<void(ExperimentSpec&)>& change) {
  if (experiment.trials.empty()) {
    change(experiment);
    return;
  }
  std::vector<TrialExperiment> trials = experiment.trials;
  for (TrialExperiment& trial : trials) {
    change(trial.experiment);
  }
  experiment = combineTrials(experiment, std::move(trials));
}

void throwUnknownTrial(const std::string& trial, const std::vector<std::string>& names) {
  throw ExperimentError("'" + trial + "' is not a trial of the experiment: it has " +
                        (names.empty() ? "none; leave out --trial, several files go behind --joint"
                                       : listNames(names) + suggestName(trial, names)));
}

std::string describeOwnFile(const std::string& trial) {
  return fmt::format("write the trial's own file by twinmap check FILE trial={} > {}.yaml", trial, trial);
}

void requireOneTrial(const ExperimentSpec& experiment, const std::string& what) {
  if (experiment.trials.empty()) {
    return;
  }
  std::vector<std::string> names;
  for (const TrialExperiment& trial : experiment.trials) {
    names.push_back(trial.name);
  }
  throw ExperimentError(experiment.name.where, "",
                        fmt::format("describes the trials {}, but {}; choose one by trial={}, or {}",
                                    listNames(names), what, names.front(), describeOwnFile(names.front())));
}

}  // namespace twinmap
