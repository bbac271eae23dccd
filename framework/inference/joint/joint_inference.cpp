#include "framework/inference/joint/joint_inference.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

#include "framework/base/log/search_stage.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/estimation/posterior/draws/linear_posterior.hpp"
#include "framework/estimation/run_tasks.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/experiment/trials/trial_trees.hpp"
#include "framework/inference/joint/joint_estimate.hpp"
#include "framework/inference/measurement/supposed_input.hpp"
#include "framework/inference/measurement/unknown_excitation.hpp"
#include "framework/inference/measurement/unstated_noise.hpp"
#include "framework/inference/tolerances/tolerances.hpp"
#include "framework/simulation/simulator_team.hpp"
#include "framework/simulation/team_simulator.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The joint search begins where the recordings alone ended; so few starts of its own suffice.
constexpr int kOwnStarts = 8;
/// Of a recording alone, where there are many parameters and each simulation is dear: their means and
/// standard deviations are then known to a tenth of one, which is enough to show what each recording adds. So
/// is a linear response about its best fit where that does (sampleLinearModel), unless a number of draws is
/// asked for: draws that the simulator weighs would take as long as the rest.
constexpr int kDrawsAlone = 128;
/// Of all recordings of such a machine, unless given: half of what others take. With an effective sample size
/// of half of these, means are known to a tenth of a standard deviation.
constexpr int kDrawsOfMany = 256;
/// With more unknown parameters than these, those of single recordings are integrated out: importance
/// sampling is good for some ten dimensions.
constexpr Index kMaxDrawn = 8;

/// The minimum of the sum of the recordings' quadratic misfits about their own minima, each over what it
/// alone leaves unknown: nearly that of all together. The prior counts in each, which moves it by little.
VectorXd combineMinima(const PosteriorProblem& problem, const std::vector<RecordingInference>& alone,
                       const VectorXd& base) {
  const LogCoordinates coordinates(problem.unknown);
  const Index all = base.size();
  MatrixXd information = kHalfWidthInformation * MatrixXd::Identity(all, all);
  VectorXd descent = VectorXd::Zero(all);
  for (std::size_t k = 0; k < alone.size(); ++k) {
    const std::vector<Index>& own = problem.trials[k].unknown;
    VectorXd point = base;
    point(own) = alone[k].posterior.best;
    const VectorXd at = coordinates.fromParameters(point);
    information(own, own) += alone[k].posterior.information;
    descent(own) += alone[k].posterior.information * at(own);
  }
  const VectorXd minimum = linalg::solvePositiveDefinite(information, descent);
  return coordinates.toParameters(minimum.cwiseMax(-1.0).cwiseMin(1.0));
}

