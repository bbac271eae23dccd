#include <algorithm>

#include "framework/diagnosis/augment.hpp"
#include "framework/diagnosis/candidates/term_candidates.hpp"

namespace twinmap {

std::vector<TermCandidate> listCandidates(const ExperimentSpec& experiment, const ModelSizes& sizes) {
  const ModelSpec& model = experiment.model;
  std::vector<TermCandidate> candidates = listForceCandidates(sizes);
  for (const std::vector<TermCandidate>& more :
       {listBodyCandidates(model, sizes), listOutputCandidates(model, sizes), listSignalCandidates(model),
        listOwnCandidates(experiment.candidates, sizes), listMemoryCandidates(model, sizes)}) {
    candidates.insert(candidates.end(), more.begin(), more.end());
  }
  return candidates;
}

void addScanned(const TermCandidate& candidate, double first, double factor, int count,
                std::vector<TermCandidate>& candidates) {
  double value = first;
  for (int i = 0; i < count; ++i, value *= factor) {
    candidates.push_back(candidate);
    candidates.back().own_scales.front().value = value;
  }
}

std::string addState(ModelSpec& model, const std::string& name, const std::string& initial,
                     const std::string& unit) {
  StateSpec state;
  state.name = {makeParameterName(model, name), {}};
  state.derivative = {"0", {}};
  state.initial = {initial, {}};
  state.unit = unit;
  model.system.states.push_back(state);
  return state.name.text;
}

std::string findInitial(const std::vector<NamedExpression>& initial, const std::string& name) {
  const auto found = std::find_if(initial.begin(), initial.end(),
                                  [&](const NamedExpression& one) { return one.name.text == name; });
  return found == initial.end() ? "0" : "(" + found->value.text + ")";
}

}  // namespace twinmap
