#include "framework/study/replay/replay.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "framework/data/measurement/files/read_table.hpp"
#include "framework/data/measurement/measured_signals.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/estimation/draws.hpp"
#include "framework/estimation/trained/refinement_starts.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/ensemble.hpp"
#include "framework/inference/measurement/posterior_need.hpp"
#include "framework/inference/refiner.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/simulation/sample_generator.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// With the columns of measured signals.
Table readWindow(const InferenceSource& source, const MeasuredWindow& window) {
  const MeasurementReader& reader = source.getReader();
  std::vector<std::string> columns = reader.listColumns();
  const std::vector<std::string> signals = listSignalColumns(reader.getExperiment());
  columns.insert(columns.end(), signals.begin(), signals.end());
  return readTable(window.file, columns,
                   source.findTrained() != nullptr ? MissingCells::kRefuse : MissingCells::kKeep);
}

/// What was measured in a window, and the model with the excitation of the window.
struct Window {
  Window(ExperimentSpec followed, const ResponseLayout& rows, VectorXd measured)
      : experiment(std::move(followed)),
        layout(rows),
        response(std::move(measured)),
        noise_stddev(calcNoiseStddev(experiment.noise, layout)),
        refiner(experiment, layout),
        features(refiner.getExtractor().extract(response)) {}

  const ExperimentSpec experiment;
  const ResponseLayout layout;
  const VectorXd response;  ///< NaN where missing
  VectorXd noise_stddev;
  const SimulatorRefiner refiner;
  const VectorXd features;
};

/// Of a trained run, which needs every sample.
Window readWhole(const MeasurementReader& reader, const Table& table, double start) {
  ExperimentSpec experiment = reader.getExperiment();
  replaceMeasuredSignals(experiment, table, start);
  const VectorXd response = reader.readResponse(table, start);
  extractFeatures(reader.getExtractor(), response, table.source);  // throws where one is missing
  return {std::move(experiment), reader.getLayout(), response};
}

/// Of an experiment alone: at the times of the recording, with its excitation, what there is.
Window readThere(const MeasurementReader& reader, const Table& table, double start) {
  if (std::optional<ExperimentSpec> followed = reader.follow(table, start)) {
    const MeasurementReader own(std::move(*followed));
    return {own.getExperiment(), own.getLayout(), own.readAvailableFeatures(table, start).response};
  }
  return {reader.getExperiment(), reader.getLayout(), reader.readAvailableFeatures(table, start).response};
}

void requireOk(const SampleStatus& status, const std::string& what) {
  if (!status.ok) {
    throw std::runtime_error(what + " could not be simulated: " + status.reason);
  }
}

InferredMeasurement infer(const Inferrer& inferrer, const Window& window, const ReplayOptions& options) {
  OnlineWorkspace workspace(inferrer.getModel());
  InferredMeasurement inferred = inferrer.infer(window.features, options.known, workspace);
  inferred.source = options.from.file.string();
  inferred.start = options.from.start;
  if (options.refine.value_or(window.refiner.isWanted())) {
    const std::optional<TrustModel>& trust = inferrer.getTrustModel();
    const TrustModel* judged_by = trust ? &*trust : nullptr;
    window.refiner.refineAndJudge(window.features, options.known, judged_by, inferred);
    if (window.refiner.samplesFast() && needsPosterior(inferred, inferrer.getExperiment().model.parameters,
                                                       window.refiner.getExtractor().getInfos())) {
      const int draws = SimulatorPosteriorOptions{}.draws;
      window.refiner.sampleAndJudge(window.features, options.known, judged_by,
                                    makePosteriorOptions(inferrer.getExperiment(), draws), inferred);
    }
  }
  return inferred;
}

class Replayer {
 public:
  Replayer(const ExperimentSpec& experiment, Window& window, Replay& replay)
      : experiment_(experiment),
        model_(experiment.model),
        window_(window),
        replay_(replay),
        estimate_(selectEstimate(replay.inferred)) {
    takeNoise();
    if (replay.options.measurement == replay.options.from) {
      explanation_ = findExplanation();
    }
  }

