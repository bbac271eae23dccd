#include "framework/optimal_design/design_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/experiment/points/point_set.hpp"

namespace twinmap::experiment_design {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using optimization::ConstrainedMethod;

constexpr double kMargin = 0.005;
constexpr double kFailedCost = 20.0;  // log units above the present: worse than any, yet finite

}  // namespace

double calcViolation(const DesignScore& score, const VectorXd& most) {
  if (!score.failure.empty()) {
    return std::numeric_limits<double>::infinity();
  }
  return most.size() == 0 ? -std::numeric_limits<double>::infinity()
                          : (score.measures.array() / most.array() - 1.0).maxCoeff();
}

DesignSearch::DesignSearch(Judge judge, VectorXd most, const SearchOptions& options)
    : judge_(std::move(judge)), most_(std::move(most)), options_(options) {}

DesignScore DesignSearch::tryDesign(const VectorXd& point) {
  const auto known = std::find_if(path_.begin(), path_.end(),
                                  [&](const TriedDesign& tried) { return tried.point == point; });
  if (known != path_.end()) {
    return known->score;
  }
  path_.push_back({point, judge_(point)});
  return path_.back().score;
}

double DesignSearch::calcMerit(const TriedDesign& tried) const {
  constexpr double kPenalty =
      100.0;  // log units for breaking a limit by 100 %: designs far outside tell little
  const double violation = calcViolation(tried.score, most_);
  return std::isfinite(tried.score.cost) ? tried.score.cost + kPenalty * std::max(0.0, violation)
                                         : std::numeric_limits<double>::infinity();
}

void DesignSearch::screen(const VectorXd& present, int count) {
  tryDesign(present);
  const PointSetSpec sobol{DesignMethod::kSobol, count, {}};
  const Eigen::MatrixXd points =
      sampleUnitCube(sobol, static_cast<int>(present.size()), options_.seed, RandomPurpose::kDesignStarts);
  for (Index i = 0; i < points.cols(); ++i) {
    tryDesign(points.col(i));
  }
}

VectorXd DesignSearch::calcTargets() const {
  VectorXd targets = most_;
  for (Index i = 0; i < targets.size(); ++i) {
    const double first = path_.front().score.measures[i];
    const bool moves = std::any_of(path_.begin(), path_.end(), [&](const TriedDesign& tried) {
      return tried.score.failure.empty() && tried.score.measures[i] != first;
    });
    targets[i] *= moves ? 1.0 - kMargin : 1.0;
  }
  return targets;
}

std::vector<VectorXd> DesignSearch::findStarts(std::size_t count) const {
  std::vector<const TriedDesign*> sorted;
  for (const TriedDesign& tried : path_) {
    sorted.push_back(&tried);
  }
  std::stable_sort(sorted.begin(), sorted.end(), [this](const TriedDesign* a, const TriedDesign* b) {
    return calcMerit(*a) < calcMerit(*b);
  });
  std::vector<VectorXd> starts;
  for (const TriedDesign* tried : sorted) {
    if (starts.size() < count) {
      starts.push_back(tried->point);
    }
  }
  return starts;
}

void DesignSearch::search(const VectorXd& start, ConstrainedMethod method, double first_step, int budget) {
  const double failed =
      path_.front().score.failure.empty() ? path_.front().score.cost + kFailedCost : kFailedCost;
  const VectorXd most = calcTargets();
  const optimization::ConstrainedProblem problem{
      start.size(), most.size(), [&](const VectorXd& point, VectorXd& constraints) {
        const DesignScore score = tryDesign(point);
        constraints = score.failure.empty() ? VectorXd(score.measures.array() / most.array() - 1.0)
                                            : VectorXd::Ones(most.size());
        return std::isfinite(score.cost) ? score.cost : failed;
      }};
  optimization::ConstrainedLimits limits;
  limits.max_evaluations = std::max(1, budget);
  limits.first_step = first_step;
  limits.seed = options_.seed;
  optimization::searchConstrained(problem, method, start, limits);
}

void DesignSearch::searchFrom(const VectorXd& start, double first_step, int budget) {
  const std::size_t before = path_.size();
  search(start, ConstrainedMethod::kLinear, first_step, budget / 2);
  const int left = budget - static_cast<int>(path_.size() - before);
  search(findStarts(1).front(), ConstrainedMethod::kQuadratic, first_step, left);
}

void DesignSearch::run(const VectorXd& present) {
  constexpr double kScreened = 0.2, kGlobalShare = 0.3, kStartShare = 0.2;
  constexpr double kFirstStep = 0.15, kLastStep = 0.03;
  constexpr std::size_t kStarts = 3;
  const int budget = options_.budget;
  screen(present, std::max(1, static_cast<int>(kScreened * budget) - 1));
  if (options_.global) {
    search(findStarts(1).front(), ConstrainedMethod::kGlobal, kFirstStep,
           static_cast<int>(kGlobalShare * budget));
  }
  const int left = budget - static_cast<int>(path_.size());
  for (const VectorXd& start : findStarts(kStarts)) {
    searchFrom(start, kFirstStep, static_cast<int>(kStartShare * left));
  }
  const TriedDesign* best = findBest();
  searchFrom(best != nullptr ? VectorXd(best->point) : findStarts(1).front(), kLastStep,
             std::max(2, budget - static_cast<int>(path_.size())));
}

void DesignSearch::refine(const VectorXd& most, int budget) {
  constexpr double kStep = 0.02;
  most_ = most;
  searchFrom(findStarts(1).front(), kStep, budget);
}

const TriedDesign* DesignSearch::findBest() const {
  const TriedDesign* best = nullptr;
  for (const TriedDesign& tried : path_) {
    const bool allowed = std::isfinite(tried.score.cost) && calcViolation(tried.score, most_) <= 0.0;
    if (allowed && (best == nullptr || tried.score.cost < best->score.cost)) {
      best = &tried;
    }
  }
  return best;
}

const TriedDesign& DesignSearch::findLeastViolation() const {
  return *std::min_element(path_.begin(), path_.end(), [this](const TriedDesign& a, const TriedDesign& b) {
    return calcViolation(a.score, most_) < calcViolation(b.score, most_);
  });
}

}  // namespace twinmap::experiment_design
