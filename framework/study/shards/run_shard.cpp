#include "framework/study/shards/run_shard.hpp"

#include <fmt/core.h>

#include <unordered_set>

#include "framework/base/log/log.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/results/run_state.hpp"
#include "framework/study/pipeline/run_experiment.hpp"
#include "framework/study/samples/model_store.hpp"
#include "framework/study/shards/shard_plan.hpp"
#include "framework/study/shards/shard_record.hpp"
#include "framework/study/sweep/case_cost.hpp"
#include "framework/study/sweep/run_sweep.hpp"
#include "framework/study/sweep/shared_samples.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;
using Eigen::MatrixXd;

/// What the shards of one submission have in common.
struct ShardWork {
  const fs::path& folder;
  const std::string& command;
  const YamlNode& tree;
  const ShardPlan& plan;
  const std::vector<SweepCase>& cases;
  const RunControl& control;
};

MatrixXd selectCommon(const MatrixXd& points, const MatrixXd& among) {
  const auto get_bits = [](const auto& point) {
    const Eigen::VectorXd copy = point;
    return std::string(reinterpret_cast<const char*>(copy.data()), copy.size() * sizeof(double));
  };
  std::unordered_set<std::string> wanted;
  for (const auto& point : among.colwise()) {
    wanted.insert(get_bits(point));
  }
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (wanted.count(get_bits(points.col(i))) > 0) {
      kept.push_back(i);
    }
  }
  return points(Eigen::all, kept);
}

void requireDone(const SimulationProgress& done, const std::string& what) {
  if (done.simulated + done.given_up < done.total) {
    throw Interrupted(fmt::format("interrupted: {} of {} missing {} are simulated and kept", done.simulated,
                                  done.total, what));
  }
}

SimulationProgress simulate(SharedSamples samples, const std::string& what, const RunControl& control,
                            std::vector<SharedSamples>& kept) {
  constexpr double kShare = 0.25;  // as the plan has it
  kept.clear();
  kept.push_back(std::move(samples));
  const SimulationProgress done =
      simulateShared(kept, {kShare * PlanOptions{}.memory, "simulate " + what, 1}, control);
  requireDone(done, what);
  return done;
}

/// The points of one group: their samples, then the stencils of those at which derivatives are needed.
void simulatePoints(const ShardWork& work, const ModelGroup& group, const MatrixXd& points,
                    SimulationProgress& total) {
  SharedSamples opened = openSharedSamples(group, points, work.plan.store);
  if (!opened.failure.empty()) {
    return;  // each case reports it
  }
  std::vector<SharedSamples> samples, stencils;
  const SimulationProgress done = simulate(std::move(opened), "samples", work.control, samples);
  total.simulated += done.simulated;
  total.failed += done.failed;
  if (samples[0].simulator->hasDerivatives()) {
    return;
  }
  const std::vector<bool> all(work.cases.size(), true);
  for (const ModelGroup& part : splitByBounds(work.cases, group)) {
    const MatrixXd derivatives = selectCommon(collectDerivativePoints(work.cases, part, all), points);
    if (derivatives.cols() > 0) {
      simulate(openSharedStencils(part, derivatives, samples[0], work.plan.store), "stencils", work.control,
               stencils);
    }
  }
}

std::string simulateShard(const ShardWork& work, const Shard& shard) {
  const std::vector<bool> all(work.cases.size(), true);
  SimulationProgress total;
  int begin = 0;
  for (const ModelGroup& group : groupByModel(work.cases)) {
    const MatrixXd points = collectPoints(work.cases, group, all);
    const int first = std::max(shard.first, begin);
    const int last = std::min(shard.last, begin + static_cast<int>(points.cols()));
    if (first < last) {
      simulatePoints(work, group, points.middleCols(first - begin, last - first), total);
    }
    begin += static_cast<int>(points.cols());
  }
  return fmt::format("{} samples simulated, {} of them failed", total.simulated, total.failed);
}

/// Cases begin when all samples are there, so that no two of them simulate the same.
void requireSimulated(const ShardWork& work) {
  for (int i = 0; i < static_cast<int>(work.plan.shards.size()); ++i) {
    const ShardRecord record(work.folder, i);
    if (work.plan.shards[static_cast<std::size_t>(i)].kind == ShardKind::kSimulate &&
        record.getState() != ShardState::kDone) {
      const std::string& reason = record.getAttempts().empty() ? "" : record.getAttempts().back().reason;
      throw std::runtime_error(fmt::format("the samples of shard {} are not simulated: {}{}", i,
                                           getName(record.getState()), reason.empty() ? "" : ": " + reason));
    }
  }
}

