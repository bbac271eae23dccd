#include "framework/inference/segments/segment_inference.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/base/log/search_stage.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "framework/data/measurement/measured_signals.hpp"
#include "framework/data/measurement/measurement.hpp"
#include "framework/data/measurement/time_series.hpp"
#include "framework/data/noise/feature_noise.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/derived_values.hpp"
#include "framework/inference/measurement/unknown_excitation.hpp"
#include "framework/inference/refiner.hpp"
#include "framework/inference/segments/segment_faults.hpp"
#include "framework/inference/segments/segmented_misfit.hpp"
#include "framework/inference/tolerances/tolerances.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/simulation/model_numbers.hpp"
#include "kernels/linalg/order.hpp"

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

void requireKnownNoise(const ExperimentSpec& experiment) {
  for (const OutputNoiseSpec& noise : experiment.noise.stddev) {
    if (noise.stddev.unknown) {
      throw ExperimentError(noise.stddev.where, noise.name.text,
                            "must be known for inference in segments: give its noise a number");
    }
  }
}

/// common: of the response's rows (ResponseNoise::share).
NoiseCovariance calcCovariance(const ExperimentSpec& experiment, const ResponseLayout& layout,
                               const FeatureExtractor& extractor, const MatrixXd& common) {
  ResponseNoise noise(experiment.noise, layout);
  noise.share(common);
  return FeatureNoise(extractor, noise, experiment.seed).calcCovariance({});
}

NoiseWhitener makeWhitener(const ExperimentSpec& experiment, const ResponseLayout& layout,
                           const FeatureExtractor& extractor) {
  requireKnownNoise(experiment);
  try {
    return NoiseWhitener(calcCovariance(experiment, layout, extractor, {}));
  } catch (const std::invalid_argument& error) {
    throw ExperimentError(std::string(error.what()) +
                          ": give every output that features read a 'noise.stddev'");
  }
}

