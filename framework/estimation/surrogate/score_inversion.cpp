#include "framework/estimation/surrogate/score_inversion.hpp"

#include <algorithm>

#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/packed_lower.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::VectorXd;

namespace {

int toInt(Index index) {
  return static_cast<int>(index);
}

VectorXd copy(const double* numbers, int count) {
  return Map<const VectorXd>(numbers, count);
}

}  // namespace

MatrixXd ScoreExplanation::calcCovariance() const {
  return linalg::invertPositiveDefinite(jacobian.transpose() * jacobian + prior);
}

VectorXd ScoreExplanation::whiten(VectorXd scores) const {
  exact::solveColumns(toInt(scores.size()), lower.data(), scores.data());
  return scores;
}

ScoreInversion::ScoreInversion(const ForwardSurrogate& surrogate, BoxPrior prior)
    : surrogate_(surrogate),
      prior_(std::move(prior)),
      rough_weights_(calcRoughWeights(surrogate).matrix()),
      correlation_(linalg::packColumns(surrogate.error_correlation)),
      leading_(findLeadingScores(surrogate, prior_.count())),
      workspaces_(surrogate.windows.size()) {
  const exact::score_problem problem = describeProblem();
  const int count = exact::countSearch(problem.scores, problem.unknown, problem.variables, problem.windows);
  room_.resize(static_cast<std::size_t>(count));
  explanation_.prior = prior_.calcInformation();
}

exact::score_problem ScoreInversion::describeProblem() const {
  const auto w = static_cast<Index>(leading_.windows.size());
  return {toInt(surrogate_.getScoreCount()),
          toInt(prior_.count()),
          toInt(surrogate_.points.rows()),
          toInt(w),
          toInt(surrogate_.points.cols()),
          leading_.windows.data(),
          rough_weights_.data(),
          leading_.weights.data(),
          correlation_.data(),
          prior_.mean.data(),
          prior_.relative.data(),
          surrogate_.points.data(),
          surrogate_.scores.data(),
          evaluate,
          calcStddev};
}

void ScoreInversion::evaluate(const exact::score_search* search, int window, int count) {
  auto& self = *static_cast<ScoreInversion*>(search->owner);
  const exact::score_problem& problem = *search->problem;
  const auto w = static_cast<std::size_t>(window);
  const int first = problem.window[w].first;
  Map<MatrixXd> jacobian(search->jacobian, problem.scores, problem.unknown);
  self.surrogate_.windows[w].linearize(Map<const VectorXd>(search->at, problem.variables),
                                       Map<VectorXd>(search->values + first, count),
                                       jacobian.middleRows(first, count), self.workspaces_[w]);
}

void ScoreInversion::calcStddev(const exact::score_search* search, int window) {
  auto& self = *static_cast<ScoreInversion*>(search->owner);
  const auto w = static_cast<std::size_t>(window);
  const exact::score_window& scores = search->problem->window[w];
  self.surrogate_.windows[w].calcStddev(Map<VectorXd>(search->stddev + scores.first, scores.functions),
                                        self.workspaces_[w]);
}

exact::score_search ScoreInversion::beginSearch(const exact::score_problem& problem,
                                                const Ref<const VectorXd>& scores,
                                                const Ref<const VectorXd>& known) {
  const exact::score_search search = exact::layOutSearch(problem, this, room_.data());
  std::copy_n(scores.data(), scores.size(), search.scores);
  std::copy_n(known.data(), known.size(), search.at + problem.unknown);
  return search;
}

std::vector<ScoreInversion::Refined> ScoreInversion::refine(exact::score_search& search, bool may_widen) {
  const int r = search.problem->scores, u = search.problem->unknown;
  std::vector<Refined> refined;
  for (int i = 0; i < search.minimum_count; ++i) {
    exact::refineMinimum(search, i, may_widen);
    refined.push_back({copy(search.lower, r * (r + 1) / 2),
                       Map<const MatrixXd>(search.scaled_jacobian, r, u),
                       {search.widening, search.widening + search.problem->windows}});
  }
  return refined;
}

void ScoreInversion::keepExplanation(const exact::score_search& search, int index, Refined& refined) {
  const exact::score_problem& problem = *search.problem;
  explanation_.point = copy(search.at, problem.variables);
  explanation_.point.head(problem.unknown) = copy(search.minima[index].point, problem.unknown);
  explanation_.innovation = copy(search.minima[index].innovation, problem.scores);
  explanation_.lower = std::move(refined.lower);
  explanation_.jacobian = std::move(refined.jacobian);
}

void ScoreInversion::keepModes(const exact::score_search& search, std::vector<Refined>& refined) {
  const int u = search.problem->unknown;
  modes_.clear();
  for (int i = 0; i < search.minimum_count; ++i) {
    if (const exact::score_minimum& minimum = search.minima[i]; search.share[i] > 0.0) {
      modes_.push_back({search.share[i],
                        {copy(minimum.mean, u), Map<const MatrixXd>(minimum.covariance, u, u)},
                        std::move(refined[static_cast<std::size_t>(i)].widening)});
    }
  }
  std::stable_sort(modes_.begin(), modes_.end(),
                   [](const ScoreMode& a, const ScoreMode& b) { return a.share > b.share; });
}

gp::Moments ScoreInversion::infer(const Ref<const VectorXd>& scores, const Ref<const VectorXd>& known) {
  const exact::score_problem problem = describeProblem();
  exact::score_search search = beginSearch(problem, scores, known);
  exact::searchFromSimulations(search);
  std::vector<Refined> refined = refine(search, true);
  const int best = exact::mixMinima(search, prior_.within.data(), prior_.shift.data());
  keepModes(search, refined);
  noise_stddev_ = copy(search.noise_stddev, problem.unknown);
  explained_ = search.minima[best].widened == 0;
  if (explained_) {
    keepExplanation(search, best, refined[static_cast<std::size_t>(best)]);
  }
  return {copy(search.mean, problem.unknown),
          Map<const MatrixXd>(search.covariance, problem.unknown, problem.unknown)};
}

const ScoreExplanation& ScoreInversion::explain(const Ref<const VectorXd>& scores,
                                                const Ref<const VectorXd>& known,
                                                const Ref<const VectorXd>& start) {
  const exact::score_problem problem = describeProblem();
  exact::score_search search = beginSearch(problem, scores, known);
  exact::searchFrom(search, start.data());
  std::vector<Refined> refined = refine(search, false);
  const int best = exact::findLeast(search);
  keepExplanation(search, best, refined[static_cast<std::size_t>(best)]);
  return explanation_;
}

}  // namespace twinmap
