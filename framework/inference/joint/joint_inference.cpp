#include "framework/inference/joint/joint_inference.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "framework/base/log/notice.hpp"
#include "framework/base/log/search_stage.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/estimation/posterior/draws/linear_posterior.hpp"
#include "framework/estimation/run_tasks.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/experiment/trials/trial_trees.hpp"
#include "framework/inference/joint/join_trials.hpp"
#include "framework/inference/joint/joint_estimate.hpp"
#include "framework/inference/joint/joint_starts.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/tolerances/tolerances.hpp"
#include "framework/simulation/simulator_team.hpp"
#include "framework/simulation/team_simulator.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Of a recording alone, where there are many parameters and each simulation is dear. Their means and
/// standard deviations are then known to a tenth of one. That is enough to show what each recording adds. So
/// is a linear response about its best fit where that does (sampleLinearModel), unless a number of draws is
/// asked for. Draws that the simulator weighs would take as long as the rest.
constexpr int kDrawsAlone = 128;
/// Of all recordings of such a machine, unless given: half of what others take. With an effective sample size
/// of half of these, means are known to a tenth of a standard deviation.
constexpr int kDrawsOfMany = 256;

/// Without the sizes of the recordings' nuisance, whose bounds are those of a search.
void leaveNuisanceBounds(const PosteriorProblem& problem, const std::vector<ExplainedRecording>& alone,
                         std::vector<std::string>& beyond) {
  for (std::size_t k = 0; k < alone.size(); ++k) {
    const std::vector<Index>& unknown = problem.trials[k].unknown;
    for (std::size_t j = unknown.size() - alone[k].inferred.countSizes(); j < unknown.size(); ++j) {
      const std::string& size = problem.unknown[static_cast<std::size_t>(unknown[j])].name.text;
      beyond.erase(std::remove(beyond.begin(), beyond.end(), size), beyond.end());
    }
  }
}

/// The machine's parameters at the best fit that noise does not explain; else empty.
VectorXd findLead(const ExplainedRecording& first, Index shared) {
  const SimulatorFit* fit = findFit(first.inferred);
  const bool leads = fit != nullptr && fit->isSimulated() && !fit->isPlausible();
  return leads ? VectorXd(first.posterior.best.head(shared)) : VectorXd();
}

std::vector<std::size_t> listReliable(const std::vector<RecordingInference>& alone) {
  std::vector<std::size_t> reliable;
  for (std::size_t k = 0; k < alone.size(); ++k) {
    if (alone[k].posterior.isReliable()) {
      reliable.push_back(k);
    }
  }
  return reliable;
}

std::vector<Contradiction> findContradictions(const std::vector<RecordingInference>& alone, Index shared) {
  const std::vector<std::size_t> reliable = listReliable(alone);
  std::vector<Contradiction> largest;
  for (Index j = 0; j < shared && reliable.size() > 1; ++j) {
    Contradiction of_parameter{static_cast<std::size_t>(j), reliable[0], reliable[1], 0.0};
    for (const std::size_t a : reliable) {
      for (const std::size_t b : reliable) {
        const SimulatorPosterior &first = alone[a].posterior, &second = alone[b].posterior;
        const double distance =
            std::abs(first.mean[j] - second.mean[j]) / std::hypot(first.stddev[j], second.stddev[j]);
        if (a < b && distance > of_parameter.distance) {
          of_parameter = {static_cast<std::size_t>(j), a, b, distance};
        }
      }
    }
    largest.push_back(of_parameter);
  }
  std::stable_sort(largest.begin(), largest.end(),
                   [](const Contradiction& a, const Contradiction& b) { return a.distance > b.distance; });
  return largest;
}

std::vector<ScatterEstimate> combineRecordings(const std::vector<RecordingInference>& alone,
                                               const std::vector<ParameterSpec>& parameters) {
  const std::vector<std::size_t> reliable = listReliable(alone);
  std::vector<ScatterEstimate> combined;
  if (reliable.size() < 2) {
    return combined;
  }
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const auto p = static_cast<Index>(j);
    VectorXd values(static_cast<Index>(reliable.size())), stddevs(values.size());
    for (Index i = 0; i < values.size(); ++i) {
      const SimulatorPosterior& posterior = alone[reliable[static_cast<std::size_t>(i)]].posterior;
      values[i] = posterior.mean[p];
      stddevs[i] = posterior.stddev[p];
    }
    combined.push_back(combineScattered(values, stddevs));
    combined.back().bounds = parameters[j].bounds;
  }
  return combined;
}

std::vector<TrialExperiment> readTrials(const YamlNode& root) {
  std::vector<TrialExperiment> trials;
  for (const Trial& trial : expandTrials(root)) {
    trials.push_back({trial.name, followNoise(readExperimentWithSignals(trial.tree))});
  }
  return trials;
}

