#include "framework/inference/segments/segment_experiment.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "framework/base/text/number_text.hpp"
#include "framework/data/measurement/time_series.hpp"
#include "framework/experiment/check/unused_parameters.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"

namespace twinmap {
namespace {

/// The samples of all features, which have one interval.
const SamplesFeatureSpec& getSamples(const ExperimentSpec& experiment) {
  const SamplesFeatureSpec* first = nullptr;
  for (const FeatureSpec& feature : experiment.features) {
    const auto* samples = std::get_if<SamplesFeatureSpec>(&feature);
    if (samples == nullptr) {
      throw ExperimentError("segments are fitted sample by sample; leave only 'samples' among the features");
    }
    first = first == nullptr ? samples : first;
    if (samples->interval != first->interval) {
      throw ExperimentError("in segments all outputs are sampled at one interval; here " +
                            toShortText(first->interval, kEstimateDigits) + " s and " +
                            toShortText(samples->interval, kEstimateDigits) + " s");
    }
  }
  return *first;
}

std::size_t countOutputs(const ExperimentSpec& experiment) {
  std::set<std::string> outputs;
  for (const Name& output : collectOutputs(experiment.features)) {
    outputs.insert(output.text);
  }
  return outputs.size();
}

/// Throws unless a segment has more samples than states.
void requireSamples(const ExperimentSpec& experiment, const SegmentGrid& grid) {
  const std::size_t states = listStartStates(experiment.model).size(), outputs = countOutputs(experiment);
  const auto enough = static_cast<double>(states / outputs + 1);
  if (grid.samples * outputs <= states) {
    throw ExperimentError(fmt::format(
        "a segment of {} s has {} samples of {} outputs, which do not determine its {} initial states and "
        "anything beside; give segments of {} s or more",
        toShortText(grid.getLength(), kEstimateDigits), grid.samples, outputs, states,
        toShortText(enough * grid.interval, kEstimateDigits)));
  }
}

std::vector<FeatureSpec> resample(std::vector<FeatureSpec> features, double start, int count) {
  for (FeatureSpec& feature : features) {
    auto& samples = std::get<SamplesFeatureSpec>(feature);
    samples.start = start;
    samples.count = count;
  }
  return features;
}

std::string makeUnique(std::string name, const ModelSpec& model) {
  const auto isTaken = [&](const auto& items) {
    return std::any_of(items.begin(), items.end(), [&](const auto& item) { return item.name.text == name; });
  };
  while (isTaken(model.parameters) || isTaken(model.nuisance) || isTaken(model.inputs) ||
         isTaken(model.constants)) {
    name += "_";
  }
  return name;
}

void requireUsed(const ExperimentSpec& experiment) {
  if (const std::vector<std::string> unused = listUnused(experiment, "parameters"); !unused.empty()) {
    throw ExperimentError("nothing uses parameter '" + unused.front() +
                          "': name it in an expression of the system, or take it out");
  }
}

/// Takes out the nuisance parameters that nothing uses any more.
void dropUnused(ExperimentSpec& experiment) {
  if (const std::vector<std::string> unused = listUnused(experiment, "parameters"); !unused.empty()) {
    throw ExperimentError("parameter '" + unused.front() +
                          "' is of the initial state alone, which is each segment's own; make it a nuisance");
  }
  for (const std::string& name : listUnused(experiment, "nuisance")) {
    std::vector<ParameterSpec>& nuisance = experiment.model.nuisance;
    nuisance.erase(std::remove_if(nuisance.begin(), nuisance.end(),
                                  [&](const ParameterSpec& one) { return one.name.text == name; }),
                   nuisance.end());
  }
}

}  // namespace

double SegmentGrid::calcStart(int k) const {
  return calcSampleTime(SamplesFeatureSpec{{}, offset, interval, 0}, k * samples);
}

SegmentGrid makeSegmentGrid(const ExperimentSpec& experiment, double length, double end) {
  if (const std::string memory = findUnstartable(experiment.model); !memory.empty()) {
    throw ExperimentError("segments start from states of their own, which " + memory);
  }
  const SamplesFeatureSpec& samples = getSamples(experiment);
  SegmentGrid grid;
  grid.interval = samples.interval;
  grid.offset = samples.start;
  grid.samples = static_cast<int>(std::lround(length / grid.interval));
  requireSamples(experiment, grid);
  const double there = std::floor((end - grid.offset) / grid.interval + kSameTime) + 1.0;
  grid.count = static_cast<int>(std::max(0.0, there) / grid.samples);
  if (grid.count < 1) {
    throw ExperimentError(fmt::format("the recording ends {} s behind its start, before a segment of {} s",
                                      toShortText(end, kEstimateDigits),
                                      toShortText(grid.getLength(), kEstimateDigits)));
  }
  return grid;
}

ExperimentSpec makeRecordingExperiment(ExperimentSpec experiment, const SegmentGrid& grid) {
  experiment.features = resample(std::move(experiment.features), grid.offset, grid.count * grid.samples);
  experiment.model.simulation.duration =
      calcSampleTime(SamplesFeatureSpec{{}, grid.offset, grid.interval, 0}, grid.count * grid.samples - 1);
  return experiment;
}

ExperimentSpec makeSegmentExperiment(ExperimentSpec experiment, const SegmentGrid& grid,
                                     const std::vector<StartState>& states, const StateGuess& guess) {
  requireUsed(experiment);
  ModelSpec& model = experiment.model;
  std::vector<Expression> names;
  for (std::size_t i = 0; i < states.size(); ++i) {
    names.push_back({makeUnique(fmt::format("start_{}", i + 1), model), {}});
  }
  setStartStates(names, model);
  dropUnused(experiment);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double middle = guess.states.row(row).mean(), scale = guess.scales[row];
    ParameterSpec state;
    state.name.text = names[i].text;
    state.bounds = {middle - scale, middle + scale, {}};
    model.nuisance.push_back(state);
  }
  ParameterSpec origin;
  origin.name.text = makeUnique("segment_start", model);
  origin.bounds = {0.0, grid.calcStart(grid.count), {}};
  model.inputs.push_back(origin);
  model.time_origin = origin.name;
  experiment.features = resample(std::move(experiment.features), 0.0, grid.samples);
  model.simulation.duration = calcSampleTime(SamplesFeatureSpec{{}, 0.0, grid.interval, 0}, grid.samples - 1);
  return experiment;
}

}  // namespace twinmap