/// Starts of the joint search: what each recording alone found for the machine, beside what the others alone
/// found for themselves; and the mean of all, weighted by their information.
MatrixXd makeStarts(const PosteriorProblem& problem, const std::vector<RecordingInference>& alone,
                    Index shared) {
  VectorXd base = VectorXd::Zero(static_cast<Index>(problem.unknown.size()));
  for (std::size_t k = 0; k < alone.size(); ++k) {
    base(problem.trials[k].unknown) = alone[k].posterior.best;
  }
  std::vector<VectorXd> starts;
  VectorXd sum = VectorXd::Zero(shared), weight = VectorXd::Zero(shared);
  for (const RecordingInference& one : alone) {
    const SimulatorPosterior& posterior = one.posterior;
    starts.push_back(base);
    starts.back().head(shared) = posterior.best.head(shared);
    for (std::size_t m = 1; m < posterior.modes.size(); ++m) {
      starts.push_back(base);
      starts.back().head(shared) = posterior.modes[m].mean.head(shared);
    }
    if (posterior.isReliable()) {
      const VectorXd own = posterior.stddev.head(shared).cwiseAbs2().cwiseInverse();
      sum += own.cwiseProduct(posterior.mean.head(shared));
      weight += own;
    }
  }
  if (problem.drawn > kManyUnknown) {
    starts.insert(starts.begin(), combineMinima(problem, alone, base));
  } else if (weight.minCoeff() > 0.0) {
    starts.push_back(base);
    starts.back().head(shared) = sum.cwiseQuotient(weight);
  }
  MatrixXd given(base.size(), static_cast<Index>(starts.size()));
  for (std::size_t i = 0; i < starts.size(); ++i) {
    given.col(static_cast<Index>(i)) = starts[i];
  }
  return given;
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

std::vector<ScatterEstimate> combineRecordings(const std::vector<RecordingInference>& alone, Index shared) {
  const std::vector<std::size_t> reliable = listReliable(alone);
  std::vector<ScatterEstimate> combined;
  if (reliable.size() < 2) {
    return combined;
  }
  for (Index p = 0; p < shared; ++p) {
    VectorXd values(static_cast<Index>(reliable.size())), stddevs(values.size());
    for (Index i = 0; i < values.size(); ++i) {
      const SimulatorPosterior& posterior = alone[reliable[static_cast<std::size_t>(i)]].posterior;
      values[i] = posterior.mean[p];
      stddevs[i] = posterior.stddev[p];
    }
    combined.push_back(combineScattered(values, stddevs));
  }
  return combined;
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

ScatterEstimate combineScattered(const VectorXd& values, const VectorXd& stddevs) {
  const auto degrees = static_cast<double>(values.size() - 1);
  const VectorXd precise = stddevs.cwiseAbs2().cwiseInverse();
  const double precise_mean = precise.dot(values) / precise.sum();
  const double excess =
      precise.dot((values.array() - precise_mean).square().matrix()) - degrees;  // of Cochran's Q
  const double variance = std::max(0.0, excess / (precise.sum() - precise.squaredNorm() / precise.sum()));
  const VectorXd weights = (stddevs.array().square() + variance).inverse();
  ScatterEstimate estimate;
  estimate.scatter = std::sqrt(variance);
  estimate.mean = weights.dot(values) / weights.sum();
  const double spread = weights.dot((values.array() - estimate.mean).square().matrix()) / degrees;
  // never narrower than the stated standard deviations allow (Röver, Knapp and Friede 2015)
  estimate.stddev = std::sqrt(std::max(1.0, spread) / weights.sum());
  const boost::math::students_t_distribution<> few(degrees);
  estimate.factor = {boost::math::quantile(few, 0.75), boost::math::quantile(few, 0.975)};
  return estimate;
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
  if (!inferred.joint.isReliable()) {
    statuses.emplace_back("unreliable");
  } else {
    addStatus(inferred.joint.findShape(parameters), statuses);
  }
  return statuses.empty() ? std::vector<std::string>{"ok"} : statuses;
}

JointInferrer::JointInferrer(const YamlNode& root, const std::vector<std::string>& known,
                             std::optional<int> draws) {
  for (const Trial& trial : expandTrials(root)) {
    auto reader =
        std::make_unique<const MeasurementReader>(followNoise(readExperimentWithSignals(trial.tree)));
    const ExperimentSpec& experiment = reader->getExperiment();
    const ResponseLayout& layout = reader->getLayout();
    auto simulator = std::make_unique<const SimulatorRefiner>(
        experiment, layout, shareAmongThreads(makeSimulator(experiment.model, layout.times, layout.modes)));
    simulator->requireNoise();
    const VectorXd inputs = collectKnown(experiment.model.inputs, parseKnownValues(known));
    members_.push_back({trial.name, std::move(reader), std::move(simulator), inputs});
    requireSameParameters(getParameters(), members_.back().reader->getExperiment().model.parameters);
  }
  const bool has_many = static_cast<Index>(getParameters().size()) > kManyUnknown;
  options_ = joint_options_ =
      makePosteriorOptions(members_.front().reader->getExperiment(),
                           draws.value_or(has_many ? kDrawsOfMany : SimulatorPosteriorOptions{}.draws));
  options_.draws = has_many ? std::min(joint_options_.draws, kDrawsAlone) : joint_options_.draws;
  options_.is_linear = has_many && !draws;
  joint_options_.search.scouts = has_many ? 0 : kOwnStarts;
  joint_options_.search.starts = 2 * kOwnStarts;
  joint_options_.search.max_batches = 1;
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

JointInferrer::Measured JointInferrer::read(const Recording& recording) const {
  Measured measured{&find(recording.trial)};
  if (std::optional<ExperimentSpec> followed =
          measured.getReader().follow(*recording.table, recording.start)) {
    measured.own_reader = std::make_unique<const MeasurementReader>(std::move(*followed));
    const ExperimentSpec& experiment = measured.own_reader->getExperiment();
    const ResponseLayout& layout = measured.own_reader->getLayout();
    measured.own_simulator = std::make_unique<const SimulatorRefiner>(
        experiment, layout,
        shareAmongThreads(makeTrustedSimulator(experiment.model, layout.times, layout.modes)));
  }
  const MeasurementReader& reader = measured.getReader();
  measured.found = reader.readAvailableFeatures(*recording.table, recording.start);
  if (auto supposed = makeOwnSimulator(reader, measured.getSimulator(), measured.found,
                                       measured.member->known, options_)) {
    measured.own_simulator = std::move(supposed);
  }
  return measured;
}

std::vector<RecordingInference> JointInferrer::inferAlone(const std::vector<Recording>& recordings,
                                                          const std::vector<Measured>& measured,
                                                          const std::vector<MeasuredTrial>& trials) const {
  std::vector<RecordingInference> alone(recordings.size());
  std::vector<PosteriorProblem> problems;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    const ModelSpec& model = measured[k].getReader().getExperiment().model;
    const std::vector<ParameterSpec>& unknown = measured[k].getSimulator().getUnknown();
    problems.push_back({unknown, model.priors, {trials[k]}, static_cast<Index>(unknown.size())});
    alone[k].label = recordings[k].label;
    InferredMeasurement& inferred = alone[k].inferred;
    inferred.source = recordings[k].table->source;
    inferred.start = measured[k].getReader().getStart(*recordings[k].table, recordings[k].start);
    inferred.left_out = measured[k].found.remarks;
    inferred.remarks = describeBridged(model);
  }
  const int threads = countThreads();
  const bool side_by_side =
      recordings.size() >= static_cast<std::size_t>(threads) || mayRunSideBySide(problems.front());
  SearchStage stage("each recording alone", static_cast<int>(recordings.size()));
  std::atomic<int> done{0};
  runTasks(side_by_side ? threads : 1, recordings.size(), [&](std::size_t k) {
    alone[k].posterior = samplePosterior(problems[k], MatrixXd(problems[k].drawn, 0), options_);
    stage.show(++done, static_cast<int>(recordings.size()));
  });
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    alone[k].inferred.posterior = measured[k].getSimulator().makeEstimate(trials[k], alone[k].posterior);
  }
  return alone;
}

PosteriorProblem JointInferrer::makeProblem(const std::vector<Recording>& recordings,
                                            std::vector<MeasuredTrial> trials) const {
  PosteriorProblem problem;
  problem.unknown = getParameters();
  problem.priors = members_.front().reader->getExperiment().model.priors;
  const auto shared = static_cast<Index>(problem.unknown.size());
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    const Recording& recording = recordings[k];
    MeasuredTrial& trial = trials[k];
    const std::vector<ParameterSpec>& own = find(recording.trial).simulator->getUnknown();
    for (Index j = shared; j < static_cast<Index>(own.size()); ++j) {
      trial.unknown[static_cast<std::size_t>(j)] = static_cast<Index>(problem.unknown.size());
      problem.unknown.push_back(own[static_cast<std::size_t>(j)]);
      problem.unknown.back().name.text = recording.label + "." + problem.unknown.back().name.text;
    }
  }
  problem.trials = std::move(trials);
  const auto all = static_cast<Index>(problem.unknown.size());
  problem.drawn = all <= kMaxDrawn ? all : shared;
  return problem;
}

