#include "kernels/gp/training.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "kernels/gp/fit.hpp"
#include "kernels/gp/multi_start.hpp"
#include "kernels/gp/polish.hpp"
#include "kernels/gp/starts.hpp"
#include "kernels/linalg/condition.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

void checkOptions(const TrainingOptions& options) {
  const auto require = [](bool condition, const char* rule) {
    if (!condition) {
      throw std::invalid_argument(std::string("TrainingOptions: ") + rule);
    }
  };
  const auto require_bounds = [&](const RelativeBounds& bounds, const char* name) {
    if (bounds.lower > 0.0 && bounds.lower < bounds.upper && std::isfinite(bounds.upper)) {
      return;
    }
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
  if (!options.length_scale_prior) {
    return;
  }
  require(std::isfinite(options.length_scale_prior->log_mean), "the prior's log_mean must be finite");
  require(options.length_scale_prior->log_stddev > 0.0, "the prior's log_stddev must be positive");
}

void checkTargets(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                  const Eigen::Ref<const Eigen::MatrixXd>& targets) {
  if (targets.cols() != inputs.cols()) {
    throw std::invalid_argument("train: the targets have " + std::to_string(targets.cols()) +
                                " columns for " + std::to_string(inputs.cols()) + " training samples");
  }
  checkInputs(targets, "train: targets");
}

void checkWarmStarts(Eigen::Index targets, const ModelStructure& structure,
                     const std::vector<WarmStart>& warm_starts) {
  if (!warm_starts.empty() && static_cast<Eigen::Index>(warm_starts.size()) != targets) {
    throw std::invalid_argument("TrainingOptions: warm_starts has " + std::to_string(warm_starts.size()) +
                                " entries for " + std::to_string(targets) + " targets");
  }
  for (const WarmStart& start : warm_starts) {
    checkHyperparameters(structure, start.hyperparameters);
    const int count = HyperparameterLayout(structure).count;
    if (start.curvature.rows() != count || start.curvature.cols() != count) {
      throw std::invalid_argument("TrainingOptions: the curvature of a warm start must have " +
                                  std::to_string(count) + " rows and columns");
    }
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
  report.noise_only = isNoiseOnly(result.nlml, noise_only_nlml);
  report.converged = result.converged;
  report.stop_reason = result.stop_reason;
  return report;
}

// The least objective among the starts that found a signal; among all if none did.
int chooseStart(const std::vector<StartReport>& starts) {
  int best = -1;
  for (int k = 0; k < static_cast<int>(starts.size()); ++k) {
    if (!std::isfinite(starts[k].objective)) {
      continue;
    }
    const bool better = best < 0 || (starts[k].noise_only == starts[best].noise_only
                                         ? starts[k].objective < starts[best].objective
                                         : starts[best].noise_only);
    if (better) {
      best = k;
    }
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
    constexpr double kAtBound = 1e-6;  // of the box: the optimizer clamps to within rounding of it
    const double margin = kAtBound * (box.upper(i) - box.lower(i));
    if (point(i) <= box.lower(i) + margin) {
      add(i, "lower", box.lower(i));
    }
    if (point(i) >= box.upper(i) - margin) {
      add(i, "upper", box.upper(i));
    }
  }
  return at_bound;
}

std::vector<BoundedHyperparameter> listHyperparameters(const ModelStructure& structure, const SearchBox& box,
                                                       const VectorXd& point) {
  const std::vector<std::string> names = getHyperparameterNames(structure);
  std::vector<BoundedHyperparameter> listed;
  for (Index i = 0; i < point.size(); ++i) {
    listed.push_back({names[i], std::exp(point(i)), std::exp(box.lower(i)), std::exp(box.upper(i))});
  }
  return listed;
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

TrainingResult finish(const TrainingSet& set, const TargetSearches& searches, bool curvature,
                      LikelihoodWorkspace& workspace) {
  TrainingResult result;
  if (searches.constant) {
    setStatus(result, TrainingStatus::kConstantTarget,
              "the target is constant over the training samples: there is nothing to infer");
    return result;
  }
  TrainingReport& report = result.report;
  report.noise_only_nlml = calcNoiseOnlyNlml(set, searches.values);
  report.evaluations = searches.warm_start_evaluations;
  for (std::size_t k = 0; k < searches.starts.size(); ++k) {
    report.starts.push_back(
        reportStart(set.getStructure(), searches.starts[k], searches.results[k], report.noise_only_nlml));
    report.evaluations += searches.results[k].evaluations;
  }
  report.best_start = chooseStart(report.starts);
  const LikelihoodEvaluation evaluation =
      report.best_start < 0
          ? LikelihoodEvaluation{}
          : evaluateLikelihood(set, searches.values, report.starts[report.best_start].end, workspace);
  if (!evaluation.ok) {
    setStatus(result, TrainingStatus::kFailed,
              "no start had a positive definite covariance matrix: raise the noise's lower bound");
    return result;
  }
  const VectorXd& end = searches.results[report.best_start].end;
  report.at_bound = describeBounds(set.getStructure(), searches.box, end);
  report.hyperparameters = listHyperparameters(set.getStructure(), searches.box, end);
  report.jitter = evaluation.jitter;
  result.gp = makeGaussianProcess(set, report.starts[report.best_start].end, evaluation, workspace);
  report.condition = linalg::estimateCondition(linalg::viewOf(result.gp->getFactor()));
  judge(result);
  if (curvature) {
    result.curvature =
        calcCurvature(set, searches.values, result.gp->getHyperparameters(), searches.box, workspace);
  }
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
  checkWarmStarts(targets.rows(), structure, options.warm_starts);
  const TrainingSet set(inputs, structure);
  const std::vector<TargetSearches> searches = searchAllStarts(set, targets, options);
  LikelihoodWorkspace workspace(set, getTeamSize(set, options.threads));
  std::vector<TrainingResult> results;
  for (const TargetSearches& target : searches) {
    throwIfStopped(options.stop);
    results.push_back(finish(set, target, options.curvature, workspace));
  }
  return results;
}

}  // namespace twinmap::gp
