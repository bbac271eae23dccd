#include "framework/study/sweep/thinned.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <variant>
#include <vector>

#include "framework/base/log/run_control.hpp"
#include "framework/data/features/feature_extractor.hpp"
#include "framework/data/reduction/response_reduction.hpp"
#include "framework/data/sensitivity/fit_reduction.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/study/sweep/case_cost.hpp"

namespace twinmap {
namespace {

using Clock = std::chrono::steady_clock;

double getSecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::unique_ptr<Simulator> makeWhole(const ExperimentSpec& experiment) {
  return makeSimulator(experiment.model, collectTimes(experiment.features), countModes(experiment.features));
}

ExperimentSpec takeEvery(ExperimentSpec experiment, int step) {
  changeTrials(experiment, [&](ExperimentSpec& one) {
    for (FeatureSpec& feature : one.features) {
      if (auto* samples = std::get_if<SamplesFeatureSpec>(&feature)) {
        samples->interval *= step;
        samples->count = (samples->count + step - 1) / step;
      }
    }
  });
  return experiment;
}

/// The first part of the record, with as many samples closer together, and as much time behind the last.
ExperimentSpec takeFirst(ExperimentSpec experiment, double part) {
  changeTrials(experiment, [&](ExperimentSpec& one) {
    const Eigen::VectorXd times = collectTimes(one.features);
    for (FeatureSpec& feature : one.features) {
      auto& samples = std::get<SamplesFeatureSpec>(feature);
      samples.start *= part;
      samples.interval *= part;
    }
    one.model.simulation.duration -= (1.0 - part) * times[times.size() - 1];
  });
  return experiment;
}

bool hasSamplesAlone(const ExperimentSpec& experiment) {
  return std::all_of(experiment.features.begin(), experiment.features.end(), [](const FeatureSpec& feature) {
    return std::holds_alternative<SamplesFeatureSpec>(feature);
  });
}

/// s, of one sample of a batch and, where the simulator has them, of one set of derivatives.
struct SimulationTime {
  double plain = 0.0, derivatives = 0.0;
  double calcSum() const { return plain + derivatives; }
  double calcOfDerivatives() const { return std::max(plain, derivatives); }
};

SimulationTime timeSimulation(const ExperimentSpec& experiment) {
  const std::unique_ptr<Simulator> simulator = makeWhole(experiment);
  const Eigen::VectorXd center = calcBoxCenter(collectSampled(experiment.model));
  const Eigen::Index batch = simulator->getBatchSize(), rows = simulator->getLayout().getRowCount();
  Eigen::MatrixXd responses(rows, batch);
  std::vector<SampleStatus> statuses(static_cast<std::size_t>(batch));
  SimulationTime time;
  const auto start = Clock::now();
  simulator->simulate(center.replicate(1, batch), responses, statuses.data());
  time.plain = getSecondsSince(start) / static_cast<double>(batch);
  if (simulator->hasDerivatives()) {
    Eigen::MatrixXd derivatives;
    const auto begin = Clock::now();
    simulator->simulateWithDerivatives(center, responses.leftCols(1), derivatives, statuses.data());
    time.derivatives = getSecondsSince(begin);
  }
  return time;
}

/// What reducing takes: simulations, and what is done with each number of them.
void measureReduction(const ExperimentSpec& whole, const SimulationTime& of_whole,
                      const SimulationTime& of_thinned, ThinnedExperiment& thinned) {
  constexpr double kSimulations = 60.0;  // with derivatives (fitReduction)
  const std::unique_ptr<Simulator> simulator = makeWhole(thinned.experiment);
  const auto start = Clock::now();
  thinned.scores =
      static_cast<double>(fitReduction(*simulator, thinned.experiment, RunControl{}).countScores());
  thinned.probed_reduction = getSecondsSince(start);
  const double rest = std::max(thinned.probed_reduction - kSimulations * of_thinned.calcOfDerivatives(), 0.0);
  thinned.reduction = kSimulations * of_whole.calcOfDerivatives() +
                      rest * countRecordedRows(whole) / countRecordedRows(thinned.experiment);
}

/// Of a long experiment, less where simulating takes a while nevertheless.
ExperimentSpec takeSome(const ExperimentSpec& experiment, int step) {
  constexpr double kMoment = 0.02, kLeast = 0.125;  // s; of the record
  const ExperimentSpec thinned = takeEvery(experiment, step);
  const double seconds = timeSimulation(thinned).calcOfDerivatives();
  return hasSamplesAlone(thinned) && seconds > kMoment
             ? takeFirst(thinned, std::max(kMoment / seconds, kLeast))
             : thinned;
}

}  // namespace

ThinnedExperiment thinSamples(const ExperimentSpec& experiment) {
  constexpr double kRows = 1000.0, kReducedRows = 8000.0;
  ThinnedExperiment thinned{experiment};
  const bool reduced = isReduced(experiment);
  const int step = static_cast<int>(countRecordedRows(experiment) / (reduced ? kReducedRows : kRows));
  if (step < 2) {
    return thinned;
  }
  thinned.experiment = takeSome(experiment, step);
  thinned.rows = countRows(experiment) / countRows(thinned.experiment);
  thinned.windows = countWindows(experiment) / countWindows(thinned.experiment);
  const SimulationTime of_whole = timeSimulation(experiment), of_thinned = timeSimulation(thinned.experiment);
  thinned.simulation = of_whole.calcSum() / of_thinned.calcSum();
  if (reduced) {
    measureReduction(experiment, of_whole, of_thinned, thinned);
  }
  return thinned;
}

}  // namespace twinmap