  void run() {
    const Index p = static_cast<Index>(model_.parameters.size());
    const int draws = estimate_.isGiven() ? replay_.options.draws : 0;
    fitNuisance(calcBoxCenter(model_.parameters), replay_.nominal);
    findUpdated();
    MatrixXd points(replay_.updated.point.size(), 2 + draws);
    points.colwise() = replay_.updated.point;
    points.col(0) = replay_.nominal.point;
    points.topRightCorner(p, draws) = draw(draws);
    const MatrixXd responses = simulate(points);
    setResponse(responses.col(0), replay_.nominal);
    setResponse(responses.col(1), replay_.updated);
    constexpr double kTail = 0.025;
    const MatrixXd ensemble = responses.rightCols(std::max(draws, 1));  // without draws the updated model
    replay_.lower = calcRowQuantiles(ensemble, kTail);
    replay_.upper = calcRowQuantiles(ensemble, 1.0 - kTail);
  }

 private:
  /// That which was found, in the place of what nobody stated.
  void takeNoise() {
    const SimulatorFit* fit = findFit(replay_.inferred);
    for (const NoiseReport& report : fit != nullptr ? fit->noise : std::vector<NoiseReport>()) {
      if (!report.isStated()) {
        window_.noise_stddev
            .segment(window_.layout.getRow(report.found.output, 0), window_.layout.times.size())
            .setConstant(report.stddev);
      }
    }
    replay_.noise_stddev = window_.noise_stddev;
  }

  /// The point of the sampled box that explains the measurement, by what gave the estimate; empty: none.
  VectorXd findExplanation() const {
    const InferredMeasurement& inferred = replay_.inferred;
    if (estimate_.method != EstimationMethod::kPosterior) {
      return estimate_.isRefined() ? inferred.refined->point : inferred.explanation;
    }
    const SimulatorFit* fit = findFit(replay_.inferred);
    if (fit == nullptr) {
      throw std::runtime_error("nothing could be simulated within the bounds");
    }
    const auto unknown = static_cast<Index>(model_.parameters.size() + model_.nuisance.size());
    const VectorXd& known = replay_.options.known;  // behind a clock's, best has more
    VectorXd point(unknown + known.size());
    point << fit->best.head(unknown), known;
    return point;
  }

  /// Whether the nuisance parameters can be sought by least squares.
  bool canFit() const { return window_.features.allFinite() && !isNoiseUnknown(); }
  bool isNoiseUnknown() const {
    const std::vector<OutputNoiseSpec>& noise = experiment_.noise.stddev;
    return std::any_of(noise.begin(), noise.end(),
                       [](const OutputNoiseSpec& spec) { return spec.stddev.unknown; });
  }

  void fitNuisance(const VectorXd& parameters, ReplayedModel& model) const {
    model.point = makePoint(model_, parameters, explanation_, replay_.options.known);
    if (model_.nuisance.empty() || canFit()) {
      const Refined fitted = window_.refiner.fitNuisance(model.point, window_.features);
      model.point = fitted.point;
      model.nuisance_converged = fitted.hasConverged();
    }
  }

  /// A posterior's best fit where nothing was estimated; of an experiment alone with its nuisance parameters.
  void findUpdated() {
    const auto p = static_cast<Index>(model_.parameters.size());
    const VectorXd parameters = estimate_.isGiven() ? estimate_.mean : findExplanation().head(p);
    if (!canFit() && explanation_.size() > 0) {
      replay_.updated.point = explanation_;
      return;
    }
    fitNuisance(clipToBounds(parameters, model_.parameters), replay_.updated);
  }

  MatrixXd draw(int draws) const {
    if (draws == 0) {
      return MatrixXd(static_cast<Index>(model_.parameters.size()), 0);
    }
    const RandomStream random(experiment_.seed, RandomPurpose::kEnsemble);
    return clipToBounds(drawFrom(estimate_, draws, random), model_.parameters);
  }

