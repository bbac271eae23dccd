#include "framework/diagnosis/problem/recorded_problem.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>

#include "framework/data/features/experiment_features.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/data/measurement/measured_signals.hpp"
#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/estimation/posterior/basins/search_team.hpp"
#include "framework/estimation/posterior/problem_surface.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/inference/joint/join_trials.hpp"
#include "framework/inference/measurement/supposed_input.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

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

/// Which simulator each recording has: that of its trial, or one of its own setup.
std::vector<std::size_t> assignSimulators(const ExperimentSpec& experiment,
                                          const RecordedFeatures& recordings, Simulators& simulators) {
  std::vector<std::size_t> assigned;
  std::map<std::size_t, std::size_t> of_trials;
  for (std::size_t k = 0; k < recordings.features.size(); ++k) {
    const bool has_own = recordings.findOwn(k) != nullptr;
    const auto known = of_trials.find(recordings.getTrial(k));
    if (!has_own && known != of_trials.end()) {
      assigned.push_back(known->second);
      continue;
    }
    assigned.push_back(simulators.size());
    if (!has_own) {
      of_trials[recordings.getTrial(k)] = simulators.size();
    }
    simulators.push_back(std::make_unique<const SimulatorRefiner>(
        recordings.makeExperiment(experiment, k), recordings.getLayout(k), SimulatorRefiner::Model::kTrusted,
        has_own ? recordings.findOwn(k)->stated : StatedNoise()));
    simulators.back()->requireNoise();
  }
  return assigned;
}

/// What a recording's own unknown parameter is called among those of all.
std::string nameOwn(const std::string& name, const ExperimentSpec& experiment,
                    const RecordedFeatures& recordings, std::size_t k) {
  const std::string own =
      recordings.trials.empty() ? name : nameInTrial(experiment.trials[recordings.trials[k]].name, name);
  const bool is_one_of_several =
      recordings.trials.empty()
          ? recordings.features.size() > 1
          : std::count(recordings.trials.begin(), recordings.trials.end(), recordings.trials[k]) > 1;
  if (is_one_of_several && !recordings.labels.empty()) {
    return recordings.labels[k] + "." + name;
  }
  return is_one_of_several ? own + "[" + std::to_string(k + 1) + "]" : own;
}

PosteriorProblem makeRecordedProblem(const Simulators& simulators, const std::vector<std::size_t>& assigned,
                                     const ExperimentSpec& experiment, const RecordedFeatures& recordings) {
  std::vector<MeasuredTrial> trials;
  for (std::size_t k = 0; k < recordings.features.size(); ++k) {
    trials.push_back(simulators[assigned[k]]->makeTrial(recordings.features[k], recordings.getKnown(k)));
    if (const NoiseHypothesis faults = recordings.getNoise(k); !faults.isPlain()) {
      trials.back().noise = faults;
    }
  }
  return joinTrials(std::move(trials), experiment.model, [&](std::size_t k, const std::string& name) {
    return nameOwn(name, experiment, recordings, k);
  });
}

/// Of one recording after the other.
std::vector<std::size_t> countOutputs(const RecordedFeatures& recordings) {
  std::vector<std::size_t> counts;
  for (std::size_t k = 0; k < recordings.features.size(); ++k) {
    counts.push_back(recordings.getLayout(k).getOutputCount());
  }
  return counts;
}

std::vector<std::optional<double>> listWindows(const std::vector<double>& starts) {
  std::vector<std::optional<double>> windows(starts.begin(), starts.end());
  if (windows.empty()) {
    windows.emplace_back(std::nullopt);
  }
  return windows;
}

/// Setups of all trials, no recordings yet.
RecordedFeatures setUpTrials(const ExperimentSpec& combined, const std::vector<KnownValue>& known) {
  RecordedFeatures recordings;
  for (const TrialExperiment& trial : combined.trials) {
    recordings.setups.push_back(
        {makeLayout(trial.experiment), collectKnown(trial.experiment.model.inputs, known)});
  }
  return recordings;
}

std::size_t findTrial(const ExperimentSpec& combined, const std::string& name) {
  std::vector<std::string> names;
  for (const TrialExperiment& trial : combined.trials) {
    if (trial.name == name) {
      return names.size();
    }
    names.push_back(trial.name);
  }
  throwUnknownTrial(name, names);
}

/// The recording behind those that are there, of a trial.
void appendOfTrial(const RecordedFeatures& one, std::size_t trial, RecordedFeatures& recordings) {
  recordings.features.push_back(one.features.front());
  recordings.own.push_back(one.own.empty() ? nullptr : one.own.front());
  recordings.trials.push_back(trial);
}

}  // namespace

bool RecordedFeatures::hasFaults() const {
  return std::any_of(noise.begin(), noise.end(), [](const NoiseHypothesis& one) { return !one.isPlain(); });
}