SweepOptions makeOptions(const ShardWork& work) {
  SweepOptions options;
  options.folder = work.folder;
  options.store = work.plan.store;
  options.memory = work.plan.memory;  // which the job has asked for
  options.command = work.command;
  return options;
}

std::string runCasesOf(const ShardWork& work, const Shard& shard, std::vector<FailedCase>& failures) {
  requireSimulated(work);
  if (listSweptKeys(work.tree).empty()) {
    RunOptions options;
    options.folder = work.folder;
    options.store = work.plan.store;
    options.command = work.command;
    runExperiment(work.cases[0].experiment, options, work.control);
    return "the run is complete";
  }
  std::vector<bool> wanted(work.cases.size(), false);
  std::fill(wanted.begin() + shard.first, wanted.begin() + shard.last, true);
  const SweepResult result =
      runCasesOfSweep(listSweptKeys(work.tree), work.cases, wanted, makeOptions(work), work.control);
  failures = result.failures;
  if (result.stopped) {
    throw Interrupted(fmt::format("interrupted: {} of {} cases of the sweep are complete and kept",
                                  result.complete, result.cases));
  }
  if (!failures.empty()) {
    throw std::runtime_error(fmt::format("{} of {} cases failed; the first, {}: {}", failures.size(),
                                         shard.last - shard.first, failures[0].name, failures[0].reason));
  }
  return fmt::format("{} cases are complete", shard.last - shard.first);
}

std::string finishAll(const ShardWork& work) {
  if (listSweptKeys(work.tree).empty()) {
    return isComplete(work.folder) ? "the run is complete"
                                   : throw std::runtime_error("the run is not complete");
  }
  std::vector<FailedCase> failures;
  for (int i = 0; i < static_cast<int>(work.plan.shards.size()); ++i) {
    const ShardRecord record(work.folder, i);
    if (record.getState() == ShardState::kFailed) {
      const std::vector<FailedCase>& of_shard = record.getAttempts().back().failures;
      failures.insert(failures.end(), of_shard.begin(), of_shard.end());
    }
  }
  const SweepResult result =
      finishSweep(listSweptKeys(work.tree), work.cases, failures, makeOptions(work), work.control);
  if (result.complete < result.cases) {
    throw std::runtime_error(fmt::format("{} of {} cases are complete", result.complete, result.cases));
  }
  return result.table;
}

std::string runKind(const ShardWork& work, const Shard& shard, std::vector<FailedCase>& failures) {
  switch (shard.kind) {
    case ShardKind::kSimulate:
      return simulateShard(work, shard);
    case ShardKind::kCases:
      return runCasesOf(work, shard, failures);
    case ShardKind::kFinish:
      return finishAll(work);
  }
  return "";
}

/// Cases are trained by what is compiled for the processor; portable samples may be simulated by any.
void requireSameComputation(const ShardPlan& plan, ShardKind kind) {
  const bool any_processor = plan.portable && kind == ShardKind::kSimulate;
  if (!any_processor && plan.computed_with != describeComputation()) {
    throw ExperimentError("this program computes with " + describeComputation() +
                          ", but the experiment was submitted by one that computes with " +
                          plan.computed_with +
                          ": their results are not mixed; use the same program on all nodes, built portable");
  }
}

}  // namespace

std::string runShard(const fs::path& folder, int shard, const std::string& command,
                     const RunControl& control) {
  const ShardPlan plan = readShardPlan(folder);
  if (shard < 0 || shard >= static_cast<int>(plan.shards.size())) {
    throw ExperimentError(fmt::format("{}: has shards 0 to {}", folder.string(), plan.shards.size() - 1));
  }
  ShardRecord record(folder, shard);
  if (record.getState() == ShardState::kDone) {
    return "done before";
  }
  if (const std::string refusal = record.getRefusal(); !refusal.empty()) {
    throw std::runtime_error(
        "failed twice for the same reason and is not tried again before the next submit: " + refusal);
  }
  if (const std::string before = record.describeLast(); !before.empty()) {
    logWarning(fmt::format("shard {} is tried again; {}", shard, before));
  }
  record.begin();
  std::vector<FailedCase> failures;
  try {
    requireSameComputation(plan, plan.shards[static_cast<std::size_t>(shard)].kind);
    const YamlNode tree = loadYaml((folder / "resolved.yaml").string());
    const std::vector<SweepCase> cases = expandPlannedCases(tree, plan);
    const std::string done = runKind({folder, command, tree, plan, cases, control},
                                     plan.shards[static_cast<std::size_t>(shard)], failures);
    record.end(ShardState::kDone);
    return done;
  } catch (const Interrupted& interrupted) {
    record.end(ShardState::kInterrupted, interrupted.what());
    throw;
  } catch (const std::exception& error) {
    record.end(ShardState::kFailed, error.what(), failures);
    throw;
  }
}

}  // namespace twinmap