void requireSameParameters(const std::vector<ParameterSpec>& parameters,
                           const std::vector<ParameterSpec>& others) {
  const bool same =
      std::equal(parameters.begin(), parameters.end(), others.begin(), others.end(),
                 [](const ParameterSpec& a, const ParameterSpec& b) { return a.name.text == b.name.text; });
  if (!same) {
    throw std::logic_error("trials of one machine have other parameters");
  }
}

}  // namespace

std::vector<std::string> listRecordingFaults(const std::vector<RecordingInference>& alone) {
  std::vector<std::string> listed;
  for (const NoticeText& notice : listNotices()) {
    if (notice.concern != Concern::kOther &&
        std::any_of(alone.begin(), alone.end(), [&](const RecordingInference& one) {
          return hasStatus(listStatuses(one.inferred), notice.notice);
        })) {
      listed.emplace_back(notice.name);
    }
  }
  return listed;
}

std::vector<std::string> listStatuses(const JointInference& inferred, Index parameters) {
  if (!inferred.agreement) {
    return {"not_simulated"};
  }
  std::vector<std::string> statuses;
  // each recording is one of many chances of a false alarm
  const double level = kMismatchLevel / static_cast<double>(inferred.alone.size());
  if (std::any_of(inferred.alone.begin(), inferred.alone.end(), [&](const RecordingInference& one) {
        return one.inferred.posterior->fit->test.calcPValue() < level;
      })) {
    statuses.emplace_back("model_mismatch");
  } else if (inferred.findMissing() != nullptr && !inferred.disagrees()) {
    statuses.emplace_back("missing_term");
  }
  if (!inferred.joint.beyond.empty()) {
    statuses.emplace_back("at_bounds");
  }
  if (inferred.disagrees()) {
    statuses.emplace_back("trials_disagree");
  }
  std::vector<std::string> faults = listRecordingFaults(inferred.alone);
  const MissingTerm* missing = inferred.findMissing();
  if (missing != nullptr && missing->explains) {
    dropExcuses(faults);
  }
  statuses.insert(statuses.end(), faults.begin(), faults.end());
  if (!inferred.joint.isReliable()) {
    statuses.emplace_back("unreliable");
  } else {
    addStatus(inferred.joint.findShape(parameters), statuses);
  }
  return statuses.empty() ? std::vector<std::string>{"ok"} : statuses;
}

JointInferrer::JointInferrer(const YamlNode& root, const std::vector<std::string>& known,
                             std::optional<int> draws)
    : JointInferrer(readTrials(root), parseKnownValues(known), draws) {}

JointInferrer::JointInferrer(const ExperimentSpec& experiment, const std::vector<KnownValue>& known,
                             std::optional<int> draws)
    : JointInferrer(
          experiment.trials.empty() ? std::vector<TrialExperiment>{{"", experiment}} : experiment.trials,
          known, draws) {}

JointInferrer::JointInferrer(std::vector<TrialExperiment> trials, const std::vector<KnownValue>& known,
                             std::optional<int> draws) {
  for (TrialExperiment& trial : trials) {
    auto reader = std::make_shared<const MeasurementReader>(std::move(trial.experiment));
    const ExperimentSpec& experiment = reader->getExperiment();
    const ResponseLayout& layout = reader->getLayout();
    auto simulator = std::make_unique<const SimulatorRefiner>(
        experiment, layout, shareAmongThreads(makeSimulator(experiment.model, layout.times, layout.modes)));
    simulator->requireNoise();
    const VectorXd inputs = collectKnown(experiment.model.inputs, known);
    members_.push_back({trial.name, std::move(reader), std::move(simulator), inputs});
    requireSameParameters(getParameters(), members_.back().reader->getExperiment().model.parameters);
  }
  const bool has_many = static_cast<Index>(getParameters().size()) > kManyUnknown;
  options_ = joint_options_ =
      makePosteriorOptions(members_.front().reader->getExperiment(),
                           draws.value_or(has_many ? kDrawsOfMany : SimulatorPosteriorOptions{}.draws));
  options_.draws = has_many ? std::min(joint_options_.draws, kDrawsAlone) : joint_options_.draws;
  options_.is_linear = has_many && !draws;
  joint_options_ = searchNearby(joint_options_);
  joint_options_.search.scouts = has_many ? 0 : joint_options_.search.scouts;
}

const std::vector<ParameterSpec>& JointInferrer::getParameters() const {
  return members_.front().reader->getExperiment().model.parameters;
}

std::vector<std::string> JointInferrer::listTrials() const {
  std::vector<std::string> names;
  for (const Member& member : members_) {
    names.push_back(member.name);
  }
  return names;
}

const JointInferrer::Member& JointInferrer::find(const std::string& trial) const {
  const auto found = std::find_if(members_.begin(), members_.end(),
                                  [&](const Member& member) { return member.name == trial; });
  if (found == members_.end()) {
    const bool has_trials = members_.size() > 1 || !members_.front().name.empty();
    throwUnknownTrial(trial, has_trials ? listTrials() : std::vector<std::string>{});
  }
  return *found;
}

