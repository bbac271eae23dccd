#include "framework/inference/segments/segment_inference.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "framework/data/features/experiment_features.hpp"
#include "framework/data/measurement/measured_signals.hpp"
#include "framework/data/measurement/measurement.hpp"
#include "framework/data/measurement/time_series.hpp"
#include "framework/data/noise/feature_noise.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/derived_values.hpp"
#include "framework/inference/refiner.hpp"
#include "framework/inference/tolerances/tolerances.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

double findEnd(const Table& table, const MeasurementSpec& spec, double start) {
  const Index rows = table.columns.empty() ? 0 : table.columns.front().values.size();
  double end = 0.0;
  for (const double time : readUnorderedTimes(table, makeTimeBase(spec, start), rows)) {
    end = std::isfinite(time) ? std::max(end, time) : end;
  }
  return end;
}

/// A recording's outputs at the samples of all segments.
struct ReadSegments {
  SegmentSamples samples;
  std::vector<std::string> remarks;
};

ReadSegments readSegments(const Table& table, double start, const ExperimentSpec& experiment,
                          const SegmentGrid& grid) {
  const ExperimentSpec whole = makeRecordingExperiment(experiment, grid);
  const ResponseLayout layout = makeLayout(whole);
  AvailableResponse read =
      readAvailable(table, whole.measurement, layout, start, grid.interval, whole.features);
  if (read.stddev.size() > 0) {
    requireNoneStated({read.stddev, {}}, table.source);
  }
  ReadSegments segments{{}, std::move(read.remarks)};
  const MatrixXd samples = read.response.reshaped(layout.times.size(), layout.getOutputCount());
  for (int k = 0; k < grid.count; ++k) {
    segments.samples.emplace_back(samples.middleRows(Index{k} * grid.samples, grid.samples));
  }
  return segments;
}

NoiseWhitener makeWhitener(const ExperimentSpec& experiment, const ResponseLayout& layout,
                           const FeatureExtractor& extractor) {
  for (const OutputNoiseSpec& noise : experiment.noise.stddev) {
    if (noise.stddev.unknown) {
      throw ExperimentError(noise.stddev.where, noise.name.text,
                            "must be known for inference in segments: give its noise a number");
    }
  }
  const FeatureNoise noise(extractor, ResponseNoise(experiment.noise, layout), experiment.seed);
  try {
    return NoiseWhitener(noise.calcCovariance({}));
  } catch (const std::invalid_argument& error) {
    throw ExperimentError(std::string(error.what()) +
                          ": give every output that features read a 'noise.stddev'");
  }
}

std::vector<Index> orderByTime(const std::vector<FeatureInfo>& infos) {
  std::vector<Index> order(infos.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return infos[static_cast<std::size_t>(a)].time < infos[static_cast<std::size_t>(b)].time;
  });
  return order;
}

/// The unknown parameters of a segment's model but for its states.
std::vector<ParameterSpec> collectShared(const ModelSpec& segment, std::size_t states) {
  std::vector<ParameterSpec> unknown = collectUnknown(segment);
  unknown.resize(unknown.size() - states);
  return unknown;
}

/// What is ready to be inferred.
struct PreparedSegments {
  ExperimentSpec experiment;  ///< of a segment
  std::unique_ptr<Simulator> simulator;
  std::shared_ptr<const SegmentedRecording> recording;
};

/// whole: of the recording, with its excitation.
PreparedSegments prepare(const ExperimentSpec& whole, const SegmentGrid& grid, const VectorXd& known,
                         const SegmentSamples& samples) {
  const std::vector<StartState> states = listStartStates(whole.model);
  const StateGuess guess = guessStates(whole.model, states, grid.interval, samples);
  const ExperimentSpec segment = followNoise(makeSegmentExperiment(whole, grid, states, guess));
  const ResponseLayout layout = makeLayout(segment);
  std::unique_ptr<Simulator> simulator = makeSimulator(segment.model, layout.times);
  if (!simulator->hasDerivatives()) {
    throw ExperimentError("segments need exact derivatives, which this model does not have (" +
                          simulator->getEngine() + ")");
  }
  FeatureExtractor extractor = makeExtractor(segment, layout);
  NoiseWhitener whitener = makeWhitener(segment, layout, extractor);
  std::vector<Index> order = orderByTime(extractor.getInfos());
  MatrixXd features(extractor.getFeatureCount(), grid.count);
  VectorXd starts(grid.count);
  for (int k = 0; k < grid.count; ++k) {
    features.col(k) = extractor.extract(samples[static_cast<std::size_t>(k)].reshaped());
    starts[k] = grid.calcStart(k);
  }
  auto recording = std::make_shared<const SegmentedRecording>(SegmentedRecording{
      collectShared(segment.model, states.size()), known, std::move(extractor), std::move(whitener),
      std::move(order), std::move(features), std::move(starts), guess.states, guess.scales});
  return {segment, std::move(simulator), std::move(recording)};
}

