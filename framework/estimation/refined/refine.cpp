#include "framework/estimation/refined/refine.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>

#include "framework/estimation/refined/acceptance.hpp"
#include "framework/estimation/refined/confirmation.hpp"
#include "framework/estimation/refined/ridge_trace.hpp"
#include "framework/estimation/refined/search.hpp"
#include "framework/simulation/simulator_team.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The attempts at one measurement.
class Refinement {
 public:
  Refinement(Simulator& simulator, const RefinementModel& model, const RefinementTask& task)
      : simulator_(simulator),
        model_(model),
        task_(task),
        box_(model.getUnknown(), task.searched, task.starts.front().point),
        misfit_(simulator, model, box_, task.features, task.prior.get()) {
    best_.point = task.starts.front().point;
  }

  Refined run() {
    if (tryConfirmation()) {
      return finish();
    }
    for (const RefinementStart& start : task_.starts) {
      if (tryWhole(box_.normalize(start.point), start.name) ||
          (task_.uses_growing_windows && tryGrowing(start))) {
        break;
      }
    }
    return finish();
  }

 private:
  /// True if the map's answer led to one that is accepted, at the least cost.
  bool tryConfirmation() {
    if (task_.covariance.size() == 0 || !model_.getWhole().whitener) {
      return false;
    }
    const RefinementStart& start = task_.starts.front();
    const auto end = confirm(misfit_, box_.normalize(start.point), task_.covariance);
    if (end) {
      iterations_ += end->iterations;
      best_ = describe(*end, start.name);
      best_.status = RefinementStatus::kAccepted;
      setCovariance(calcCovariance(*end), best_);
      if (hasFlatDirection(end->local)) {
        setRidge(traceRidge(misfit_, end->local), best_);
      }
    }
    return end.has_value();
  }

  /// Searches all features from a point; true if no further start is needed.
  bool tryWhole(const VectorXd& start, const std::string& name) {
    misfit_.setWindow(model_.getWhole());
    SearchEnd end = searchWhole(misfit_, start);
    Refined found = judge(misfit_, end, name);
    if (!found.isAccepted() && liesNear(end) && preparePrecise()) {
      end = searchWhole(*precise_misfit_, end.local.at);
      found = judge(*precise_misfit_, end, name + ", precisely");
      addIntegrationError(end, found);
    }
    if (isBetter(found)) {
      best_ = found;
    }
    return found.isAccepted() || found.status == RefinementStatus::kNonlinear;
  }

  /// Renews a noise that depends on the response once, where the search ended.
  SearchEnd searchWhole(Misfit& misfit, const VectorXd& start) {
    SearchEnd end = search(misfit, start);
    iterations_ += end.iterations;
    if (end.converged && !model_.getWhole().whitener) {
      misfit.renewNoise();
      end = search(misfit, end.local.at);
      iterations_ += end.iterations;
    }
    return end;
  }

  /// Fits more and more of the response, each from the last one's answer. A chaotic response has many minima.
  /// Its beginning has few, which lie where the next ones do.
  bool tryGrowing(const RefinementStart& start) {
    if (model_.getWindows().size() == 1) {
      return false;
    }
    VectorXd at = box_.normalize(start.point);
    for (std::size_t i = 0; i + 1 < model_.getWindows().size(); ++i) {
      misfit_.setWindow(model_.getWindows()[i]);
      const SearchEnd end = search(misfit_, at);
      iterations_ += end.iterations;
      if (end.local.status.ok) {
        at = end.local.at;
      }
    }
    return tryWhole(at, start.name + ", growing window");
  }

  /// Whether a search may have been stopped by the errors of the integration: they make the misfit rough by a
  /// few units, so that it ends a little above what noise explains.
  static bool liesNear(const SearchEnd& end) {
    constexpr double kTimes = 3.0;
    return end.local.status.ok && end.local.chi_square < kTimes * calcChiSquareLimit(end.local);
  }

  bool preparePrecise() {
    if (!precise_) {
      precise_ = simulator_.clonePrecisely();
      if (precise_) {
        precise_misfit_.emplace(*precise_, model_, box_, task_.features, task_.prior.get());
      }
    }
    return precise_ != nullptr;
  }

  Refined describe(const SearchEnd& end, const std::string& name) const {
    Refined found;
    found.start = name;
    found.message = end.message;
    if (end.local.status.ok) {
      found.point = box_.makePoint(end.local.at);
      found.chi_square = end.local.chi_square;
      found.degrees = end.local.calcDegrees();
      found.residual = model_.placeResidual(end.local.residual);
      found.explained = end.local.chi_square < calcChiSquareLimit(end.local);
      const VectorXd way = end.local.at - box_.normalize(task_.starts.front().point);
      found.distance = std::sqrt(way.dot(end.local.calcHessian() * way));
    }
    return found;
  }

  Refined judge(Misfit& misfit, const SearchEnd& end, const std::string& name) const {
    Refined found = describe(end, name);
    if (!end.converged) {
      return found;
    }
    const std::optional<RidgeTrace> ridge = found.explained ? traceRidge(misfit, end.local) : std::nullopt;
    const Acceptance acceptance = testMinimum(misfit, end.local, ridge.has_value());
    found.status = acceptance.status;
    found.message = acceptance.message;
    if (found.isAccepted()) {
      setCovariance(calcCovariance(end), found);
      setRidge(ridge, found);
    }
    return found;
  }

