#include "framework/study/pipeline/training/choose_samples.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "framework/base/log/log.hpp"
#include "framework/estimation/surrogate/forward_samples.hpp"
#include "framework/estimation/surrogate/train_surrogate.hpp"
#include "framework/experiment/files/resolve_defaults.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/experiment_points.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

constexpr int kFirst = 100;
constexpr int kOfProcesses = 250;

double getSeconds(const ExperimentSpec& experiment) {
  constexpr double kDefault = 10.0;
  return experiment.design.train.time.value_or(kDefault);
}

/// What training on n simulations takes, from the windows of a surrogate of fewer. Times follow the square of
/// what each window learns from, within a third. They were measured on one core, with 100 to 800 simulations
/// of mechanisms of 13 to 15 windows. Searches on 300 points, and inferences in cross-validation, outweigh
/// the cubes.
double predictTrainingSeconds(const Surrogate& surrogate, Index samples) {
  constexpr double kWithSlopes = 3.7e-7, kWithout = 2.5e-6;  // s
  const Index slopes = surrogate.unknown * countSlopePoints(samples, surrogate.unknown);
  double seconds = 0.0;
  for (const gp::SharedProcess& window : surrogate.forward->windows) {
    const bool has_slopes = window.getStructure().slopes;
    const auto learnt = static_cast<double>(samples + (has_slopes ? slopes : 0));
    seconds += (has_slopes ? kWithSlopes : kWithout) * learnt * learnt;
  }
  return seconds;
}

/// Whether the cross-validation lets expect that twice as many samples lead to smaller errors that matter. Of
/// fewer than 100 simulations too little is learnt to tell whether others would not help.
bool promisesMore(const CrossValidation& found) {
  constexpr double kNearLimit = 1.1, kWorthIt = 0.7;
  const auto far = found.limit_ratio.array() > kNearLimit;
  return found.half < kFirst ? far.any() : (far && found.error_ratio.array() < kWorthIt).any();
}

/// Why no more than `samples` are taken; empty where more are.
std::string findReason(int samples, int most, double seconds, const SurrogateMapTraining& training) {
  if (!promisesMore(*training.summary.cross_validation)) {
    return "the estimator is near the information limit, or its errors hardly fall any more";
  }
  if (2 * samples > most) {
    return fmt::format("at most {} are taken", most);
  }
  return predictTrainingSeconds(training.surrogate, 2 * samples) > seconds
             ? fmt::format("training on {} would take longer than design.train.time", 2 * samples)
             : "";
}

bool hasFewFailures(const ExperimentSpec& experiment, const SimulatedSets& sets) {
  const auto total = static_cast<double>(sets.train.statuses.size());
  const auto failed = total - static_cast<double>(findSuccessful(sets.train).size());
  return failed <= experiment.model.simulation.allowed_failures * total;
}

/// Simulates and trains with as many samples as the study says. No training where the samples do not permit
/// it; what is wrong with them the run itself says.
void tryOut(const Study& study, SampleChoice& choice) {
  SimulatedSets sets = simulateSets(study);
  choice.samples = study.experiment.design.train.samples;
  choice.simulated += static_cast<int>(sets.train.statuses.size() + sets.test.statuses.size()) - sets.reused;
  choice.notes.append(sets.notes);
  if (choice.training) {
    choice.notes.append({{}, choice.training->notes.times});
    choice.training.reset();
  }
  choice.data.reset();
  sets = failIncompleteSamples(study.experiment, study.extractor, std::move(sets));
  if (!hasFewFailures(study.experiment, sets)) {
    return;
  }
  choice.data = prepareData(study, std::move(sets));
  const LabelledFeatures& train = choice.data->labelled.train;
  if (findSurrogateObstacle(study.experiment.model, train.features.cols() / train.replicates,
                            train.noise_covariance)
          .empty()) {
    choice.training = trainSurrogateMap(study, *choice.data);
  }
}

}  // namespace

int limitByTime(const ExperimentSpec& experiment, Simulator& simulator) {
  const int most = experiment.design.train.samples;
  if (simulator.hasDerivatives()) {
    return most;
  }
  constexpr int kTimed = 2;
  const Eigen::MatrixXd points = sampleTrainPoints(takeTrainingSamples(experiment, kFirst)).leftCols(kTimed);
  Eigen::MatrixXd responses(simulator.getLayout().getRowCount(), kTimed);
  std::vector<SampleStatus> statuses(kTimed);
  const auto start = std::chrono::steady_clock::now();
  simulator.simulate(points, responses, statuses.data());
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  const double fitting = getSeconds(experiment) * kTimed / std::max(elapsed.count(), 1e-9);
  return static_cast<int>(std::clamp<double>(fitting, kFirst, most));
}

SampleChoice chooseTrainingSamples(const Study& study, int most) {
  SampleChoice choice;
  for (int samples = kFirst;; samples *= 2) {
    const ExperimentSpec tried = takeTrainingSamples(study.experiment, samples);
    tryOut(study.with(tried), choice);
    if (!choice.training) {
      choice.data.reset();
      choice.samples = std::min(most, kOfProcesses);
      logInfo(fmt::format(
          "training samples: {}; automatic sizing needs a surrogate, which cannot be trained here",
          choice.samples));
      return choice;
    }
    const std::string reason = findReason(samples, most, getSeconds(study.experiment), *choice.training);
    if (!reason.empty()) {
      logInfo(fmt::format("training samples: {} (automatic): {}", samples, reason));
      return choice;
    }
  }
}

}  // namespace twinmap
