#include "framework/diagnosis/augment.hpp"

#include <algorithm>

#include "framework/base/text/number_text.hpp"
#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/model/parameter_box.hpp"

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

}  // namespace

std::string makeParameterName(const ModelSpec& model, const std::string& term) {
  std::string name = term;
  std::replace(name.begin(), name.end(), '.', '_');
  std::string unique = name;
  for (int i = 2; isTaken(model, unique); ++i) {
    unique = name + "_" + std::to_string(i);
  }
  return unique;
}

AugmentedExperiment addAll(const ExperimentSpec& experiment, const std::vector<TermCandidate>& candidates) {
  AugmentedExperiment augmented{experiment, static_cast<Eigen::Index>(candidates.size())};
  ModelSpec& model = augmented.experiment.model;
  for (const TermCandidate& candidate : candidates) {
    const std::string name = makeParameterName(model, "missing." + candidate.term);
    model.parameters.push_back(makeCoefficient(name, candidate, candidate.size));
    std::vector<std::string> scales;
    for (const OwnScale& scale : candidate.own_scales) {
      scales.push_back(toText(scale.value));
    }
    candidate.add(model, name, scales);
  }
  return augmented;
}

AugmentedExperiment addTerm(const ExperimentSpec& experiment, const TermCandidate& candidate,
                            double largest) {
  AugmentedExperiment augmented{experiment, 1};
  ModelSpec& model = augmented.experiment.model;
  std::vector<CandidateSpec>& own_candidates = augmented.experiment.candidates;
  own_candidates.erase(
      std::remove_if(own_candidates.begin(), own_candidates.end(),
                     [&](const CandidateSpec& spec) { return spec.name.text == candidate.term; }),
      own_candidates.end());
  const std::string name = makeParameterName(model, candidate.term);
  model.parameters.push_back(makeCoefficient(name, candidate, largest));
  std::vector<std::string> scales;
  for (const OwnScale& own : candidate.own_scales) {
    scales.push_back(makeParameterName(model, candidate.term + (scales.empty() ? ".scale" : ".scale2")));
    ParameterSpec parameter;
    parameter.name = {scales.back(), {}};
    parameter.bounds = {own.value / own.reach, own.value * own.reach, {}};
    parameter.unit = own.unit;
    parameter.description = own.meaning;
    model.parameters.push_back(parameter);
    ++augmented.added;
  }
  candidate.add(model, name, scales);
  return augmented;
}

}  // namespace twinmap
