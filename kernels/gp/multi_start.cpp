#include "kernels/gp/multi_start.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>

#include "kernels/gp/polish.hpp"
#include "kernels/gp/starts.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

struct Task {
  TargetSearches* target;
  std::size_t start;
};

/// Another search from `start`, with the evaluations that are left; the better end counts.
void searchFurther(const TrainingSet& set, const Objective& objective, const TargetSearches& target,
                   const VectorXd& start, SearchLimits limits, SearchResult& best) {
  limits.max_evaluations -= best.evaluations;
  if (limits.max_evaluations < 1 || isStopRequested(limits.stop)) {
    return;
  }
  SearchResult further = minimize(objective, set.size(), start, target.box, limits);
  further.evaluations += best.evaluations;
  further.largest_jitter = std::max(best.largest_jitter, further.largest_jitter);
  if (further.objective <= best.objective) {
    best = std::move(further);
  } else {
    best.evaluations = further.evaluations;
    best.largest_jitter = further.largest_jitter;
  }
}

// Where Newton's steps do not arrive soon, L-BFGS, whose line search reaches further, goes on from their end,
// and begins at the start as well: they may have led to a poor optimum.
SearchResult searchWarm(const TrainingSet& set, const TrainingOptions& options, const TargetSearches& target,
                        LikelihoodWorkspace& workspace) {
  // Evaluations: from near an optimum 5 to 16, and 26 where ten factors of e lie between.
  constexpr int kSoon = 40;
  const Objective objective = [&](const VectorXd& point, VectorXd& gradient) {
    return evaluateLikelihoodGradient(set, target.values, fromLog(set.getStructure(), point), workspace,
                                      gradient);
  };
  SearchLimits limits{std::min(kSoon, options.max_evaluations), options.tolerance, nullptr, options.stop};
  SearchResult best = polish(objective, target.starts[0], target.curvature, target.box, limits);
  if (!best.converged) {
    limits.max_evaluations = options.max_evaluations;
    searchFurther(set, objective, target, VectorXd(best.end), limits, best);
    searchFurther(set, objective, target, target.starts[0], limits, best);
  }
  return best;
}

// The starts after the first know its optimum, and stop once they have come near it.
void runTask(const TrainingSet& set, const TrainingOptions& options, const Task& task,
             LikelihoodWorkspace& workspace) {
  TargetSearches& target = *task.target;
  if (target.curvature.size() > 0) {
    target.results[task.start] = searchWarm(set, options, target, workspace);
    return;
  }
  const SearchResult* known = task.start > 0 ? &target.results[0] : nullptr;
  target.results[task.start] =
      search(set, target.values, target.starts[task.start], target.box,
             {options.max_evaluations, options.tolerance, known, options.stop}, workspace);
}

void runSideBySide(const TrainingSet& set, const TrainingOptions& options, const std::vector<Task>& tasks) {
  const int count = static_cast<int>(tasks.size());
  const int threads = std::max(1, std::min(options.threads, count));
#pragma omp parallel num_threads(threads)
  {
    LikelihoodWorkspace workspace(set);
#pragma omp for schedule(dynamic, 1)
    for (int i = 0; i < count; ++i) {
      runTask(set, options, tasks[i], workspace);
    }
  }
}

// Side by side, each by one thread, or for large matrices one after another, each by all threads (one
// workspace instead of many).
void runTasks(const TrainingSet& set, const TrainingOptions& options, const std::vector<Task>& tasks) {
  const int team = getTeamSize(set, options.threads);
  if (team > 1) {
    LikelihoodWorkspace workspace(set, team);
    for (const Task& task : tasks) {
      runTask(set, options, task, workspace);
    }
  } else {
    runSideBySide(set, options, tasks);
  }
  throwIfStopped(options.stop);
}

std::vector<Task> makeTasks(std::vector<TargetSearches>& targets, std::size_t first, std::size_t last) {
  std::vector<Task> tasks;
  for (TargetSearches& target : targets) {
    target.results.resize(target.starts.size());
    for (std::size_t k = first; k < std::min(last, target.starts.size()); ++k) {
      tasks.push_back({&target, k});
    }
  }
  return tasks;
}