/// In the order of the residual.
std::vector<FeatureInfo> listSamples(const PreparedSegments& prepared) {
  const SegmentedRecording& recording = *prepared.recording;
  const std::vector<std::string>& outputs = prepared.simulator->getLayout().output_names;
  std::vector<FeatureInfo> samples;
  for (const double start : recording.starts) {
    for (const Index i : recording.order) {
      samples.push_back(recording.extractor.getInfos()[static_cast<std::size_t>(i)]);
      FeatureInfo& info = samples.back();
      info.time += start;
      info.name = fmt::format("{}({:.6g} s)", outputs[static_cast<std::size_t>(info.output)], info.time);
    }
  }
  return samples;
}

PosteriorProblem makeProblem(const PreparedSegments& prepared) {
  const std::vector<ParameterSpec>& unknown = prepared.recording->unknown;
  MeasuredTrial trial{prepared.simulator.get(), nullptr, {}, {}, std::vector<Index>(unknown.size())};
  std::iota(trial.unknown.begin(), trial.unknown.end(), Index{0});
  trial.segments = prepared.recording;
  return {unknown, prepared.experiment.model.priors, {trial}, static_cast<Index>(unknown.size())};
}

void requireComplete(const SegmentedRecording& recording, const std::string& source) {
  if (!recording.whitener.isDiagonal() && recording.features.hasNaN()) {
    throw MeasurementError(source +
                           ": lacks samples, which noise that is not white does not allow in segments");
  }
  const auto states = static_cast<double>(recording.scales.size() * recording.starts.size());
  const auto samples = static_cast<double>(recording.features.array().isFinite().count());
  if (!(samples > states + static_cast<double>(recording.unknown.size()))) {
    throw MeasurementError(fmt::format(
        "{}: has {} samples, no more than its {} initial states and {} parameters; give longer segments",
        source, samples, states, recording.unknown.size()));
  }
}

}  // namespace

SegmentInference::SegmentInference(ExperimentSpec experiment, double length, VectorXd known, int draws)
    : experiment_(std::move(experiment)),
      length_(length),
      known_(std::move(known)),
      options_(makePosteriorOptions(experiment_, draws)) {
  const double end = experiment_.model.simulation.duration + length_;
  makeSegmentGrid(experiment_, length_, end);  // refuses what cannot be, whatever the recording
}

std::vector<std::string> SegmentInference::listColumns() const {
  std::vector<std::string> columns = MeasurementReader(experiment_).listColumns();
  const std::vector<std::string> signals = listSignalColumns(experiment_);
  columns.insert(columns.end(), signals.begin(), signals.end());
  return columns;
}

InferredMeasurement SegmentInference::infer(const Table& table, std::optional<double> start) const {
  const double zero = MeasurementReader(experiment_).getStart(table, start);
  const SegmentGrid grid =
      makeSegmentGrid(experiment_, length_, findEnd(table, experiment_.measurement, zero));
  ExperimentSpec whole = makeRecordingExperiment(experiment_, grid);
  replaceMeasuredSignals(whole, table, zero);
  const ReadSegments read = readSegments(table, zero, whole, grid);
  const PreparedSegments prepared = prepare(whole, grid, known_, read.samples);
  requireComplete(*prepared.recording, table.source);

  InferredMeasurement inferred;
  inferred.source = table.source;
  inferred.start = zero;
  inferred.left_out = read.remarks;
  inferred.segments =
      SegmentReport{grid.count, grid.getLength(), static_cast<int>(prepared.recording->scales.size()),
                    listSamples(prepared)};
  const ModelSpec& model = prepared.experiment.model;
  inferred.posterior = makePosteriorEstimate(
      samplePosterior(makeProblem(prepared), MatrixXd(prepared.recording->unknown.size(), 0), options_),
      prepared.recording->unknown, static_cast<Index>(model.parameters.size()), inferred.segments->samples);
  inferred.quantities = makeDerivedQuantities(experiment_);
  inferred.prior = findStatedPrior(model);
  return inferred;
}

}  // namespace twinmap
