#include "framework/diagnosis/candidates/augment.hpp"

#include <algorithm>
#include <functional>

#include "framework/base/text/number_text.hpp"
#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/tree/write_value.hpp"
#include "framework/experiment/trials/combine_trials.hpp"

namespace twinmap {
namespace {

ParameterSpec makeCoefficient(const std::string& name, const TermCandidate& candidate, double largest) {
  ParameterSpec parameter;
  parameter.name = {name, {}};
  parameter.bounds = {-largest, largest, {}};
  parameter.unit = candidate.unit;
  parameter.description = candidate.meaning;
  parameter.relative_to = RelativeTo::kRange;
  return parameter;
}

bool isTaken(const ModelSpec& model, const std::string& name) {
  const auto has = [&](const auto& items) {
    return std::any_of(items.begin(), items.end(), [&](const auto& item) { return item.name.text == name; });
  };
  const auto is_coordinate = [&](const BodySpec& body) {
    const auto& names = body.joint.coordinates;
    return std::any_of(names.begin(), names.end(),
                       [&](const Name& one) { return one.text == name || one.text + "_dot" == name; });
  };
  return isReservedName(name) || has(collectSampled(model)) || has(model.constants) ||
         has(model.excitation) || has(model.system.states) || has(model.system.expressions) ||
         std::any_of(model.system.bodies.begin(), model.system.bodies.end(), is_coordinate);
}

std::string makeUniqueName(const std::string& term, const std::function<bool(const std::string&)>& is_taken) {
  std::string name = term;
  std::replace(name.begin(), name.end(), '.', '_');
  std::string unique = name;
  for (int i = 2; is_taken(unique); ++i) {
    unique = name + "_" + std::to_string(i);
  }
  return unique;
}

/// Of no model of the experiment.
std::string makeParameterName(const ExperimentSpec& experiment, const std::string& term) {
  const std::vector<TrialExperiment>& trials = experiment.trials;
  return makeUniqueName(term, [&](const std::string& name) {
    return isTaken(experiment.model, name) ||
           std::any_of(trials.begin(), trials.end(),
                       [&](const TrialExperiment& trial) { return isTaken(trial.experiment.model, name); });
  });
}

void removeCandidate(const std::string& term, ExperimentSpec& experiment) {
  std::vector<CandidateSpec>& own = experiment.candidates;
  own.erase(std::remove_if(own.begin(), own.end(),
                           [&](const CandidateSpec& spec) { return spec.name.text == term; }),
            own.end());
}

/// Of the machine: the same in all trials.
void addParameter(const ParameterSpec& parameter, ExperimentSpec& experiment) {
  experiment.model.parameters.push_back(parameter);
  for (TrialExperiment& trial : experiment.trials) {
    trial.experiment.model.parameters.push_back(parameter);
  }
}

void addTo(const TermCandidate& candidate, const std::string& coefficient,
           const std::vector<std::string>& scales, ExperimentSpec& experiment) {
  if (experiment.trials.empty()) {
    candidate.add(experiment.model, coefficient, scales);
    return;
  }
  for (std::size_t t = 0; t < experiment.trials.size(); ++t) {
    if (const AddTerm& add = candidate.getAdd(t)) {
      add(experiment.trials[t].experiment.model, coefficient, scales);
    }
  }
}

/// What the trials share, from what their models have become.
void combineAgain(ExperimentSpec& experiment) {
  if (!experiment.trials.empty()) {
    experiment.model.system = experiment.trials.front().experiment.model.system;
    experiment = combineTrials(experiment, experiment.trials);
  }
}

}  // namespace

std::string makeParameterName(const ModelSpec& model, const std::string& term) {
  return makeUniqueName(term, [&](const std::string& name) { return isTaken(model, name); });
}

void requireSharedSystem(const ExperimentSpec& experiment) {
  const std::vector<TrialExperiment>& trials = experiment.trials;
  for (const TrialExperiment& trial : trials) {
    if (writeYaml(writeValue(trial.experiment.model.system)) !=
        writeYaml(writeValue(trials.front().experiment.model.system))) {
      throw ExperimentError("the term changes the machine differently in the trials " + trials.front().name +
                            " and " + trial.name +
                            ", which one file cannot say; leave --out out, or accept another term");
    }
  }
}

void setBounds(std::size_t parameter, const Bounds& bounds, ExperimentSpec& experiment) {
  experiment.model.parameters[parameter].bounds = bounds;
  for (TrialExperiment& trial : experiment.trials) {
    trial.experiment.model.parameters[parameter].bounds = bounds;
  }
}

AugmentedExperiment addAll(const ExperimentSpec& experiment, const std::vector<TermCandidate>& candidates,
                           double share) {
  AugmentedExperiment augmented{experiment, static_cast<Eigen::Index>(candidates.size())};
  for (const TermCandidate& candidate : candidates) {
    const std::string name = makeParameterName(augmented.experiment, "missing." + candidate.term);
    addParameter(makeCoefficient(name, candidate, share * candidate.size), augmented.experiment);
    std::vector<std::string> scales;
    for (const OwnScale& scale : candidate.own_scales) {
      scales.push_back(toText(scale.value));
    }
    addTo(candidate, name, scales, augmented.experiment);
  }
  combineAgain(augmented.experiment);
  return augmented;
}

AugmentedExperiment addTerm(const ExperimentSpec& experiment, const TermCandidate& candidate,
                            double largest) {
  // laws exclude each other; levels are not yet 0 over 0
  constexpr double kNearlyWhole = 0.998, kWhole = 0.999;
  AugmentedExperiment augmented{experiment, 1};
  ExperimentSpec& changed = augmented.experiment;
  removeCandidate(candidate.term, changed);
  for (TrialExperiment& trial : changed.trials) {
    removeCandidate(candidate.term, trial.experiment);
  }
  const std::string name = makeParameterName(changed, candidate.term);
  ParameterSpec coefficient = makeCoefficient(name, candidate, largest);
  if (candidate.is_share) {
    coefficient.bounds = {kNearlyWhole, kWhole, {}};
  }
  addParameter(coefficient, changed);
  std::vector<std::string> scales;
  for (const OwnScale& own : candidate.own_scales) {
    scales.push_back(makeParameterName(changed, candidate.term + (scales.empty() ? ".scale" : ".scale2")));
    ParameterSpec parameter;
    parameter.name = {scales.back(), {}};
    parameter.bounds = {own.value / own.reach, own.value * own.reach, {}};
    if (parameter.bounds.lower > 0.0) {
      parameter.prior = PriorSpec{LogUniformPrior{}};
    }
    parameter.unit = own.unit;
    parameter.description = own.meaning;
    addParameter(parameter, changed);
    ++augmented.added;
  }
  addTo(candidate, name, scales, changed);
  combineAgain(changed);
  return augmented;
}

}  // namespace twinmap