std::vector<TargetSearches> makeTargets(const Eigen::Ref<const MatrixXd>& targets) {
  std::vector<TargetSearches> all(targets.rows());
  for (Index t = 0; t < targets.rows(); ++t) {
    TargetSearches& target = all[t];
    target.values = targets.row(t).transpose();
    const double mean = target.values.mean();
    target.stddev = std::sqrt((target.values.array() - mean).square().mean());
    const double largest = std::max(std::abs(mean), target.values.cwiseAbs().maxCoeff());
    constexpr double kRounding = 1e-13;  // of mean and stddev over thousands of samples, with a margin
    target.constant = !(target.stddev > kRounding * largest);
  }
  return all;
}

void chooseStarts(const TrainingSet& set, const TrainingOptions& options, int starts,
                  std::vector<TargetSearches>& targets) {
  const DataScales scales = calcDataScales(set);
  for (TargetSearches& target : targets) {
    target.starts.clear();
    target.results.clear();
    if (target.constant) {
      continue;
    }
    target.box = makeSearchBox(set, scales, target.stddev, options);
    target.starts = makeStarts(set, scales, target.stddev, options, starts);
  }
}

void searchStarts(const TrainingSet& set, const TrainingOptions& options,
                  std::vector<TargetSearches>& targets) {
  constexpr std::size_t kFirst = 1;  // the optimum of the first start is what the others may join
  runTasks(set, options, makeTasks(targets, 0, kFirst));
  runTasks(set, options, makeTasks(targets, kFirst, options.starts));
}

const SearchResult& bestOf(const std::vector<SearchResult>& results) {
  return *std::min_element(results.begin(), results.end(),
                           [](const auto& a, const auto& b) { return a.objective < b.objective; });
}

// With several groups, the last of the starts begins where a shared length scale ended.
void addWarmStarts(const TrainingSet& set, const TrainingOptions& options,
                   std::vector<TargetSearches>& targets) {
  ModelStructure shared = set.getStructure();
  shared.length_scale_groups.clear();
  const TrainingSet shared_set(set.getInputs(), shared);
  std::vector<TargetSearches> shared_targets = targets;
  // A single length scale has few optima, and the best only starts another search.
  constexpr int kMaxShared = 2;
  chooseStarts(shared_set, options, std::min(options.starts, kMaxShared), shared_targets);
  searchStarts(shared_set, options, shared_targets);
  for (std::size_t t = 0; t < targets.size(); ++t) {
    if (targets[t].constant) {
      continue;
    }
    for (const SearchResult& result : shared_targets[t].results) {
      targets[t].warm_start_evaluations += result.evaluations;
    }
    Hyperparameters warm = fromLog(shared, bestOf(shared_targets[t].results).end);
    warm.length_scales = VectorXd::Constant(getGroupCount(set.getStructure()), warm.length_scales(0));
    targets[t].starts.back() = toLog(set.getStructure(), warm);
  }
}

}  // namespace

std::vector<TargetSearches> searchAllStarts(const TrainingSet& set, const Eigen::Ref<const MatrixXd>& targets,
                                            const TrainingOptions& options) {
  std::vector<TargetSearches> all = makeTargets(targets);
  chooseStarts(set, options, options.starts, all);
  if (!options.warm_starts.empty()) {
    for (std::size_t t = 0; t < all.size(); ++t) {
      if (!all[t].constant) {
        all[t].starts = {toLog(set.getStructure(), options.warm_starts[t].hyperparameters)};
        all[t].curvature = options.warm_starts[t].curvature;
      }
    }
    runTasks(set, options, makeTasks(all, 0, 1));
    return all;
  }
  if (getGroupCount(set.getStructure()) > 1) {
    addWarmStarts(set, options, all);
  }
  searchStarts(set, options, all);
  return all;
}

}  // namespace twinmap::gp
