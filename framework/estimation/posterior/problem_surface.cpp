#include "framework/estimation/posterior/problem_surface.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<MeasuredPart> ProblemSurface::makeParts(const PosteriorProblem& problem) {
  std::vector<MeasuredPart> parts;
  for (const MeasuredTrial& trial : problem.trials) {
    if (trial.make_misfit) {
      others_.push_back(trial.make_misfit());
      parts.push_back({others_.back().get(), nullptr, trial.unknown});
      continue;
    }
    parts_.push_back(std::make_unique<TrialMisfit>(trial));
    parts.push_back(
        {&parts_.back()->misfit, trial.model, trial.unknown, makeLosses(trial.noise, *trial.model)});
  }
  return parts;
}

std::vector<Basin> convertBasins(const std::vector<Basin>& basins, const MisfitSurface& from,
                                 const MisfitSurface& surface) {
  std::vector<LocalSurface> ends;
  std::transform(basins.begin(), basins.end(), std::back_inserter(ends),
                 [&](const Basin& basin) { return surface.convert(basin.local, from); });
  return collectBasins(std::move(ends));
}

MatrixXd addShownStart(const PosteriorProblem& problem, const MatrixXd& given) {
  VectorXd start = given.cols() > 0 ? VectorXd(given.rightCols(1)) : calcBoxCenter(problem.unknown);
  bool is_shown = false;
  for (const MeasuredTrial& trial : problem.trials) {
    for (Index i = 0; i < trial.shown.size(); ++i) {
      if (std::isfinite(trial.shown[i])) {
        start[trial.unknown[static_cast<std::size_t>(i)]] = trial.shown[i];
        is_shown = true;
      }
    }
  }
  if (!is_shown) {
    return given;
  }
  MatrixXd starts(start.size(), given.cols() + 1);
  if (given.cols() > 0) {  // else it may have no rows either
    starts.leftCols(given.cols()) = given;
  }
  starts.rightCols(1) = start;
  return starts;
}

bool mayRunSideBySide(const PosteriorProblem& problem) {
  std::set<const Simulator*> simulators;
  for (const MeasuredTrial& trial : problem.trials) {
    simulators.insert(trial.simulator);
  }
  return static_cast<Index>(problem.unknown.size()) > kManyUnknown &&
         simulators.size() == problem.trials.size();
}

}  // namespace twinmap