ExplainedRecording JointInferrer::explain(const Recording& recording, UnexplainedRecording read,
                                          const SimulatorPosteriorOptions& options,
                                          const VectorXd& lead) const {
  const Member& member = find(recording.trial);
  const bool is_own = read.reader != member.reader;
  const RecordingSetup setup =
      is_own ? makeSetup(std::move(read.reader))
             : RecordingSetup{member.reader, std::make_shared<const SimulatorRefiner>(
                                                 member.reader->getExperiment(), member.reader->getLayout(),
                                                 member.simulator->getSimulator().clone())};
  return explainRecording(setup, std::move(read.found), *recording.table, recording.start, member.known,
                          options, lead);
}

std::vector<ExplainedRecording> JointInferrer::explainAlone(const std::vector<Recording>& recordings,
                                                            Misfits misfits) const {
  SimulatorPosteriorOptions options = options_;
  options.search.settles = misfits == Misfits::kStarts;
  std::vector<UnexplainedRecording> read;  // all, before any of them takes its time
  for (const Recording& one : recordings) {
    read.push_back(readUnexplained(find(one.trial).reader, *one.table, one.start));
  }
  const int threads = countThreads(), count = static_cast<int>(recordings.size());
  const bool side_by_side =
      count >= threads || static_cast<Index>(members_.front().simulator->getUnknown().size()) > kManyUnknown;
  SearchStage stage("each recording alone", count);
  std::atomic<int> done{0};
  std::vector<ExplainedRecording> alone(recordings.size());
  VectorXd lead;
  const auto explainOne = [&](std::size_t k) {
    alone[k] = explain(recordings[k], std::move(read[k]), options, lead);
    stage.show(++done, count);
  };
  const std::size_t first = misfits == Misfits::kStarts && count > 1 ? 1 : 0;
  if (first > 0) {
    explainOne(0);
    lead = findLead(alone.front(), static_cast<Index>(getParameters().size()));
    options = lead.size() > 0 ? searchNearby(options) : options;
  }
  runTasks(side_by_side ? threads : 1, recordings.size() - first,
           [&](std::size_t k) { explainOne(k + first); });
  return alone;
}

PosteriorProblem JointInferrer::makeProblem(const std::vector<Recording>& recordings,
                                            const std::vector<ExplainedRecording>& alone) const {
  std::vector<MeasuredTrial> trials;
  for (const ExplainedRecording& one : alone) {
    trials.push_back(one.makeTrial());
  }
  return joinTrials(std::move(trials), members_.front().reader->getExperiment().model,
                    [&](std::size_t k, const std::string& name) { return recordings[k].label + "." + name; });
}

void JointInferrer::nameNoise(std::vector<ExplainedRecording>& alone, JointInference& inferred) {
  for (std::size_t k = 0; k < alone.size(); ++k) {
    InferredMeasurement& one = inferred.alone[k].inferred;
    if (!one.posterior->fit->isPlausible() || inferred.disagrees()) {
      nameUnstatedNoise(alone[k]);
      one.remarks = alone[k].inferred.remarks;
    }
  }
}

JointInference JointInferrer::infer(const std::vector<Recording>& recordings) const {
  JointInference inferred;
  std::vector<ExplainedRecording> alone = explainAlone(recordings);
  for (std::size_t k = 0; k < alone.size(); ++k) {
    inferred.alone.push_back({recordings[k].label, alone[k].inferred, alone[k].posterior});
    inferred.simulations += alone[k].posterior.simulations;
  }
  for (const RecordingInference& one : inferred.alone) {
    if (!(one.posterior.degrees > 0.0)) {
      inferred.joint.message = one.label + " cannot be simulated anywhere within the bounds";
      return inferred;
    }
  }
  const auto shared = static_cast<Index>(getParameters().size());
  const PosteriorProblem problem = makeProblem(recordings, alone);
  const SearchStage together("all recordings together");
  inferred.joint = samplePosterior(problem, listJointStarts(problem, inferred.alone, shared), joint_options_);
  inferred.simulations += inferred.joint.simulations;
  if (!(inferred.joint.degrees > 0.0)) {
    return inferred;
  }
  std::vector<double> separate;
  for (const RecordingInference& one : inferred.alone) {
    separate.push_back(one.posterior.misfit);
  }
  inferred.agreement =
      testAgreement(inferred.joint.misfit, separate, linearizeParts(problem, inferred.joint.best), problem,
                    inferred.joint.best, options_.seed);
  inferred.together = describeTogether(members_.front().reader->getExperiment(), problem, inferred.joint);
  leaveNuisanceBounds(problem, alone, inferred.together.posterior->fit->beyond);
  inferred.contradictions = findContradictions(inferred.alone, shared);
  nameNoise(alone, inferred);
  inferred.scatter = combineRecordings(inferred.alone, getParameters());
  if (inferred.disagrees()) {
    for (RecordingInference& one : inferred.alone) {
      one.inferred.scatter = inferred.scatter;
    }
  }
  return inferred;
}

}  // namespace twinmap
