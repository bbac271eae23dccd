#pragma once

#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// Everything that a single value cannot show: names refer to something, names are unique, expressions use
/// known names and come out in the right unit, joints have their coordinates, feature times lie within the
/// simulation, every output has its noise. Throws ExperimentError for the first thing wrong.
void checkExperiment(const ExperimentSpec& experiment);

/// All but its model: of one whose model has been checked.
void checkBesideModel(const ExperimentSpec& experiment);

/// Parts of it, in this order.
void checkModel(const ModelSpec& model);
void checkTransform(const ExperimentSpec& experiment);
void checkDerived(const ExperimentSpec& experiment);
void checkCandidates(const ExperimentSpec& experiment);

/// Throws ExperimentError unless `name` is one of `known`; `what` says what it should be ("a body").
void requireKnown(const Name& name, const std::vector<std::string>& known, const std::string& what);

/// The texts of the `name` members.
template <class T>
std::vector<std::string> collectNames(const std::vector<T>& items) {
  std::vector<std::string> names;
  for (const T& item : items) {
    names.push_back(item.name.text);
  }
  return names;
}

}  // namespace twinmap