  MatrixXd simulate(const MatrixXd& points) const {
    GeneratorOptions options;
    options.threads = replay_.options.threads;
    const Trajectories simulated = generateSamples(window_.refiner.getSimulator(), points, options);
    for (std::size_t i = 0; i < simulated.statuses.size(); ++i) {
      requireOk(simulated.statuses[i], i == 0   ? "the nominal model"
                                       : i == 1 ? "the updated model"
                                                : "draw " + std::to_string(i - 1) + " of the ensemble");
    }
    return simulated.responses;
  }

  void setResponse(const VectorXd& response, ReplayedModel& model) const {
    model.response = response;
    model.fits = calcFits(replay_.measured, response, replay_.noise_stddev, replay_.layout);
  }

  const ExperimentSpec& experiment_;
  const ModelSpec& model_;
  Window& window_;
  Replay& replay_;
  const Estimate estimate_;
  VectorXd explanation_;  // of the window; empty: its nuisance parameters are sought from the box's centre
};

void requireWhole(const MeasurementReader& reader) {
  if (reader.findReduction() != nullptr) {
    throw ExperimentError(
        "a run of reduced samples cannot be replayed; infer from the experiment file, which needs no run, "
        "and simulate there, or give the samples 'reduce: none'");
  }
}

Window readWindow(const InferenceSource& source, const Table& table, double start) {
  return source.findTrained() != nullptr ? readWhole(source.getReader(), table, start)
                                         : readThere(source.getReader(), table, start);
}

/// From the window that is replayed, or another.
InferredMeasurement inferFrom(const InferenceSource& source, const Table& table, const Window& window,
                              const ReplayOptions& options) {
  const bool same_file = options.from.file == options.measurement.file;
  const Table other = same_file ? Table() : readWindow(source, options.from);
  const Table& from = same_file ? table : other;
  const Inferrer* trained = source.findTrained();
  if (trained == nullptr) {
    SessionOptions session;
    session.refine = options.refine;
    return source.makeSession(session)->infer(from, options.from.start, options.known);
  }
  source.getReader().requireExcitation(from, options.from.start);
  return options.from == options.measurement
             ? infer(*trained, window, options)
             : infer(*trained, readWhole(source.getReader(), from, options.from.start), options);
}

Replay draw(const InferenceSource& source, Window& window, InferredMeasurement inferred,
            const ReplayOptions& options) {
  Replay replay;
  replay.options = options;
  replay.experiment = window.experiment;
  replay.inferred = std::move(inferred);
  replay.layout = window.layout;
  replay.measured = window.response;
  Replayer(source.getExperiment(), window, replay).run();
  return replay;
}

}  // namespace

Replay replay(const InferenceSource& source, const ReplayOptions& options) {
  requireWhole(source.getReader());
  const Table table = readWindow(source, options.measurement);
  Window window = readWindow(source, table, options.measurement.start);
  InferredMeasurement inferred = inferFrom(source, table, window, options);
  return draw(source, window, std::move(inferred), options);
}

Replay replayInferred(const InferenceSource& source, const Table& table, const InferredMeasurement& inferred,
                      const ReplayOptions& options) {
  requireWhole(source.getReader());
  Window window = readThere(source.getReader(), table, options.measurement.start);
  return draw(source, window, inferred, options);
}

std::vector<OutputFit> calcFits(const VectorXd& measured, const VectorXd& response,
                                const VectorXd& noise_stddev, const ResponseLayout& layout) {
  const Index times = layout.times.size();
  std::vector<OutputFit> fits;
  for (Index output = 0; output < layout.getOutputCount(); ++output) {
    std::vector<Index> there;
    for (Index i = 0; i < times; ++i) {
      if (const Index row = layout.getRow(output, 0) + i; std::isfinite(measured[row])) {
        there.push_back(row);
      }
    }
    if (there.empty()) {
      fits.emplace_back();
      continue;
    }
    const VectorXd residual = measured(there) - response(there);
    const VectorXd motion = measured(there).array() - measured(there).mean();
    const VectorXd in_sd = residual.cwiseQuotient(noise_stddev(there));
    const double root = std::sqrt(static_cast<double>(there.size()));
    fits.push_back(
        {100.0 * residual.norm() / motion.norm(), in_sd.norm() / root, in_sd.cwiseAbs().maxCoeff()});
  }
  return fits;
}

}  // namespace twinmap