void JointInferrer::nameUnstatedNoise(const std::vector<Measured>& measured, JointInference& inferred) {
  for (std::size_t k = 0; k < measured.size(); ++k) {
    InferredMeasurement& alone = inferred.alone[k].inferred;
    const bool misfits = !alone.posterior->fit->isPlausible();
    if (misfits || inferred.disagrees()) {
      const std::vector<std::string> noisy =
          describeUnstatedNoise(measured[k].getReader(), measured[k].getSimulator(), measured[k].found,
                                measured[k].member->known, *alone.posterior);
      alone.remarks.insert(alone.remarks.end(), noisy.begin(), noisy.end());
    }
  }
}

JointInference JointInferrer::infer(const std::vector<Recording>& recordings) const {
  JointInference inferred;
  std::vector<std::unique_ptr<Simulator>> simulators;
  std::vector<Measured> measured;
  std::vector<MeasuredTrial> trials;
  for (const Recording& recording : recordings) {
    measured.push_back(read(recording));
    const Measured& one = measured.back();
    trials.push_back(one.getSimulator().makeTrial(one.found.features, one.member->known));
    trials.back().noise = one.getSimulator().describeNoise(one.found.clipped);
    simulators.push_back(trials.back().simulator->clone());  // for a thread of its own
    trials.back().simulator = simulators.back().get();
  }
  inferred.alone = inferAlone(recordings, measured, trials);
  for (const RecordingInference& one : inferred.alone) {
    inferred.simulations += one.posterior.simulations;
    if (!(one.posterior.degrees > 0.0)) {
      inferred.joint.message = one.label + " cannot be simulated anywhere within the bounds";
      return inferred;
    }
  }
  const auto shared = static_cast<Index>(getParameters().size());
  const PosteriorProblem problem = makeProblem(recordings, std::move(trials));
  const SearchStage together("all recordings together");
  inferred.joint = samplePosterior(problem, makeStarts(problem, inferred.alone, shared), joint_options_);
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
  inferred.contradictions = findContradictions(inferred.alone, shared);
  nameUnstatedNoise(measured, inferred);
  if (inferred.disagrees()) {
    inferred.scatter = combineRecordings(inferred.alone, shared);
  }
  return inferred;
}

}  // namespace twinmap
