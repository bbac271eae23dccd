#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "framework/diagnosis/candidates/augment.hpp"
#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"

namespace twinmap {
namespace {

void enlarge(const CoordinateSizes& by, std::vector<CoordinateSizes>& coordinates) {
  const auto same = std::find_if(coordinates.begin(), coordinates.end(),
                                 [&](const CoordinateSizes& one) { return one.name == by.name; });
  if (same == coordinates.end()) {
    coordinates.push_back(by);
    return;
  }
  same->reach = std::max(same->reach, by.reach);
  same->speed = std::max(same->speed, by.speed);
  same->force = std::max(same->force, by.force);
  same->gravity = std::max(same->gravity, by.gravity);
  same->is_weighed = same->is_weighed || by.is_weighed;
}

/// `to` is as large as `from`, each number of it.
void enlarge(const std::vector<double>& from, std::vector<double>& to) {
  for (std::size_t i = 0; i < std::min(from.size(), to.size()); ++i) {
    to[i] = std::max(to[i], from[i]);
  }
}

void enlarge(const std::vector<Extent>& from, std::vector<Extent>& to) {
  for (std::size_t i = 0; i < std::min(from.size(), to.size()); ++i) {
    to[i] = {std::max(to[i].largest, from[i].largest), std::min(to[i].least, from[i].least)};
  }
}

/// All as large as in any trial; signals and outputs, where they may not be the same ones, if there are as
/// many.
void shareSizes(std::vector<ModelSizes>& sizes) {
  ModelSizes largest = sizes.front();
  for (const ModelSizes& one : sizes) {
    for (const CoordinateSizes& coordinate : one.coordinates) {
      enlarge(coordinate, largest.coordinates);
    }
    enlarge(one.signals, largest.signals);
    enlarge(one.outputs, largest.outputs);
    for (std::size_t i = 0; i < largest.own_forces.size(); ++i) {
      enlarge(one.own_forces[i], largest.own_forces[i]);
    }
  }
  for (ModelSizes& one : sizes) {
    one.coordinates = largest.coordinates;
    one.own_forces = largest.own_forces;
    if (one.signals.size() == largest.signals.size() && one.outputs.size() == largest.outputs.size()) {
      one.signals = largest.signals;
      one.outputs = largest.outputs;
    }
  }
}

}  // namespace

std::vector<TermCandidate> listTrialCandidates(const ExperimentSpec& combined,
                                               std::vector<ModelSizes> sizes) {
  shareSizes(sizes);
  std::vector<TermCandidate> all;
  std::map<std::pair<std::string, int>, std::size_t> places;  // of a term and the number of its scale
  for (std::size_t t = 0; t < sizes.size(); ++t) {
    std::map<std::string, int> scales;
    for (TermCandidate& one : listCandidates(combined.trials[t].experiment, sizes[t])) {
      const auto [place, is_new] = places.try_emplace({one.term, scales[one.term]++}, all.size());
      if (is_new) {
        all.push_back(one);
        all.back().add_to_trials.resize(sizes.size());
      }
      TermCandidate& shared = all[place->second];
      shared.size = std::max(shared.size, one.size);
      shared.add_to_trials[t] = std::move(one.add);
    }
  }
  return all;
}

std::vector<TermCandidate> listCandidates(const ExperimentSpec& experiment, const ModelSizes& sizes) {
  const ModelSpec& model = experiment.model;
  std::vector<TermCandidate> candidates = listForceCandidates(sizes);
  const auto add = [&](const std::vector<TermCandidate>& more, TermPlace place) {
    for (const TermCandidate& one : more) {
      candidates.push_back(one);
      candidates.back().place = place;
    }
  };
  add(listBodyCandidates(model, sizes), TermPlace::kMachine);
  add(listOutputCandidates(model, sizes), TermPlace::kSensors);
  add(listSignalCandidates(model, sizes), TermPlace::kInputs);
  add(listOwnCandidates(experiment.candidates, sizes), TermPlace::kMachine);
  add(listMemoryCandidates(model, sizes), TermPlace::kMachine);
  add(listLawCandidates(model, sizes), TermPlace::kMachine);
  add(listStartCandidates(model, sizes), TermPlace::kStart);
  add(listLoadCandidates(model, sizes), TermPlace::kMachine);
  add(listContactCandidates(model, sizes), TermPlace::kMachine);
  return candidates;
}

const char* getName(TermPlace place) {
  constexpr const char* kNames[] = {"machine", "start", "inputs", "sensors"};
  return kNames[static_cast<int>(place)];
}

void addScanned(const TermCandidate& candidate, double first, double factor, int count,
                std::vector<TermCandidate>& candidates) {
  double value = first;
  for (int i = 0; i < count; ++i, value *= factor) {
    candidates.push_back(candidate);
    candidates.back().own_scales.front().value = value;
  }
}

void addLimits(const TermCandidate& candidate, const Extent& extent, double first, double last, double factor,
               std::vector<TermCandidate>& candidates) {
  constexpr double kSmallest = 1.0 / 16.0;  // of the largest: a test that hardly moves shows no limits
  const double from = first * std::max(extent.least, kSmallest * extent.largest);
  const double ratio = last * extent.largest / from;
  const int steps = std::max(1, static_cast<int>(std::ceil(std::log(ratio) / std::log(factor) - 1e-9)));
  addScanned(candidate, from, std::pow(ratio, 1.0 / steps), steps + 1, candidates);
}

void addForceLaw(ModelSpec& model, const std::string& coordinate, const std::string& force) {
  ForceLaw<Expression> law;
  law.coordinate = {coordinate, {}};
  law.force = {force, {}};
  model.system.elements.get<ForceLaw>().push_back(law);
}

std::string getLength(const CoordinateSizes& coordinate) {
  return coordinate.is_angle ? "rad" : "m";
}

std::string writeBeyond(const std::string& value, const std::string& limit) {
  return fmt::format("(max({0} - {1}, 0) + min({0} + {1}, 0))", value, limit);
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
