#include <fmt/core.h>

#include <algorithm>

#include "framework/diagnosis/candidates/replace_name.hpp"
#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {
namespace {

/// Whether a start is inferred as it is.
bool isUnknown(const std::string& value, const std::vector<ParameterSpec>& unknown) {
  return std::any_of(unknown.begin(), unknown.end(), [&](const ParameterSpec& parameter) {
    return replaceName(value, parameter.name.text, "") != value;
  });
}

void shift(const std::string& name, const std::string& by, std::vector<NamedExpression>& initial) {
  const auto found = std::find_if(initial.begin(), initial.end(),
                                  [&](const NamedExpression& one) { return one.name.text == name; });
  if (found == initial.end()) {
    initial.push_back({{name, {}}, {by, {}}});
  } else {
    found->value.text = fmt::format("({}) + {}", found->value.text, by);
  }
}

void addStart(const CoordinateSizes& coordinate, bool is_speed, std::vector<TermCandidate>& candidates) {
  const std::string name = coordinate.name;
  TermCandidate candidate;
  candidate.term = (is_speed ? "start_speed." : "start.") + name;
  candidate.meaning = fmt::format("it starts {} {} larger by c", is_speed ? "with a speed of" : "at", name);
  candidate.unit = getLength(coordinate) + (is_speed ? "/s" : "");
  candidate.size = is_speed ? coordinate.speed : coordinate.reach;
  candidate.add = [name, is_speed](ModelSpec& model, const std::string& coefficient,
                                   const std::vector<std::string>&) {
    shift(name, coefficient, is_speed ? model.initial.speeds : model.initial.coordinates);
  };
  candidates.push_back(std::move(candidate));
}

}  // namespace

std::vector<TermCandidate> listStartCandidates(const ModelSpec& model, const ModelSizes& sizes) {
  std::vector<TermCandidate> candidates;
  if (model.initial.equilibrium) {
    return candidates;
  }
  const std::vector<ParameterSpec> unknown = collectUnknown(model);
  for (const CoordinateSizes& coordinate : sizes.coordinates) {
    if (!isUnknown(findInitial(model.initial.coordinates, coordinate.name), unknown)) {
      addStart(coordinate, false, candidates);
    }
    if (!isUnknown(findInitial(model.initial.speeds, coordinate.name), unknown)) {
      addStart(coordinate, true, candidates);
    }
  }
  return candidates;
}

}  // namespace twinmap
