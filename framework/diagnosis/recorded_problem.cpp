#include "framework/diagnosis/recorded_problem.hpp"

#include <numeric>
#include <stdexcept>

#include "framework/data/measurement/measured_signals.hpp"
#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/estimation/posterior/search_team.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// With more unknown parameters than these, those of single recordings are integrated out (JointInferrer).
constexpr Index kMaxDrawnParameters = 8;

/// A trial with what simulates it around a point.
struct TrialMisfit {
  TrialMisfit(const MeasuredTrial& trial)
      : box(trial.model->getUnknown(), {0, static_cast<Index>(trial.model->getUnknown().size())}, trial.held),
        misfit(*trial.simulator, *trial.model, box, trial.features) {}

  const SearchBox box;
  Misfit misfit;
};

/// Where residuals are no neighbours in time of those before them.
void addStarts(const RefinementModel& model, Index first, std::vector<Index>& starts) {
  const std::vector<FeatureInfo>& infos = model.getExtractor().getInfos();
  const std::vector<Index>& features = model.getWhole().features;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const FeatureInfo& info = infos[static_cast<std::size_t>(features[i])];
    const FeatureInfo* before = i > 0 ? &infos[static_cast<std::size_t>(features[i - 1])] : nullptr;
    if (before == nullptr || before->output != info.output || before->time >= info.time) {
      starts.push_back(first + static_cast<Index>(i));
    }
  }
}

using Simulators = std::vector<std::unique_ptr<const SimulatorRefiner>>;

Simulators makeSimulators(const ExperimentSpec& experiment, const RecordedFeatures& recordings) {
  Simulators simulators;
  if (recordings.excitations.empty()) {
    simulators.push_back(std::make_unique<const SimulatorRefiner>(experiment, recordings.layout));
  }
  for (const std::vector<SignalSpec>& excitation : recordings.excitations) {
    ExperimentSpec own = experiment;
    copyMeasuredSignals(excitation, own.model);
    simulators.push_back(std::make_unique<const SimulatorRefiner>(own, recordings.layout));
  }
  simulators.front()->requireNoise();
  return simulators;
}

PosteriorProblem makeRecordedProblem(const Simulators& simulators, const ExperimentSpec& experiment,
                                     const RecordedFeatures& recordings) {
  PosteriorProblem problem;
  problem.unknown = experiment.model.parameters;
  problem.priors = experiment.model.priors;
  const std::vector<ParameterSpec>& own = simulators.front()->getUnknown();
  const std::size_t shared = problem.unknown.size();
  for (std::size_t k = 0; k < recordings.features.size(); ++k) {
    const SimulatorRefiner& simulator = *simulators[simulators.size() > 1 ? k : 0];
    MeasuredTrial trial = simulator.makeTrial(recordings.features[k], recordings.known);
    for (std::size_t j = shared; j < own.size(); ++j) {
      trial.unknown[j] = static_cast<Index>(problem.unknown.size());
      problem.unknown.push_back(own[j]);
      if (recordings.features.size() > 1) {
        problem.unknown.back().name.text += "[" + std::to_string(k + 1) + "]";
      }
    }
    problem.trials.push_back(std::move(trial));
  }
  const auto all = static_cast<Index>(problem.unknown.size());
  problem.drawn =
      recordings.features.size() == 1 || all <= kMaxDrawnParameters ? all : static_cast<Index>(shared);
  return problem;
}

}  // namespace

RecordedFeatures RecordedFeatures::select(const std::vector<std::size_t>& recordings) const {
  RecordedFeatures selected{layout, {}, known};
  for (const std::size_t k : recordings) {
    selected.features.push_back(features[k]);
    if (!excitations.empty()) {
      selected.excitations.push_back(excitations[k]);
    }
  }
  return selected;
}

RecordedFeatures RecordedFeatures::leaveOut(std::size_t recording) const {
  std::vector<std::size_t> others;
  for (std::size_t k = 0; k < features.size(); ++k) {
    if (k != recording) {
      others.push_back(k);
    }
  }
  return select(others);
}

void append(const RecordedFeatures& more, RecordedFeatures& recordings) {
  recordings.features.insert(recordings.features.end(), more.features.begin(), more.features.end());
  recordings.excitations.insert(recordings.excitations.end(), more.excitations.begin(),
                                more.excitations.end());
  if (!recordings.excitations.empty() && recordings.excitations.size() < recordings.features.size()) {
    throw MeasurementError("some recordings have a column of the measured excitation, and others have not");
  }
}

