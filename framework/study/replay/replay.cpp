#include "framework/study/replay/replay.hpp"

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

Table readWindow(const Inferrer& inferrer, const MeasuredWindow& window) {
  std::vector<std::string> columns = inferrer.getReader().listColumns();
  const std::vector<std::string> signals = listSignalColumns(inferrer.getExperiment());
  columns.insert(columns.end(), signals.begin(), signals.end());
  return readTable(window.file, columns);
}

ExperimentSpec makeExperiment(const Inferrer& inferrer, const Table& table, double start) {
  ExperimentSpec experiment = inferrer.getExperiment();
  replaceMeasuredSignals(experiment, table, start);
  return experiment;
}

/// What was measured in a window, and the model with the excitation of the window.
struct Window {
  Window(const Inferrer& inferrer, const Table& table, double start)
      : response(inferrer.getReader().readResponse(table, start)),
        refiner(makeExperiment(inferrer, table, start), inferrer.getLayout()),
        features(extractFeatures(refiner.getExtractor(), response, table.source)) {}

  const VectorXd response;
  const SimulatorRefiner refiner;
  const VectorXd features;
};

void requireOk(const SampleStatus& status, const std::string& what) {
  if (!status.ok) {
    throw std::runtime_error(what + " could not be simulated: " + status.reason);
  }
}

InferredMeasurement infer(const Inferrer& inferrer, const Window& window, const ReplayOptions& options) {
  Inferrer::Workspace workspace(inferrer);
  InferredMeasurement inferred = inferrer.infer(window.features, options.known, workspace);
  inferred.source = options.from.file.string();
  inferred.start = options.from.start;
  if (options.refine.value_or(window.refiner.isWanted())) {
    const std::optional<TrustModel>& trust = inferrer.getTrustModel();
    const TrustModel* judged_by = trust ? &*trust : nullptr;
    window.refiner.refineAndJudge(window.features, options.known, judged_by, inferred);
    if (window.refiner.samplesFast() && needsPosterior(inferrer, inferred)) {
      const int draws = SimulatorPosteriorOptions{}.draws;
      window.refiner.sampleAndJudge(window.features, options.known, judged_by,
                                    makePosteriorOptions(inferrer.getExperiment(), draws), inferred);
    }
  }
  return inferred;
}

class Replayer {
 public:
  Replayer(const Inferrer& inferrer, const Window& window, Replay& replay)
      : inferrer_(inferrer),
        model_(inferrer.getExperiment().model),
        window_(window),
        replay_(replay),
        estimate_(selectEstimate(replay.inferred)) {
    if (replay.options.measurement == replay.options.from) {
      explanation_ = findExplanation();
    }
  }

  void run() {
    const Index p = static_cast<Index>(model_.parameters.size());
    fitNuisance(calcBoxCenter(model_.parameters), replay_.nominal);
    fitNuisance(clipToBounds(estimate_.mean, model_.parameters), replay_.updated);
    MatrixXd points(replay_.updated.point.size(), 2 + replay_.options.draws);
    points.colwise() = replay_.updated.point;
    points.col(0) = replay_.nominal.point;
    points.topRightCorner(p, replay_.options.draws) = draw();
    const MatrixXd responses = simulate(points);
    setResponse(responses.col(0), replay_.nominal);
    setResponse(responses.col(1), replay_.updated);
    constexpr double kTail = 0.025;
    const MatrixXd ensemble = responses.rightCols(replay_.options.draws);
    replay_.lower = calcRowQuantiles(ensemble, kTail);
    replay_.upper = calcRowQuantiles(ensemble, 1.0 - kTail);
  }

 private:
  /// The point of the sampled box that explains the measurement, by what gave the estimate.
  VectorXd findExplanation() const {
    const InferredMeasurement& inferred = replay_.inferred;
    if (estimate_.method != EstimationMethod::kPosterior) {
      return estimate_.isRefined() ? inferred.refined->point : inferred.explanation;
    }
    const VectorXd &best = inferred.posterior->fit->best, &known = replay_.options.known;
    VectorXd point(best.size() + known.size());
    point << best, known;
    return point;
  }

  void fitNuisance(const VectorXd& parameters, ReplayedModel& model) const {
    const VectorXd start = makePoint(model_, parameters, explanation_, replay_.options.known);
    const Refined fitted = window_.refiner.fitNuisance(start, window_.features);
    model.point = fitted.point;
    model.nuisance_converged = fitted.hasConverged();
  }

  MatrixXd draw() const {
    const RandomStream random(inferrer_.getExperiment().seed, RandomPurpose::kEnsemble);
    const int draws = replay_.options.draws;
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

  const Inferrer& inferrer_;
  const ModelSpec& model_;
  const Window& window_;
  Replay& replay_;
  const Estimate estimate_;
  VectorXd explanation_;  // of the window; empty: its nuisance parameters are sought from the box's centre
};

InferredMeasurement inferFrom(const Inferrer& inferrer, const Table& table, const Window& window,
                              const ReplayOptions& options) {
  const bool same_file = options.from.file == options.measurement.file;
  const Table other = same_file ? Table() : readWindow(inferrer, options.from);
  const Table& source = same_file ? table : other;
  inferrer.getReader().requireExcitation(source, options.from.start);
  if (options.from == options.measurement) {
    return infer(inferrer, window, options);
  }
  return infer(inferrer, Window(inferrer, source, options.from.start), options);
}

}  // namespace

Replay replay(const Inferrer& inferrer, const ReplayOptions& options) {
  if (inferrer.getReader().findReduction() != nullptr) {
    throw ExperimentError(
        "a run of reduced samples cannot be replayed; infer from the experiment file, which needs no run, "
        "and simulate there, or give the samples 'reduce: none'");
  }
  const Table table = readWindow(inferrer, options.measurement);
  const Window window(inferrer, table, options.measurement.start);
  Replay replay;
  replay.options = options;
  replay.inferred = inferFrom(inferrer, table, window, options);
  replay.layout = inferrer.getLayout();
  replay.measured = window.response;
  replay.noise_stddev = calcNoiseStddev(inferrer.getExperiment().noise, replay.layout);
  Replayer(inferrer, window, replay).run();
  return replay;
}

std::vector<OutputFit> calcFits(const VectorXd& measured, const VectorXd& response,
                                const VectorXd& noise_stddev, const ResponseLayout& layout) {
  const Index times = layout.times.size();
  std::vector<OutputFit> fits;
  for (Index output = 0; output < layout.getOutputCount(); ++output) {
    const auto mine = Eigen::seqN(layout.getRow(output, 0), times);
    const VectorXd residual = measured(mine) - response(mine);
    const VectorXd motion = measured(mine).array() - measured(mine).mean();
    const VectorXd in_sd = residual.cwiseQuotient(noise_stddev(mine));
    const double root = std::sqrt(static_cast<double>(times));
    fits.push_back(
        {100.0 * residual.norm() / motion.norm(), in_sd.norm() / root, in_sd.cwiseAbs().maxCoeff()});
  }
  return fits;
}

}  // namespace twinmap
