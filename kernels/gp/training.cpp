#include "kernels/gp/training.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "kernels/gp/fit.hpp"
#include "kernels/gp/optimizer.hpp"
#include "kernels/gp/starts.hpp"
#include "kernels/linalg/condition.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

// A fit within this many nats of pure noise has found no signal: the best of many length scales gains two or
// four by chance, and a true signal gains of the order of n.
constexpr double kNoiseOnlyMargin = 5.0;

// Above this many samples the threads share one factorisation: n = 1500 takes 2 n^2 doubles, 36 MB, a thread.
constexpr Eigen::Index kTeamSamples = 1500;

// What one target needs, and the results of its searches.
struct TargetJob {
  VectorXd values;
  double stddev = 0.0;
  bool constant = false;
  SearchBox box;
  std::vector<VectorXd> starts;
  std::vector<SearchResult> results;
  int warm_start_evaluations = 0;
};

void checkOptions(const TrainingOptions& options) {
  const auto require = [](bool condition, const char* rule) {
    if (!condition) throw std::invalid_argument(std::string("TrainingOptions: ") + rule);
  };
  const auto require_bounds = [&](const RelativeBounds& bounds, const char* name) {
    if (bounds.lower > 0.0 && bounds.lower < bounds.upper && std::isfinite(bounds.upper)) return;
    std::ostringstream message;
    message << "TrainingOptions: " << name << " is [" << bounds.lower << ", " << bounds.upper
            << "]; it must satisfy 0 < lower < upper < infinity";
    throw std::invalid_argument(message.str());
  };
  require(options.starts >= 1, "starts must be at least 1");
  require(options.max_evaluations >= 1, "max_evaluations must be at least 1");
  require(options.tolerance > 0.0, "tolerance must be positive");
  require(options.start_noise > 0.0 && std::isfinite(options.start_noise), "start_noise must be positive");
  require(options.start_length_scale > 0.0 && std::isfinite(options.start_length_scale),
          "start_length_scale must be positive");
  require(options.threads >= 1, "threads must be at least 1");
  require_bounds(options.length_scale, "length_scale");
  require_bounds(options.signal_stddev, "signal_stddev");
  require_bounds(options.noise_stddev, "noise_stddev");
  require_bounds(options.shape, "shape");
  require_bounds(options.linear_stddev, "linear_stddev");
  if (!options.length_scale_prior) return;
  require(std::isfinite(options.length_scale_prior->log_mean), "the prior's log_mean must be finite");
  require(options.length_scale_prior->log_stddev > 0.0, "the prior's log_stddev must be positive");
}

void checkTargets(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                  const Eigen::Ref<const Eigen::MatrixXd>& targets) {
  if (targets.cols() != inputs.cols()) {
    throw std::invalid_argument("train: the targets have " + std::to_string(targets.cols()) + " columns for " +
                                std::to_string(inputs.cols()) + " training samples");
  }
  checkInputs(targets, "train: targets");
}

std::vector<TargetJob> makeJobs(const Eigen::Ref<const Eigen::MatrixXd>& targets) {
  std::vector<TargetJob> jobs(targets.rows());
  for (Index t = 0; t < targets.rows(); ++t) {
    TargetJob& job = jobs[t];
    job.values = targets.row(t).transpose();
    const double mean = job.values.mean();
    job.stddev = std::sqrt((job.values.array() - mean).square().mean());
    job.constant = !(job.stddev > 1e-13 * std::max(std::abs(mean), job.values.cwiseAbs().maxCoeff()));
  }
  return jobs;
}

