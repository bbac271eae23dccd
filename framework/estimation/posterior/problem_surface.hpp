#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "framework/estimation/posterior/basins/basin_search.hpp"
#include "framework/estimation/posterior/posterior_problem.hpp"

namespace twinmap {

/// Points (u x n) of parameters in their units to coordinates, and back.
inline Eigen::MatrixXd toCoordinates(const LogCoordinates& coordinates, const Eigen::MatrixXd& points) {
  return mapColumns(points, [&](const Eigen::VectorXd& x) { return coordinates.fromParameters(x); });
}

inline Eigen::MatrixXd toParameters(const LogCoordinates& coordinates, const Eigen::MatrixXd& at) {
  return mapColumns(at, [&](const Eigen::VectorXd& v) { return coordinates.toParameters(v); });
}

/// The misfits of all measurements, and the surface that they make. plain: of LogCoordinates.
class ProblemSurface {
 public:
  explicit ProblemSurface(const PosteriorProblem& problem, const std::vector<Eigen::Index>& plain = {})
      : coordinates_(problem.unknown, plain),
        prior_(problem.unknown, problem.priors),
        surface_(makeParts(problem), coordinates_, prior_, mayRunSideBySide(problem)) {}

  MisfitSurface& upd() { return surface_; }
  const MisfitSurface& get() const { return surface_; }
  const LogCoordinates& getCoordinates() const { return coordinates_; }
  const Prior& getPrior() const { return prior_; }

 private:
  std::vector<MeasuredPart> makeParts(const PosteriorProblem& problem);

  const LogCoordinates coordinates_;
  const Prior prior_;
  std::vector<std::unique_ptr<TrialMisfit>> parts_;
  std::vector<std::unique_ptr<MeasuredMisfit>> others_;  // of trials that are not simulated whole
  MisfitSurface surface_;
};

/// The same basins in the coordinates of another surface of the same problem: those that are one there,
/// because a ridge is straight, once.
std::vector<Basin> convertBasins(const std::vector<Basin>& basins, const MisfitSurface& from,
                                 const MisfitSurface& surface);

}  // namespace twinmap
