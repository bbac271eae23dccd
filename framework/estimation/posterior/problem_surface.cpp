#include "framework/estimation/posterior/problem_surface.hpp"

#include <algorithm>

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;

MatrixXd toCoordinates(const LogCoordinates& coordinates, const MatrixXd& points) {
  MatrixXd at(points.rows(), points.cols());
  for (Index i = 0; i < points.cols(); ++i) {
    at.col(i) = coordinates.fromParameters(points.col(i));
  }
  return at;
}

MatrixXd toParameters(const LogCoordinates& coordinates, const MatrixXd& at) {
  MatrixXd points(at.rows(), at.cols());
  for (Index i = 0; i < at.cols(); ++i) {
    points.col(i) = coordinates.toParameters(at.col(i));
  }
  return points;
}

std::vector<MeasuredPart> ProblemSurface::makeParts(const PosteriorProblem& problem) {
  std::vector<MeasuredPart> parts;
  for (const MeasuredTrial& trial : problem.trials) {
    if (trial.segments) {
      segmented_.push_back(std::make_unique<SegmentedMisfit>(*trial.simulator, *trial.segments));
      parts.push_back({segmented_.back().get(), nullptr, trial.unknown});
      continue;
    }
    parts_.push_back(std::make_unique<Part>(trial));
    parts.push_back(
        {&parts_.back()->misfit, trial.model, trial.unknown, makeLosses(trial.noise, *trial.model)});
  }
  return parts;
}

std::vector<Basin> convertBasins(const std::vector<Basin>& basins, const LogCoordinates& coordinates,
                                 MisfitSurface& surface) {
  MatrixXd points(coordinates.getCount(), static_cast<Index>(basins.size()));
  for (std::size_t k = 0; k < basins.size(); ++k) {
    points.col(static_cast<Index>(k)) =
        surface.getCoordinates().fromParameters(coordinates.toParameters(basins[k].local.at));
  }
  std::vector<LocalSurface> ends = surface.linearize(points);
  const auto failed =
      std::remove_if(ends.begin(), ends.end(), [](const LocalSurface& end) { return !end.simulated; });
  ends.erase(failed, ends.end());
  return collectBasins(std::move(ends));
}

}  // namespace twinmap