// All searches of all targets: side by side, each by one thread, or for large matrices one after another,
// each by all threads (one workspace instead of many). The result is the same for any number of threads.
void runSearches(const TrainingSet& set, const TrainingOptions& options, std::vector<TargetJob>& jobs) {
  struct Task {
    TargetJob* job;
    std::size_t start;
  };
  std::vector<Task> tasks;
  for (TargetJob& job : jobs) {
    job.results.assign(job.starts.size(), {});
    for (std::size_t k = 0; k < job.starts.size(); ++k) tasks.push_back({&job, k});
  }
  const auto run = [&](const Task& task, LikelihoodWorkspace& workspace) {
    TargetJob& job = *task.job;
    job.results[task.start] = search(set, job.values, job.starts[task.start], job.box,
                                     options.max_evaluations, options.tolerance, workspace);
  };
  if (set.size() > kTeamSamples) {
    LikelihoodWorkspace workspace(set, options.threads);
    for (const Task& task : tasks) run(task, workspace);
    return;
  }
  const int count = static_cast<int>(tasks.size());
  const int threads = std::max(1, std::min(options.threads, count));
#pragma omp parallel num_threads(threads)
  {
    LikelihoodWorkspace workspace(set);
#pragma omp for schedule(dynamic, 1)
    for (int i = 0; i < count; ++i) run(tasks[i], workspace);
  }
}

void prepareSearches(const TrainingSet& set, const TrainingOptions& options, int starts,
                     std::vector<TargetJob>& jobs) {
  const DataScales scales = calcDataScales(set);
  for (TargetJob& job : jobs) {
    job.starts.clear();
    if (job.constant) continue;
    job.box = makeSearchBox(set, scales, job.stddev, options);
    job.starts = makeStarts(set, scales, job.stddev, options, starts);
  }
}

const SearchResult& bestOf(const std::vector<SearchResult>& results) {
  return *std::min_element(results.begin(), results.end(),
                           [](const auto& a, const auto& b) { return a.objective < b.objective; });
}

// With several groups, the last of the starts begins where a shared length scale ended.
void addWarmStarts(const TrainingSet& set, const TrainingOptions& options, std::vector<TargetJob>& jobs) {
  ModelStructure shared = set.getStructure();
  shared.length_scale_groups.clear();
  const TrainingSet shared_set(set.getInputs(), shared);
  std::vector<TargetJob> shared_jobs = jobs;
  prepareSearches(shared_set, options, std::min(options.starts, 2), shared_jobs);
  runSearches(shared_set, options, shared_jobs);
  for (std::size_t t = 0; t < jobs.size(); ++t) {
    if (jobs[t].constant) continue;
    for (const SearchResult& result : shared_jobs[t].results) {
      jobs[t].warm_start_evaluations += result.evaluations;
    }
    Hyperparameters warm = fromLog(shared, bestOf(shared_jobs[t].results).end);
    warm.length_scales = VectorXd::Constant(getGroupCount(set.getStructure()), warm.length_scales(0));
    jobs[t].starts.back() = toLog(set.getStructure(), warm);
  }
}

StartReport reportStart(const ModelStructure& structure, const VectorXd& start, const SearchResult& result,
                        double noise_only_nlml) {
  StartReport report;
  report.start = fromLog(structure, start);
  report.end = fromLog(structure, result.end);
  report.nlml = result.nlml;
  report.objective = result.objective;
  report.evaluations = result.evaluations;
  report.largest_jitter = result.largest_jitter;
  report.noise_only = !(result.nlml < noise_only_nlml - kNoiseOnlyMargin);
  report.converged = result.converged;
  report.stop_reason = result.stop_reason;
  return report;
}

// The least objective among the starts that found a signal; among all if none did.
int chooseStart(const std::vector<StartReport>& starts) {
  int best = -1;
  for (int k = 0; k < static_cast<int>(starts.size()); ++k) {
    if (!std::isfinite(starts[k].objective)) continue;
    const bool better = best < 0 || (starts[k].noise_only == starts[best].noise_only
                                         ? starts[k].objective < starts[best].objective
                                         : starts[best].noise_only);
    if (better) best = k;
  }
  return best;
}

