#include "kernels/gp/optimizer.hpp"

#include <nlopt.h>

#include <cmath>
#include <limits>
#include <memory>

namespace twinmap::gp {
namespace {

// Returned where K cannot be factorised: worse than any NLML, yet finite, so that the line search backs off.
constexpr double kRejected = 1e10;
// In log-hyperparameters: a factor of e.
constexpr double kFirstStep = 1.0;

// A search has joined a known optimum within a factor 1.6 in every hyperparameter and half a nat above it, or
// where it is as good to a hundredth of a nat (where a hyperparameter hardly matters, distance says nothing).
constexpr double kJoinedDistance = 0.5;
constexpr double kEqualNats = 0.01;
constexpr double kJoinedNats = 0.5;
constexpr const char* kStopped = "asked to stop";

struct Search {
  const Objective& objective;
  Eigen::Index samples;
  const SearchBox& box;
  const SearchLimits& limits;
  Eigen::VectorXd gradient;
  double scale = 1.0;
  SearchResult result;
  Eigen::VectorXd last_point;  // evaluated last, with its objective: L-BFGS asks for its start again
  double last_objective = 0.0;
  nlopt_opt optimizer = nullptr;
};

double addPrior(const SearchBox& box, const Eigen::VectorXd& point, double nlml, Eigen::VectorXd& gradient) {
  const Eigen::VectorXd deviation = point - box.prior_mean;
  gradient += box.prior_precision.cwiseProduct(deviation);
  return nlml + 0.5 * deviation.dot(box.prior_precision.cwiseProduct(deviation));
}

void keepBest(Search& search, const Eigen::VectorXd& point, double nlml, double objective) {
  if (!(objective < search.result.objective)) {
    return;
  }
  search.result.end = point;
  search.result.nlml = nlml;
  search.result.objective = objective;
}

bool hasJoined(const Search& search, const Eigen::VectorXd& point, double objective) {
  const SearchResult* known = search.limits.known;
  if (known == nullptr) {
    return false;
  }
  const double above = objective - known->objective;
  const bool near = (point - known->end).cwiseAbs().maxCoeff() < kJoinedDistance;
  return std::abs(above) < kEqualNats || (near && above < kJoinedNats);
}

double calcObjective(Search& search, const Eigen::VectorXd& point) {
  const LikelihoodEvaluation evaluation = search.objective(point, search.gradient);
  ++search.result.evaluations;
  search.result.largest_jitter = std::max(search.result.largest_jitter, evaluation.jitter);
  if (!evaluation.ok) {
    return kRejected;
  }
  const double objective = addPrior(search.box, point, evaluation.nlml, search.gradient);
  keepBest(search, point, evaluation.nlml, objective);
  return objective;
}

double evaluate(unsigned count, const double* values, double* gradient, void* data) {
  Search& search = *static_cast<Search*>(data);
  const Eigen::Map<const Eigen::VectorXd> point(values, count);
  const bool stopped = isStopRequested(search.limits.stop);
  if (!stopped && point != search.last_point) {
    search.last_objective = calcObjective(search, point);
    search.last_point = point;
  }
  const double objective = search.last_objective;
  if (stopped || hasJoined(search, point, objective)) {
    nlopt_force_stop(search.optimizer);
  }
  if (gradient) {
    Eigen::Map<Eigen::VectorXd>(gradient, count) = search.scale * search.gradient;
  }
  return search.scale * objective;
}

// L-BFGS takes its first step along the gradient as it is. Scaling the objective makes that step at most
// kFirstStep long; unscaled, it leaps over the valley into the plateau where everything is noise.
double calcScale(Search& search, const Eigen::VectorXd& point) {
  search.last_objective = calcObjective(search, point);
  search.last_point = point;
  const double steepest = search.gradient.norm();
  const double per_sample = 1.0 / static_cast<double>(search.samples);
  return steepest > 0.0 ? std::min(per_sample, kFirstStep / steepest) : per_sample;
}

const char* describe(nlopt_result code) {
  switch (code) {
    case NLOPT_SUCCESS:
      return "converged";
    case NLOPT_FTOL_REACHED:
      return "the last step gained less than the tolerance";
    case NLOPT_XTOL_REACHED:
      return "the last step was too small to matter";
    case NLOPT_MAXEVAL_REACHED:
      return "evaluation limit reached";
    case NLOPT_FORCED_STOP:
      return "joined the first start's optimum";
    case NLOPT_ROUNDOFF_LIMITED:
      return "rounding errors stopped the progress";
    default:
      return "the line search found no further progress";
  }
}

}  // namespace

SearchResult minimize(const Objective& objective, Eigen::Index samples, const Eigen::VectorXd& start,
                      const SearchBox& box, const SearchLimits& limits) {
  Search search{objective, samples, box, limits, Eigen::VectorXd::Zero(start.size()),
                1.0,       {},      {},  0.0,    nullptr};
  search.result.objective = std::numeric_limits<double>::infinity();
  search.result.nlml = std::numeric_limits<double>::infinity();
  Eigen::VectorXd point = start.cwiseMax(box.lower).cwiseMin(box.upper);
  search.result.end = point;
  search.result.stop_reason = kStopped;
  if (isStopRequested(limits.stop)) {
    return search.result;
  }
  search.scale = calcScale(search, point);
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> optimizer(
      nlopt_create(NLOPT_LD_LBFGS, static_cast<unsigned>(start.size())), &nlopt_destroy);
  search.optimizer = optimizer.get();
  nlopt_set_min_objective(optimizer.get(), &evaluate, &search);
  nlopt_set_lower_bounds(optimizer.get(), box.lower.data());
  nlopt_set_upper_bounds(optimizer.get(), box.upper.data());
  nlopt_set_maxeval(optimizer.get(), std::max(1, limits.max_evaluations - 1));
  nlopt_set_ftol_abs(optimizer.get(), limits.tolerance * search.scale);
  double least = 0.0;
  const nlopt_result code = nlopt_optimize(optimizer.get(), point.data(), &least);
  if (isStopRequested(limits.stop)) {
    return search.result;
  }
  search.result.stop_reason = describe(code);
  search.result.converged = code != NLOPT_MAXEVAL_REACHED && std::isfinite(search.result.objective);
  return search.result;
}

SearchResult search(const TrainingSet& set, const Eigen::VectorXd& target, const Eigen::VectorXd& start,
                    const SearchBox& box, const SearchLimits& limits, LikelihoodWorkspace& workspace) {
  const Objective objective = [&](const Eigen::VectorXd& point, Eigen::VectorXd& gradient) {
    return evaluateLikelihoodGradient(set, target, fromLog(set.getStructure(), point), workspace, gradient);
  };
  return minimize(objective, set.size(), start, box, limits);
}

}  // namespace twinmap::gp