RecordedFeatures readRecording(const MeasurementReader& reader, const Table& table,
                               std::optional<double> start, const VectorXd& known) {
  RecordedFeatures recording{reader.getLayout(), {}, known};
  std::optional<MeasurementReader> own;
  const double duration = reader.getExperiment().model.simulation.duration;
  if (std::optional<ExperimentSpec> followed =
          reader.followExcitation(table, start, kDelayMargin * duration)) {
    recording.excitations.push_back(followed->model.excitation);
    own.emplace(std::move(*followed));
  }
  AvailableFeatures found = (own ? *own : reader).readAvailableFeatures(table, start);
  requireNoneStated(found.stated, table.source);
  recording.features.push_back(std::move(found.features));
  return recording;
}

RecordedFeatures readRecordings(const MeasurementReader& reader, const std::vector<std::string>& files,
                                const std::vector<double>& starts, const std::vector<KnownValue>& known) {
  RecordedFeatures recordings{
      reader.getLayout(), {}, collectKnown(reader.getExperiment().model.inputs, known)};
  std::vector<std::optional<double>> windows(starts.begin(), starts.end());
  if (windows.empty()) {
    windows.emplace_back(std::nullopt);
  }
  for (const std::string& file : files) {
    const Table table = readTable(file, reader.listColumns(), MissingCells::kKeep);
    for (const std::optional<double>& start : windows) {
      append(readRecording(reader, table, start, recordings.known), recordings);
    }
  }
  return recordings;
}

SingleRecording takeRecording(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                              const VectorXd& point, std::size_t k) {
  const auto p = static_cast<Index>(experiment.model.parameters.size());
  const auto own = static_cast<Index>(experiment.model.nuisance.size());
  SingleRecording single{recordings.select({k}), VectorXd(p + own)};
  single.point << point.head(p), point.segment(p + static_cast<Index>(k) * own, own);
  return single;
}

RecordingsProblem::RecordingsProblem(const ExperimentSpec& experiment, const RecordedFeatures& recordings)
    : simulators_(makeSimulators(experiment, recordings)),
      problem_(makeRecordedProblem(simulators_, experiment, recordings)) {}

std::vector<FeatureInfo> RecordingsProblem::listInfos() const {
  std::vector<FeatureInfo> infos;
  const int outputs = static_cast<int>(getSimulator().getSimulator().getLayout().getOutputCount());
  for (std::size_t k = 0; k < problem_.trials.size(); ++k) {
    const RefinementModel& model = *problem_.trials[k].model;
    for (const Index i : model.getWhole().features) {
      infos.push_back(model.getExtractor().getInfos()[static_cast<std::size_t>(i)]);
      if (infos.back().output >= 0) {
        infos.back().output += static_cast<int>(k) * outputs;
      }
    }
  }
  return infos;
}

LinearizedRecordings RecordingsProblem::linearize(const VectorXd& point) const {
  LinearizedRecordings all;
  const auto u = static_cast<Index>(getUnknown().size());
  for (const MeasuredTrial& trial : problem_.trials) {
    TrialMisfit own(trial);
    const VectorXd at = own.box.normalize(point(trial.unknown));
    const LocalMisfit local = own.misfit.linearize(at);
    if (!local.status.ok) {
      throw std::runtime_error("the best fit cannot be simulated with its derivatives: " +
                               local.status.reason);
    }
    const Index before = all.residual.size(), count = local.residual.size();
    all.residual.conservativeResize(before + count);
    all.residual.tail(count) = local.residual;
    all.jacobian.conservativeResize(before + count, u);
    all.jacobian.bottomRows(count).setZero();
    all.jacobian.bottomRows(count)(Eigen::all, trial.unknown) =
        local.jacobian * own.box.getHalfWidths().cwiseInverse().asDiagonal();
    addStarts(*trial.model, before, all.starts);
  }
  return all;
}

RecordingFit RecordingsProblem::fit(const MatrixXd& starts) const {
  const LogCoordinates coordinates(getUnknown());
  const Prior prior(getUnknown(), problem_.priors);
  std::vector<std::unique_ptr<TrialMisfit>> own;
  std::vector<MeasuredPart> parts;
  for (const MeasuredTrial& trial : problem_.trials) {
    own.push_back(std::make_unique<TrialMisfit>(trial));
    parts.push_back({&own.back()->misfit, trial.model, trial.unknown});
  }
  MisfitSurface surface(std::move(parts), coordinates, prior);
  MatrixXd from(starts.rows(), starts.cols());
  for (Index i = 0; i < starts.cols(); ++i) {
    from.col(i) = coordinates.fromParameters(starts.col(i));
  }
  SearchTeam team(surface, from);
  team.run(BasinSearchOptions{}.max_iterations);
  RecordingFit best;
  for (const LocalSurface& end : team.listEnds()) {
    if (best.point.size() == 0 || end.chi_square < best.chi_square) {
      best = {coordinates.toParameters(end.at), end.chi_square};
    }
  }
  return best;
}

VectorXd insertAdded(const VectorXd& point, Index p, const VectorXd& added) {
  VectorXd whole(point.size() + added.size());
  whole << point.head(p), added, point.tail(point.size() - p);
  return whole;
}

}  // namespace twinmap