std::vector<std::string> describeBounds(const ModelStructure& structure, const SearchBox& box,
                                        const VectorXd& point) {
  const std::vector<std::string> names = getHyperparameterNames(structure);
  std::vector<std::string> at_bound;
  const auto add = [&](Index i, const char* side, double bound) {
    std::ostringstream text;
    text << names[i] << " at its " << side << " bound " << std::exp(bound);
    at_bound.push_back(text.str());
  };
  for (Index i = 0; i < point.size(); ++i) {
    const double margin = 1e-6 * (box.upper(i) - box.lower(i));
    if (point(i) <= box.lower(i) + margin) add(i, "lower", box.lower(i));
    if (point(i) >= box.upper(i) - margin) add(i, "upper", box.upper(i));
  }
  return at_bound;
}

void setStatus(TrainingResult& result, TrainingStatus status, const std::string& message) {
  result.status = status;
  result.message = message;
}

void judge(TrainingResult& result) {
  const StartReport& best = result.report.starts[result.report.best_start];
  if (best.noise_only) {
    return setStatus(result, TrainingStatus::kNoiseOnly,
                     "every start found the target to be pure noise: the features do not explain it");
  }
  if (!best.converged) {
    return setStatus(result, TrainingStatus::kEvaluationLimit,
                     "the best start stopped after " + std::to_string(best.evaluations) +
                         " evaluations: " + best.stop_reason);
  }
  setStatus(result, TrainingStatus::kConverged, best.stop_reason);
}

TrainingResult finish(const TrainingSet& set, const TargetJob& job, LikelihoodWorkspace& workspace) {
  TrainingResult result;
  if (job.constant) {
    setStatus(result, TrainingStatus::kConstantTarget,
              "the target is constant over the training samples: there is nothing to infer");
    return result;
  }
  TrainingReport& report = result.report;
  report.noise_only_nlml = calcNoiseOnlyNlml(set, job.values);
  report.evaluations = job.warm_start_evaluations;
  for (std::size_t k = 0; k < job.starts.size(); ++k) {
    report.starts.push_back(
        reportStart(set.getStructure(), job.starts[k], job.results[k], report.noise_only_nlml));
    report.evaluations += job.results[k].evaluations;
  }
  report.best_start = chooseStart(report.starts);
  const LikelihoodEvaluation evaluation =
      report.best_start < 0
          ? LikelihoodEvaluation{}
          : evaluateLikelihood(set, job.values, report.starts[report.best_start].end, workspace);
  if (!evaluation.ok) {
    setStatus(result, TrainingStatus::kFailed,
              "no start had a positive definite covariance matrix: raise the noise's lower bound");
    return result;
  }
  report.at_bound = describeBounds(set.getStructure(), job.box, job.results[report.best_start].end);
  report.jitter = evaluation.jitter;
  result.gp = makeGaussianProcess(set, report.starts[report.best_start].end, evaluation, workspace);
  report.condition = linalg::estimateCondition(linalg::viewOf(result.gp->getFactor()));
  judge(result);
  return result;
}

}  // namespace

const char* toString(TrainingStatus status) {
  switch (status) {
    case TrainingStatus::kConverged:
      return "converged";
    case TrainingStatus::kEvaluationLimit:
      return "evaluation_limit";
    case TrainingStatus::kNoiseOnly:
      return "noise_only";
    case TrainingStatus::kConstantTarget:
      return "constant_target";
    case TrainingStatus::kFailed:
      return "failed";
  }
  return "unknown";
}

std::vector<TrainingResult> train(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                  const Eigen::Ref<const Eigen::MatrixXd>& targets,
                                  const ModelStructure& structure, const TrainingOptions& options) {
  checkOptions(options);
  checkTargets(inputs, targets);
  const TrainingSet set(inputs, structure);
  std::vector<TargetJob> jobs = makeJobs(targets);
  prepareSearches(set, options, options.starts, jobs);
  if (getGroupCount(structure) > 1) addWarmStarts(set, options, jobs);
  runSearches(set, options, jobs);
  LikelihoodWorkspace workspace(set, set.size() > kTeamSamples ? options.threads : 1);
  std::vector<TrainingResult> results;
  for (const TargetJob& job : jobs) results.push_back(finish(set, job, workspace));
  return results;
}

}  // namespace twinmap::gp