  /// With the step that was not taken.
  static MatrixXd calcCovariance(const SearchEnd& end) {
    return end.local.calcCovariance() + end.rest * end.rest.transpose();
  }

  void setCovariance(const MatrixXd& covariance, Refined& found) const {
    const VectorXd& scale = box_.getHalfWidths();
    found.covariance = scale.asDiagonal() * covariance * scale.asDiagonal();
    found.stddev = found.covariance.diagonal().cwiseSqrt();
    found.mean = found.point.segment(box_.getSearched().first, box_.getSearched().count);
  }

  /// What is known along a ridge instead of the covariance, which is that of its linear model.
  void setRidge(const std::optional<RidgeTrace>& trace, Refined& found) const {
    if (!trace) {
      return;
    }
    const SearchedParameters& searched = box_.getSearched();
    const VectorXd& scale = box_.getHalfWidths();
    const VectorXd center =
        box_.makePoint(VectorXd::Zero(scale.size())).segment(searched.first, searched.count);
    found.mean = center + scale.cwiseProduct(trace->mean);
    found.stddev = scale.cwiseProduct(trace->stddev);
    found.interval_factors = trace->factors;
    found.ridge = trace->pieces;
    convert(center, scale, VectorXd::Ones(scale.size()), found.ridge);
  }

  /// What the usual tolerance would move the answer by counts as uncertainty: whoever compares with
  /// simulations of that tolerance, such as test samples, meets it. Cost: one simulation with derivatives.
  void addIntegrationError(const SearchEnd& end, Refined& found) {
    if (!found.isAccepted()) {
      return;
    }
    const LocalMisfit usual = misfit_.linearize(end.local.at);
    MatrixXd covariance = calcCovariance(end);
    if (usual.status.ok) {
      const VectorXd moved = end.local.calcCovariance() * (usual.descent - end.local.descent);
      covariance += moved * moved.transpose();
    }
    const VectorXd mean = found.mean, stddev = found.stddev;
    setCovariance(covariance, found);
    if (found.ridge.isGiven()) {  // along it the box decides
      found.mean = mean;
      found.stddev = found.stddev.cwiseMax(stddev);
    }
  }

  /// Accepted before nonlinear before the rest, of which the least chi-square is kept.
  bool isBetter(const Refined& found) const {
    const auto rank = [](const Refined& refined) {
      return refined.isAccepted()                             ? 3
             : refined.status == RefinementStatus::kNonlinear ? 2
             : refined.point.size() > 0                       ? 1
                                                              : 0;
    };
    if (best_.start.empty() || rank(found) != rank(best_)) {
      return best_.start.empty() || rank(found) > rank(best_);
    }
    return found.chi_square < best_.chi_square;
  }

  Refined finish() {
    best_.iterations = iterations_;
    best_.simulations = misfit_.getSimulations() + (precise_misfit_ ? precise_misfit_->getSimulations() : 0);
    if (best_.point.size() == 0) {
      best_.point = task_.starts.front().point;
    }
    return best_;
  }

  Simulator& simulator_;
  const RefinementModel& model_;
  const RefinementTask& task_;
  const SearchBox box_;
  Misfit misfit_;
  std::unique_ptr<Simulator> precise_;  // made when first needed
  std::optional<Misfit> precise_misfit_;
  Refined best_;
  int iterations_ = 0;
};

}  // namespace

Refined refine(Simulator& simulator, const RefinementModel& model, const RefinementTask& task) {
  if (task.starts.empty()) {
    throw std::invalid_argument("a refinement needs a start");
  }
  return Refinement(simulator, model, task).run();
}

std::vector<Refined> refineAll(const Simulator& prototype, const RefinementModel& model,
                               const std::vector<RefinementTask>& tasks, int threads,
                               const std::function<void()>& before_each) {
  std::vector<Refined> refined(tasks.size());
  runOnTeam(prototype, static_cast<int>(tasks.size()), threads, [&](Simulator& simulator, int i) {
    if (before_each) {
      before_each();
    }
    refined[static_cast<std::size_t>(i)] = refine(simulator, model, tasks[static_cast<std::size_t>(i)]);
  });
  return refined;
}

std::vector<Refined> refineOrAbortEarly(const Simulator& prototype, const RefinementModel& model,
                                        const std::vector<RefinementTask>& tasks, int threads,
                                        const std::function<void()>& before_each) {
  constexpr std::ptrdiff_t kFirst = 16;
  const auto middle = tasks.begin() + std::min(kFirst, static_cast<std::ptrdiff_t>(tasks.size()));
  std::vector<Refined> refined = refineAll(prototype, model, {tasks.begin(), middle}, threads, before_each);
  const std::vector<RefinementTask> others(middle, tasks.end());
  if (std::any_of(refined.begin(), refined.end(), [](const Refined& one) { return one.isAccepted(); })) {
    const std::vector<Refined> more = refineAll(prototype, model, others, threads, before_each);
    refined.insert(refined.end(), more.begin(), more.end());
    return refined;
  }
  for (const RefinementTask& task : others) {
    Refined untried;
    untried.message = fmt::format("not tried: none of the first {} was accepted", kFirst);
    untried.point = task.starts.front().point;
    refined.push_back(untried);
  }
  return refined;
}

}  // namespace twinmap