const ResponseLayout& RecordedFeatures::getLayout(std::size_t recording) const {
  const OwnSetup* setup = findOwn(recording);
  return setup != nullptr ? setup->layout : trials.empty() ? layout : setups[trials[recording]].layout;
}

ExperimentSpec RecordedFeatures::makeExperiment(const ExperimentSpec& experiment,
                                                std::size_t recording) const {
  ExperimentSpec made = trials.empty() ? experiment : experiment.trials[trials[recording]].experiment;
  if (const OwnSetup* setup = findOwn(recording)) {
    copyMeasuredSignals(setup->excitation, made.model);
    made.features = setup->features;
  }
  return made;
}

RecordedFeatures RecordedFeatures::select(const std::vector<std::size_t>& recordings) const {
  RecordedFeatures selected{layout, {}, known, {}, {}, {}, setups};
  for (const std::size_t k : recordings) {
    if (!trials.empty()) {
      selected.trials.push_back(trials[k]);
    }
    selected.features.push_back(features[k]);
    if (!own.empty()) {
      selected.own.push_back(own[k]);
    }
    if (!noise.empty()) {
      selected.noise.push_back(noise[k]);
    }
    if (!labels.empty()) {
      selected.labels.push_back(labels[k]);
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

std::vector<std::string> RecordedFeatures::listOutputs(const ExperimentSpec& experiment) const {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < features.size(); ++k) {
    for (const std::string& name : getLayout(k).output_names) {
      names.push_back(trials.empty() ? name : nameInTrial(experiment.trials[trials[k]].name, name));
    }
  }
  return names;
}

void append(const RecordedFeatures& more, RecordedFeatures& recordings) {
  recordings.own.resize(recordings.features.size());
  recordings.features.insert(recordings.features.end(), more.features.begin(), more.features.end());
  recordings.own.insert(recordings.own.end(), more.own.begin(), more.own.end());
  recordings.own.resize(recordings.features.size());
}

RecordedFeatures readRecording(const MeasurementReader& reader, const Table& table,
                               std::optional<double> start, const VectorXd& known) {
  RecordedFeatures recording{reader.getLayout(), {}, known};
  const double beside = kDelayMargin * reader.getExperiment().model.simulation.duration;
  std::optional<ExperimentSpec> followed = reader.follow(table, start, beside);
  std::optional<MeasurementReader> own;
  if (followed) {
    own.emplace(std::move(*followed));
  }
  const MeasurementReader& used = own ? *own : reader;
  AvailableFeatures found = used.readAvailableFeatures(table, start);
  const std::optional<ExperimentSpec> supposed =
      supposeInput(used, found, known, makePosteriorOptions(used.getExperiment(), kMinPosteriorDraws));
  if (own || supposed || found.stated.isGiven()) {
    const ExperimentSpec& experiment = supposed ? *supposed : used.getExperiment();
    recording.own.push_back(std::make_shared<const OwnSetup>(
        OwnSetup{experiment.model.excitation, experiment.features, used.getLayout(), found.stated}));
  }
  for (const ClippedSample& sample : found.clipped) {
    found.features[sample.row] = std::numeric_limits<double>::quiet_NaN();
  }
  recording.features.push_back(std::move(found.features));
  return recording;
}

RecordedFeatures readRecordings(const MeasurementReader& reader, const std::vector<std::string>& files,
                                const std::vector<double>& starts, const std::vector<KnownValue>& known) {
  RecordedFeatures recordings{
      reader.getLayout(), {}, collectKnown(reader.getExperiment().model.inputs, known)};
  const std::vector<std::optional<double>> windows = listWindows(starts);
  for (const std::string& file : files) {
    const Table table = readTable(file, reader.listColumns(), MissingCells::kKeep);
    for (const std::optional<double>& start : windows) {
      append(readRecording(reader, table, start, recordings.known), recordings);
    }
  }
  return recordings;
}

RecordedFeatures readRecordings(const ExperimentSpec& combined, const std::vector<Recording>& recordings,
                                const std::vector<KnownValue>& known) {
  if (combined.trials.empty()) {
    const MeasurementReader reader(combined);
    RecordedFeatures all{reader.getLayout(), {}, collectKnown(combined.model.inputs, known)};
    for (const Recording& one : recordings) {
      append(readRecording(reader, *one.table, one.start, all.known), all);
      all.labels.push_back(one.label);
    }
    return all;
  }
  RecordedFeatures all = setUpTrials(combined, known);
  for (const Recording& one : recordings) {
    const std::size_t trial = findTrial(combined, one.trial);
    const MeasurementReader reader(combined.trials[trial].experiment);
    appendOfTrial(readRecording(reader, *one.table, one.start, all.setups[trial].known), trial, all);
    all.labels.push_back(one.label);
  }
  return all;
}

RecordedFeatures makeEmptyRecordings(const ExperimentSpec& experiment, const std::vector<KnownValue>& known) {
  const auto makeEmpty = [](const ExperimentSpec& one, const ResponseLayout& layout) -> VectorXd {
    return VectorXd::Zero(makeExtractor(one, layout).getFeatureCount());
  };
  if (experiment.trials.empty()) {
    const ResponseLayout layout = makeLayout(experiment);
    return {layout, {makeEmpty(experiment, layout)}, collectKnown(experiment.model.inputs, known)};
  }
  RecordedFeatures recordings = setUpTrials(experiment, known);
  for (std::size_t t = 0; t < experiment.trials.size(); ++t) {
    recordings.features.push_back(makeEmpty(experiment.trials[t].experiment, recordings.setups[t].layout));
    recordings.trials.push_back(t);
  }
  return recordings;
}

SingleRecording takeRecording(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                              const VectorXd& point, std::size_t k) {
  const auto p = static_cast<Index>(experiment.model.parameters.size());
  Index before = p;
  for (std::size_t i = 0; i < k; ++i) {
    before += static_cast<Index>(recordings.makeExperiment(experiment, i).model.nuisance.size());
  }
  SingleRecording single{recordings.makeExperiment(experiment, k), recordings.select({k}), {}};
  single.recording.layout = recordings.getLayout(k);
  single.recording.known = recordings.getKnown(k);
  single.recording.setups.clear();
  single.recording.trials.clear();
  const auto own = static_cast<Index>(single.experiment.model.nuisance.size());
  single.point.resize(p + own);
  single.point << point.head(p), point.segment(before, own);
  return single;
}

RecordingsProblem::RecordingsProblem(const ExperimentSpec& experiment, const RecordedFeatures& recordings)
    : outputs_(countOutputs(recordings)) {
  const std::vector<std::size_t> assigned = assignSimulators(experiment, recordings, simulators_);
  problem_ = makeRecordedProblem(simulators_, assigned, experiment, recordings);
  for (std::size_t k = 0; k < problem_.trials.size(); ++k) {
    faults_.push_back(recordings.getNoise(k));
  }
}

std::vector<FeatureInfo> RecordingsProblem::listInfos() const {
  std::vector<FeatureInfo> infos;
  int before = 0;
  for (std::size_t k = 0; k < problem_.trials.size(); ++k) {
    const RefinementModel& model = *problem_.trials[k].model;
    for (const Index i : model.getWhole().features) {
      infos.push_back(model.getExtractor().getInfos()[static_cast<std::size_t>(i)]);
      if (infos.back().output >= 0) {
        infos.back().output += before;
      }
    }
    before += static_cast<int>(outputs_[k]);
  }
  return infos;
}

LinearizedRecordings RecordingsProblem::linearize(const VectorXd& point) const {
  LinearizedRecordings all;
  const auto u = static_cast<Index>(getUnknown().size());
  for (std::size_t k = 0; k < problem_.trials.size(); ++k) {
    const MeasuredTrial& trial = problem_.trials[k];
    TrialMisfit own(trial);
    LocalMisfit local = own.linearize(point(trial.unknown));
    if (!local.status.ok) {
      throw std::runtime_error("the best fit cannot be simulated with its derivatives: " +
                               local.status.reason);
    }
    if (!faults_[k].isPlain()) {
      ResidualLoss::Standardized standardized =
          ResidualLoss(faults_[k], *trial.model, trial.model->getWhole())
              .standardize(local.residual, local.jacobian, static_cast<double>(local.residual.size()));
      local.residual = std::move(standardized.residual);
      local.jacobian = std::move(standardized.jacobian);
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

RecordingFit RecordingsProblem::fit(const MatrixXd& starts, Index held) const {
  PosteriorProblem problem = problem_;
  for (std::size_t k = 0; k < problem.trials.size(); ++k) {
    problem.trials[k].noise = faults_[k];
  }
  ProblemSurface whole(problem);
  MatrixXd directions(starts.rows(), held < 0 ? 0 : starts.cols());
  if (held >= 0) {
    directions.setZero();
    directions.row(held).setOnes();
  }
  SearchTeam team(whole.upd(), toCoordinates(whole.getCoordinates(), starts), directions);
  team.run(BasinSearchOptions{}.max_iterations);
  RecordingFit best;
  for (const LocalSurface& end : team.listEnds()) {
    if (best.point.size() == 0 || end.chi_square < best.chi_square) {
      best = {whole.getCoordinates().toParameters(end.at), end.chi_square};
    }
  }
  return best;
}

std::vector<Index> listOthers(Index all, Index first, Index count) {
  std::vector<Index> others = listIndices(all);
  others.erase(others.begin() + first, others.begin() + first + count);
  return others;
}

VectorXd insertAdded(const VectorXd& point, Index p, const VectorXd& added) {
  VectorXd whole(point.size() + added.size());
  whole << point.head(p), added, point.tail(point.size() - p);
  return whole;
}

}  // namespace twinmap
