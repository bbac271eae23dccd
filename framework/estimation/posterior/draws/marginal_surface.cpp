#include "framework/estimation/posterior/draws/marginal_surface.hpp"

#include <algorithm>
#include <limits>

#include "framework/estimation/bounded_information.hpp"
#include "framework/estimation/box_points.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MarginalSurface::MarginalSurface(MisfitSurface& surface, std::vector<Index> kept,
                                 const std::vector<Basin>& basins)
    : surface_(surface), kept_(std::move(kept)) {
  for (Index j = 0; j < surface.getDimensions(); ++j) {
    if (!std::binary_search(kept_.begin(), kept_.end(), j)) {
      others_.push_back(j);
    }
  }
  for (const Basin& basin : basins) {
    const MatrixXd& information = basin.local.information;
    predictions_.push_back(
        {basin.local.at(kept_), basin.local.at(others_),
         -BoundedInformation(information(others_, others_)).solve(information(others_, kept_)),
         linalg::invertPositiveDefinite(basin.covariance(kept_, kept_))});
  }
}

VectorXd MarginalSurface::predict(const VectorXd& kept) const {
  const Prediction* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Prediction& prediction : predictions_) {
    const VectorXd apart = kept - prediction.kept_at;
    if (const double distance = apart.dot(prediction.inverse * apart); distance < least) {
      least = distance;
      nearest = &prediction;
    }
  }
  return clampToBox(nearest->other_at + nearest->slopes * (kept - nearest->kept_at));
}

double MarginalSurface::integrate(const LocalSurface& local) const {
  if (!local.simulated) {
    return -std::numeric_limits<double>::infinity();
  }
  const BoundedInformation information(local.information(others_, others_));
  const MatrixXd& lower = information.getLower();
  const double gain = linalg::solveLower(lower, local.descent(others_)).squaredNorm();
  return -0.5 * (local.loss - gain) - lower.diagonal().array().log().sum() + surface_.calcLogPrior(local.at);
}

VectorXd MarginalSurface::calcLogPosteriors(const MatrixXd& points) {
  return calcInBox(points, [&](const MatrixXd& inside) { return calcLogsWithin(inside); });
}

VectorXd MarginalSurface::calcLogsWithin(const MatrixXd& points) {
  MatrixXd whole(surface_.getDimensions(), points.cols());
  for (Index i = 0; i < whole.cols(); ++i) {
    whole(kept_, i) = points.col(i);
    whole(others_, i) = predict(points.col(i));
  }
  const std::vector<LocalSurface> predicted = surface_.linearize(whole);
  for (Index i = 0; i < whole.cols(); ++i) {
    const LocalSurface& local = predicted[static_cast<std::size_t>(i)];
    if (local.simulated) {
      const BoundedInformation information(local.information(others_, others_));
      whole(others_, i) = clampToBox(local.at(others_) + information.solve(local.descent(others_)));
    }
  }
  const std::vector<LocalSurface> improved = surface_.linearize(whole);
  return VectorXd::NullaryExpr(points.cols(),
                               [&](Index i) { return integrate(improved[static_cast<std::size_t>(i)]); });
}

}  // namespace twinmap
