#include "framework/study/sweep/case_cost.hpp"

#include <fmt/core.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/data/sensitivity/stencil_simulator.hpp"
#include "framework/estimation/gp/train_gp_map.hpp"
#include "framework/estimation/network/train_network_map.hpp"
#include "framework/estimation/surrogate/forward_samples.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/network_size.hpp"

namespace twinmap {
namespace {

constexpr double kFitCost = 1.0 / 3.0;  // of an evaluation with its gradient
constexpr double kBytes = 8.0;          // of a number

bool isSparse(const ExperimentSpec& experiment) {
  const GpMapSpec* gp = experiment.inverse_map.findGp();
  return gp != nullptr && gp->approximation == GpApproximation::kSgpr;
}

double countColumns(const ExperimentSpec& experiment) {
  return double(experiment.design.train.samples) * experiment.noise.replicates.value_or(1);
}

/// Samples of the largest exact process.
double countExact(const ExperimentSpec& experiment) {
  const double columns = countColumns(experiment);
  return isSparse(experiment) ? std::min<double>(columns, experiment.inverse_map.findGp()->subset) : columns;
}

/// Of them, those that the hyperparameters are searched with.
double countSearched(const ExperimentSpec& experiment) {
  const int samples = experiment.design.train.samples, replicates = experiment.noise.replicates.value_or(1);
  const double columns = countExact(experiment);
  return isSparse(experiment)
             ? columns
             : double(samples) * countSearchedReplicates(Eigen::Index(samples) * replicates, replicates);
}

/// Of reducing: the sketch and the directions, the points whose sensitivities are added at a time, and the
/// responses of each thread with derivatives.
double countReductionNumbers(const ExperimentSpec& experiment, int threads) {
  constexpr double kOfSample = 64.0, kAtOnce = 40e6;  // twice, for the solver holds them too
  return isReduced(experiment) ? kOfSample * countRecordedRows(experiment) + kAtOnce * threads : 0.0;
}

double countFeaturesOf(const SamplesFeatureSpec& samples) {
  return double(samples.outputs.size()) * samples.count;
}
double countFeaturesOf(const StatisticsFeatureSpec& statistics) {
  return double(statistics.outputs.size()) * double(statistics.quantities.size());
}
double countFeaturesOf(const ExtremaFeatureSpec& extrema) {
  return 2.0 * extrema.peaks * (extrema.kind == ExtremaKind::kBoth ? 2.0 : 1.0);
}
double countFeaturesOf(const ModesFeatureSpec& modes) {
  return 2.0 * modes.count;
}
template <class Lines>
double countFeaturesOf(const Lines& lines) {
  return 3.0 * double(lines.outputs.size()) * double(lines.frequencies.size());
}

double countFeatures(const ExperimentSpec& experiment) {
  double count = 0.0;
  if (isReduced(experiment)) {
    return countRows(experiment);
  }
  for (const FeatureSpec& feature : experiment.features) {
    count += std::visit([](const auto& kind) { return countFeaturesOf(kind); }, feature);
  }
  return count;
}

/// Whether the noise of one feature may go along with another's. That of samples is independent as that of
/// the response.
bool isNoiseCoupled(const ExperimentSpec& experiment) {
  return !experiment.noise.correlation.empty() ||
         std::any_of(experiment.features.begin(), experiment.features.end(), [](const FeatureSpec& feature) {
           return !std::holds_alternative<SamplesFeatureSpec>(feature);
         });
}

/// Numbers for the features themselves: where their noise is coupled, its covariance, of training and of test
/// samples, its factor and its inverse's, eigenvectors and work space. Measured: 7.6 to 8 times the square of
/// 1000 and 2000 features; a network draws its samples besides, 21000 a feature.
double countFeatureNumbers(const ExperimentSpec& experiment) {
  constexpr double kSquares = 8.0, kNetworkSamples = 21e3;
  const double features = countFeatures(experiment);
  const bool network = experiment.inverse_map.findNetwork() != nullptr;
  return (isNoiseCoupled(experiment) ? kSquares * features * features : 0.0) +
         (network ? kNetworkSamples * features : 0.0);
}

double countSearches(const GpMapSpec& gp) {
  return gp.starts + (gp.length_scales == LengthScales::kShared ? 0.0 : std::min(gp.starts, 2));
}

double square(double x) {
  return x * x;
}

double cube(double x) {
  return x * x * x;
}

/// The search of each window on at most 300 samples, then some evaluations with all: the search's end, and
/// that of each fold.
std::vector<TrainingStep> listSurrogateSteps(const ExperimentSpec& experiment) {
  constexpr double kSearched = 300.0, kSearches = 3.0, kEvaluationsOfAll = 40.0;
  const double samples = experiment.design.train.samples, windows = countWindows(experiment);
  return {{std::min(samples, kSearched), windows, kSearches}, {samples, windows, 0.0, kEvaluationsOfAll}};
}

/// Rows of values and slopes that a surrogate of a mechanism learns from; others may have no derivatives.
double countJointRows(const ExperimentSpec& experiment) {
  const Eigen::Index samples = experiment.design.train.samples;
  const auto unknown = static_cast<Eigen::Index>(collectUnknown(experiment.model).size());
  return experiment.model.source ? 0.0 : double(samples + unknown * countSlopePoints(samples, unknown));
}

/// Numbers of the matrices of a surrogate: its windows', those of the search of each thread, and of the joint
/// covariance of values and slopes in work, with its inverse and what a fold takes of both.
double countSurrogateNumbers(const ExperimentSpec& experiment, int threads) {
  constexpr double kCopies = 6.0, kJointCopies = 5.0;
  return square(experiment.design.train.samples) * (2.0 * countWindows(experiment) + kCopies * threads) +
         kJointCopies * threads * square(countJointRows(experiment));
}

/// The same of an inverse map's processes.
double countProcessNumbers(const ExperimentSpec& experiment, const GpMapSpec& gp, int threads) {
  // packed factors are kept; of the two beams the peak was 6.0 times the square of 1000 and of 2000 columns
  constexpr double kSparseCopies = 6.0, kKept = 0.75;
  const auto parameters = static_cast<double>(experiment.model.parameters.size());
  const double searches = std::min(double(threads), parameters * gp.starts);
  const double exact = countExact(experiment);
  double numbers = std::max(square(countSearched(experiment)) * (2.5 * searches + 1.0), 3.5 * square(exact)) +
                   kKept * parameters * square(exact);
  if (isSparse(experiment)) {
    numbers += kSparseCopies * countColumns(experiment) * gp.inducing * searches;
  }
  return numbers;
}

/// Whether processes with all samples are trained for a surrogate, be it a network's teacher.
bool mayTrainSurrogate(const ExperimentSpec& experiment) {
  const NetworkMapSpec* network = experiment.inverse_map.findNetwork();
  return network == nullptr ? !experiment.inverse_map.isNone()
                            : network->mayLearnFromSurrogate(experiment.design.train.samples);
}

/// Draws of the posteriors of all test samples, and the responses that each thread simulates at once, with
/// derivatives. Measured on four mechanisms: up to four rounds of 512 draws.
double countPosteriorNumbers(const ExperimentSpec& experiment, int threads) {
  constexpr double kDraws = 4.0 * 512.0, kStarts = 64.0;
  const auto unknown = static_cast<double>(collectUnknown(experiment.model).size());
  return kDraws * (unknown + 1.0) * experiment.design.test.samples +
         threads * countRows(experiment) *
             (kDraws + kStarts * countNeighbours(collectUnknown(experiment.model).size()));
}

double countMapNumbers(const ExperimentSpec& experiment, int threads) {
  if (const GpMapSpec* gp = experiment.inverse_map.findGp()) {
    return countProcessNumbers(experiment, *gp, threads);
  }
  if (experiment.inverse_map.isNone()) {
    return countPosteriorNumbers(experiment, threads);
  }
  return mayTrainSurrogate(experiment) ? countSurrogateNumbers(experiment, threads) : 0.0;
}

/// Of networks alone: their weights, forwards and backwards, for each sample of each step. Of a
/// surrogate's student the first training: whether a second follows is not known before.
double countNetworkFlops(const NetworkMapSpec& network, int simulations) {
  constexpr double kInputs = 32.0, kOfWeight = 6.0;
  double weights = 0.0, before = kInputs;
  const NetworkMapSpec sized = completeSize(network, NetworkSize::kSmall);
  for (const int units : *sized.hidden) {
    weights += before * units;
    before = units;
  }
  const int trainings = network.mayLearnFromSurrogate(simulations) ? 1 : countTrainings(network, simulations);
  return kOfWeight * trainings * weights * *sized.steps * *sized.batch;
}

}  // namespace

double countRecordedRows(const ExperimentSpec& experiment) {
  return static_cast<double>(collectTimes(experiment.features).size()) *
             static_cast<double>(experiment.model.outputs.size()) +
         2.0 * countModes(experiment.features) + 1.0;
}

double countRows(const ExperimentSpec& experiment, double scores) {
  constexpr double kSums = 2.0;
  const double samples = countRecordedRows(experiment);
  return isReduced(experiment) ? (scores + kSums) * countReducedWindows(samples) : samples;
}

double countWindows(const ExperimentSpec& experiment) {
  constexpr double kRowsPerWindow = 16.0, kMost = 64.0;
  return std::min(kMost, std::ceil(countRows(experiment) / kRowsPerWindow));
}

std::vector<TrainingStep> listTrainingSteps(const ExperimentSpec& experiment) {
  if (experiment.inverse_map.findGp() == nullptr) {
    return mayTrainSurrogate(experiment) ? listSurrogateSteps(experiment) : std::vector<TrainingStep>();
  }
  const GpMapSpec& gp = *experiment.inverse_map.findGp();
  const auto parameters = static_cast<double>(experiment.model.parameters.size());
  const double exact = countExact(experiment), searched = countSearched(experiment);
  const double first = std::min<double>(exact, experiment.design.train.samples);
  std::vector<TrainingStep> steps{{first, parameters, countSearches(gp)}};
  if (isSparse(experiment) ? countColumns(experiment) > first : searched > first) {
    steps.push_back({searched, parameters, 1.0});
  }
  if (searched < exact) {
    steps.push_back({exact, parameters, 0.0, kFitCost});
  }
  if (isSparse(experiment)) {
    const double passes = (gp.refine_evaluations + 2.0) * 4.0 * countColumns(experiment) / gp.inducing;
    steps.push_back({double(gp.inducing), parameters, 0.0, passes});
  }
  return steps;
}

CaseCost calcCaseCost(const ExperimentSpec& experiment, int threads) {
  constexpr double kCopies = 10.0, kLimitCopies = 1.5, kPosteriorCopies = 3.0;
  double numbers = countMapNumbers(experiment, threads) + countFeatureNumbers(experiment) +
                   countReductionNumbers(experiment, threads);
  numbers += kCopies * countRows(experiment) * (countColumns(experiment) + experiment.design.test.samples);
  if (experiment.evaluation.limit) {
    numbers += kLimitCopies * countRows(experiment) *
               countNeighbours(collectUnknown(experiment.model).size()) * experiment.design.test.samples;
  }
  if (experiment.evaluation.posterior) {
    numbers += kPosteriorCopies * countRows(experiment) * experiment.evaluation.posterior->draws;
  }
  CaseCost cost{kBytes * numbers, 0.0};
  for (const TrainingStep& step : listTrainingSteps(experiment)) {
    const double evaluations = step.searches > 0.0 ? step.searches * kEvaluations : 1.0;
    cost.flops += step.processes * evaluations * step.relative_cost * cube(step.samples);
  }
  if (experiment.inverse_map.isNone()) {
    constexpr double kSimulations = 3000.0, kFlopsOfRow = 1000.0;  // of a posterior; of a sample in time
    cost.flops += kSimulations * kFlopsOfRow * countRows(experiment) * experiment.design.test.samples;
  }
  if (const NetworkMapSpec* network = experiment.inverse_map.findNetwork()) {
    cost.flops += countNetworkFlops(*network, experiment.design.train.samples);
  }
  return cost;
}

double getMachineMemory() {
  return static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

double getAvailableMemory() {
  constexpr double kKibibyte = 1024.0;
  double bytes = getMachineMemory(), number = 0.0;
  std::ifstream machine("/proc/meminfo");
  for (std::string key, unit; machine >> key >> number && std::getline(machine, unit);) {
    bytes = key == "MemAvailable:" ? std::min(bytes, kKibibyte * number) : bytes;
  }
  if (std::ifstream group("/sys/fs/cgroup/memory.max"); group >> number) {  // "max" is not a number
    bytes = std::min(bytes, number);
  }
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    bytes = std::min(bytes, static_cast<double>(limit.rlim_cur));
  }
  return bytes;
}

void requireMemory(const ExperimentSpec& experiment, int threads, double bytes) {
  const double needed = calcCaseCost(experiment, threads).bytes;
  if (needed > bytes) {
    throw ExperimentError(
        {experiment.name.where.file, 0, 0, "design"}, "",
        fmt::format(
            "needs about {} GiB of memory for {} features, {} training samples x {} draws of noise and "
            "{} test samples; {:.3g} GiB are available. {}, or allow more (--memory)",
            fmt::format(needed < 1000.0 * kGibibyte ? "{:.3g}" : "{:.0f}", needed / kGibibyte),
            countFeatures(experiment), experiment.design.train.samples.number,
            experiment.noise.replicates.value_or(1), experiment.design.test.samples.number, bytes / kGibibyte,
            kBytes * countFeatureNumbers(experiment) > 0.5 * needed
                ? "Take fewer samples of the outputs: the covariance of their noise grows with the square"
                : "Reduce design.train.samples, noise.replicates or design.test.samples"));
  }
}

}  // namespace twinmap
