#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/posterior/basins/basin_search.hpp"

namespace twinmap {

/// The posterior of some coordinates of a surface, the others integrated out by Laplace's approximation about
/// their best values given these: exact where the response is linear in the others, as it nearly is in
/// initial states, offsets and gains. So the number of draws that are needed does not grow with the number of
/// recordings, each of which has an unknown initial state of its own.
class MarginalSurface {
 public:
  /// kept: the coordinates that stay, ascending; basins: of the surface, which must outlive the object.
  MarginalSurface(MisfitSurface& surface, std::vector<Eigen::Index> kept, const std::vector<Basin>& basins);

  /// log of the posterior density (n) at points of the kept coordinates (k x n), but for a summand: -infinity
  /// outside the bounds and where a simulation fails. The others' best values are predicted by the linear
  /// model of the nearest basin, then improved by one Gauss-Newton step. Cost: two simulations with
  /// derivatives of each measurement and point.
  Eigen::VectorXd calcLogPosteriors(const Eigen::MatrixXd& points);

 private:
  /// A basin's linear model of the others' best values: at + slopes (kept - kept_at).
  struct Prediction {
    Eigen::VectorXd kept_at, other_at;
    Eigen::MatrixXd slopes;   ///< others x kept
    Eigen::MatrixXd inverse;  ///< of the kept coordinates' covariance
  };

  Eigen::VectorXd calcLogsWithin(const Eigen::MatrixXd& points);
  Eigen::VectorXd predict(const Eigen::VectorXd& kept) const;
  double integrate(const LocalSurface& local) const;

  MisfitSurface& surface_;
  std::vector<Eigen::Index> kept_, others_;
  std::vector<Prediction> predictions_;
};

}  // namespace twinmap