std::vector<Index> orderByTime(const std::vector<FeatureInfo>& infos) {
  return sortIndices(static_cast<Index>(infos.size()), [&](Index a, Index b) {
    return infos[static_cast<std::size_t>(a)].time < infos[static_cast<std::size_t>(b)].time;
  });
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
  std::shared_ptr<SegmentedRecording> recording;
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
  std::vector<NoiseWhitener> whiteners{makeWhitener(segment, layout, extractor)};
  std::vector<Index> order = orderByTime(extractor.getInfos());
  MatrixXd features(extractor.getFeatureCount(), grid.count);
  VectorXd starts(grid.count);
  for (int k = 0; k < grid.count; ++k) {
    features.col(k) = extractor.extract(samples[static_cast<std::size_t>(k)].reshaped());
    starts[k] = grid.calcStart(k);
  }
  auto recording = std::make_shared<SegmentedRecording>(SegmentedRecording{
      collectShared(segment.model, states.size()), known, std::move(extractor), std::move(whiteners),
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
  MeasuredTrial trial{prepared.simulator.get(), nullptr, {}, {}, listIndices(unknown.size())};
  trial.make_misfit = [simulator = trial.simulator, recording = prepared.recording] {
    return std::make_unique<SegmentedMisfit>(*simulator, *recording);
  };
  return {unknown, prepared.experiment.model.priors, {trial}, static_cast<Index>(unknown.size())};
}

/// The part of the excitation that acts on a segment, so that each of its samples counts by itself.
ModelSpec takeExcitation(const ModelSpec& segment, const VectorXd& point, double start) {
  ModelSpec taken = segment;
  ModelNumbers numbers(segment);
  numbers.update(point);
  for (SignalSpec& signal : taken.excitation) {
    for (TableSpec& table : signal.tables) {
      const Expression* delay = table.findDelay();
      const double late = delay == nullptr ? 0.0 : numbers.calc(*delay, {"measured", "delay", "s"});
      const VectorXd times = VectorXd::Map(table.times.data(), static_cast<Index>(table.times.size()));
      const RowRange rows = findRows(times, start + late, start + late + segment.simulation.duration,
                                     static_cast<Index>(kSplineReach));
      if (rows.count >= 2) {
        cutTable(static_cast<std::size_t>(rows.first), static_cast<std::size_t>(rows.count), table);
      }
    }
  }
  return taken;
}

/// Whitens each segment by what is not known of the excitation within it, too. What acted before is in its
/// initial state. best: parameters. False where these cannot be simulated.
bool countUnknownExcitation(const VectorXd& best, PreparedSegments& prepared) {
  SegmentedRecording& recording = *prepared.recording;
  const MatrixXd states = SegmentedMisfit(*prepared.simulator, recording).findStates(best);
  const ResponseLayout& layout = prepared.simulator->getLayout();
  std::vector<NoiseWhitener> whiteners;
  SearchStage stage("what the unknown of the excitation does", static_cast<int>(states.cols()));
  for (Index k = 0; k < states.cols(); ++k) {
    VectorXd point(best.size() + states.rows() + recording.known.size() + 1);
    point << best, states.col(k), recording.known, recording.starts[k];
    const MatrixXd common = calcUnknownResponses(
        takeExcitation(prepared.experiment.model, point, recording.starts[k]), layout, point);
    const auto missing = recording.features.col(k).array().isNaN();
    const VectorXd apart = missing.select(1.0, VectorXd::Constant(missing.size(), NAN));  // of no weight
    whiteners.emplace_back(
        calcCovariance(prepared.experiment, layout, recording.extractor, common).replace(apart));
    stage.advance();
  }
  if (whiteners.empty()) {
    return false;
  }
  recording.whiteners = std::move(whiteners);
  return true;
}

SimulatorPosterior sample(PreparedSegments& prepared, const SimulatorPosteriorOptions& options) {
  const MatrixXd none(prepared.recording->unknown.size(), 0);
  SimulatorPosterior posterior = samplePosterior(makeProblem(prepared), none, options);
  const bool is_unknown = hasUnknownExcitation(prepared.experiment.model);
  for (int i = 0; is_unknown && i < kTimesCounted && posterior.best.size() > 0; ++i) {
    const VectorXd best = posterior.best;
    if (!countUnknownExcitation(best, prepared)) {
      break;
    }
    posterior = samplePosterior(makeProblem(prepared), best, options);
  }
  return posterior;
}

void requireComplete(const SegmentedRecording& recording, const std::string& source) {
  if (!recording.whiteners.front().isDiagonal() && recording.features.hasNaN()) {
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

struct SegmentFit {
  PreparedSegments prepared;
  SupposedSegments supposed;
  std::vector<FeatureInfo> samples;  ///< in the order of the residual
  PosteriorEstimate estimate;
};

/// One recording, from one supposition to the next.
class SegmentExplaining {
 public:
  SegmentExplaining(const SegmentGrid& grid, const VectorXd& known, const SimulatorPosteriorOptions& options,
                    const std::string& source)
      : grid_(grid), known_(known), options_(options), source_(source) {}

  SegmentFit fitAs(SupposedSegments supposed) const {
    SegmentFit fit{prepare(supposed.experiment, grid_, known_, supposed.samples), {}, {}, {}};
    requireComplete(*fit.prepared.recording, source_);
    fit.samples = listSamples(fit.prepared);
    fit.estimate = makePosteriorEstimate(sample(fit.prepared, options_), fit.prepared.recording->unknown,
                                         static_cast<Index>(fit.prepared.experiment.model.parameters.size()),
                                         fit.samples);
    if (fit.estimate.isReliable() && !takeOffsets(fit.estimate, supposed)) {
      supposed.noise.clear();
    }
    fit.estimate.fit->outliers = supposed.outliers;
    fit.estimate.fit->noise = supposed.noise;
    fit.supposed = std::move(supposed);
    return fit;
  }

  /// As it is stated or, where that does not explain it, without spikes or under other noise.
  SegmentFit explain(SupposedSegments read) const {
    SegmentFit fit = fitAs(std::move(read));
    const auto is_unexplained = [&] {
      return fit.estimate.fit->isSimulated() && !fit.estimate.fit->isPlausible();
    };
    if (!is_unexplained()) {
      return fit;
    }
    const ResponseLayout& layout = fit.prepared.simulator->getLayout();
    if (auto without = leaveSpikes(fit.supposed, layout, fit.prepared.recording->starts)) {
      SegmentFit other = fitAs(std::move(*without));
      if (other.estimate.fit->chi_square < kClearlyLess * fit.estimate.fit->chi_square) {
        fit = std::move(other);
      }
    }
    if (!is_unexplained()) {
      return fit;
    }
    for (SupposedSegments& noise : supposeNoise(
             fit.supposed, {fit.estimate.fit->residual, fit.samples, fit.prepared.simulator->getLayout()})) {
      SegmentFit other = fitAs(std::move(noise));
      const bool is_other = !other.estimate.fit->noise.empty();
      if (is_other && other.estimate.isReliable() && other.estimate.fit->isPlausible()) {
        return other;
      }
    }
    return fit;
  }

 private:
  const SegmentGrid& grid_;
  const VectorXd& known_;
  const SimulatorPosteriorOptions& options_;
  const std::string& source_;
};

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
  ReadSegments read = readSegments(table, zero, whole, grid);
  const SegmentFit fit =
      SegmentExplaining(grid, known_, options_, table.source).explain({whole, std::move(read.samples)});

  InferredMeasurement inferred;
  inferred.source = table.source;
  inferred.start = zero;
  inferred.left_out = read.remarks;
  inferred.remarks = describeBridged(whole.model);
  inferred.segments = SegmentReport{grid.count, grid.getLength(),
                                    static_cast<int>(fit.prepared.recording->scales.size()), fit.samples};
  inferred.posterior = fit.estimate;
  inferred.quantities = makeDerivedQuantities(experiment_);
  inferred.prior = findStatedPrior(fit.prepared.experiment.model);
  return inferred;
}

}  // namespace twinmap
