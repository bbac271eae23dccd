#include "framework/study/sweep/shared_samples.hpp"

#include <algorithm>

#include "framework/data/sensitivity/stencil_simulator.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/study/samples/model_store.hpp"
#include "framework/study/samples/stencils.hpp"

namespace twinmap {
namespace {

/// Adds up the counts of several calls of storeMissing() and reports them.
class Totals {
 public:
  Totals(int total, const SharedStage& stage, const ProgressCallback& progress)
      : stage_(stage), progress_(progress) {
    counts.total = total;
  }

  void report(const SimulationProgress& part) const {
    if (progress_) {
      const int done = counts.simulated + part.simulated, each = stage_.simulations;
      progress_({stage_.name, each * done, each * counts.total, each * (counts.failed + part.failed),
                 double(done) / counts.total, true});
    }
  }

  void add(const SimulationProgress& part) {
    counts.simulated += part.simulated;
    counts.failed += part.failed;
    counts.given_up += part.given_up;
  }

  SimulationProgress counts;

 private:
  const SharedStage& stage_;
  const ProgressCallback& progress_;
};

Eigen::Index chooseBlock(const SharedSamples& samples, double memory) {
  constexpr double kMin = 256.0;
  const double row_bytes = sizeof(double) * static_cast<double>(samples.simulator->getLayout().getRowCount());
  const double fitting = memory / std::max(row_bytes, 1.0);
  return static_cast<Eigen::Index>(std::clamp(fitting, kMin, 1e9));
}

/// The points whose samples are in the store and did not fail.
Eigen::MatrixXd selectSucceeded(const Eigen::MatrixXd& points, const TrajectoryStore& samples) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (samples.contains(points.col(i)) && !samples.hasFailed(points.col(i))) {
      kept.push_back(i);
    }
  }
  return points(Eigen::all, kept);
}

/// False if it was stopped.
bool simulateGroup(SharedSamples& samples, const SharedStage& stage, const RunControl& control,
                   Totals& totals) {
  MissingOptions options;
  options.threads = control.threads;
  options.stop = control.stop;
  options.allowed_failures = samples.allowed_failures;
  options.progress = [&totals](const SimulationProgress& part) { totals.report(part); };
  const Eigen::Index block = chooseBlock(samples, stage.memory);
  for (Eigen::Index first = 0; first < samples.missing.cols(); first += block) {
    const Eigen::MatrixXd points =
        samples.missing.middleCols(first, std::min(block, samples.missing.cols() - first));
    const SimulationProgress part = storeMissing(*samples.store, *samples.simulator, points, options);
    totals.add(part);
    if (part.given_up > 0) {
      totals.counts.given_up += static_cast<int>(samples.missing.cols() - first - points.cols());
      return true;
    }
    if (part.simulated < part.total) {
      return false;
    }
    options.allowed_failures = 1.0;  // the first block has shown that there are others
  }
  return true;
}

}  // namespace

SharedSamples openSharedSamples(const ModelGroup& group, const Eigen::MatrixXd& points,
                                const std::filesystem::path& root) {
  SharedSamples samples;
  try {
    auto simulator = makeSimulator(group.model, group.times, group.modes);
    simulator->checkStart();
    samples.simulator = std::move(simulator);
  } catch (const ExperimentError& error) {
    samples.failure = error.what();
    return samples;
  }
  samples.store = openStore(group.model, samples.simulator->getLayout(), root);
  const std::size_t known = samples.store->getSetAside().size();
  samples.store->verify(points);
  logSetAside(*samples.store, known);
  const double allowed = group.model.simulation.allowed_failures;
  if (isGivenUp(*samples.store, points, allowed)) {
    samples.missing.resize(points.rows(), 0);
    return samples;
  }
  samples.missing = points(Eigen::all, samples.store->findMissing(points));
  samples.allowed_failures = selectSucceeded(points, *samples.store).cols() > 0 ? 1.0 : allowed;
  return samples;
}

SharedSamples openSharedStencils(const ModelGroup& group, const Eigen::MatrixXd& points,
                                 const SharedSamples& samples, const std::filesystem::path& root) {
  SharedSamples shared;
  shared.simulator = std::make_unique<StencilSimulator>(*samples.simulator, collectUnknown(group.model));
  shared.store = openStencilStore(group.model, samples.simulator->getLayout(), root);
  const Eigen::MatrixXd needed = selectSucceeded(points, *samples.store);
  shared.missing = needed(Eigen::all, shared.store->findMissing(needed));
  return shared;
}

SimulationProgress simulateShared(std::vector<SharedSamples>& groups, const SharedStage& stage,
                                  const RunControl& control) {
  int total = 0;
  for (const SharedSamples& samples : groups) {
    total += static_cast<int>(samples.missing.cols());
  }
  Totals totals(total, stage, control.progress);
  for (SharedSamples& samples : groups) {
    if (samples.missing.cols() > 0 && !simulateGroup(samples, stage, control, totals)) {
      break;
    }
  }
  return totals.counts;
}

}  // namespace twinmap
