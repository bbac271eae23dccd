#include "framework/estimation/posterior/misfit_surface.hpp"

#include <limits>

#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd MisfitSurface::toBox(const MatrixXd& points) const {
  MatrixXd box(points.rows(), points.cols());
  for (Index i = 0; i < points.cols(); ++i) {
    box.col(i) = coordinates_.toBox(points.col(i));
  }
  return box;
}

std::vector<LocalSurface> MisfitSurface::linearize(const MatrixXd& points) {
  std::vector<LocalMisfit> local = misfit_.linearizeAll(toBox(points));
  std::vector<LocalSurface> surfaces(local.size());
  for (std::size_t i = 0; i < local.size(); ++i) {
    LocalSurface& surface = surfaces[i];
    surface.at = points.col(static_cast<Index>(i));
    surface.simulated = local[i].status.ok && std::isfinite(local[i].chi_square);
    if (!surface.simulated) {
      continue;
    }
    const VectorXd slopes = coordinates_.calcSlopes(surface.at);
    surface.chi_square = local[i].chi_square;
    surface.degrees = local[i].calcDegrees();
    surface.information = slopes.asDiagonal() * local[i].information * slopes.asDiagonal();
    // the misfit's descent holds the box as a normal distribution, too
    surface.residual = std::move(local[i].residual);
    surface.descent = slopes.cwiseProduct(local[i].descent + kHalfWidthInformation * local[i].at);
  }
  return surfaces;
}

VectorXd MisfitSurface::calcChiSquares(const MatrixXd& points) {
  const MatrixXd box = toBox(points);
  return misfit_.evaluate(box) - kHalfWidthInformation * box.colwise().squaredNorm().transpose();
}

VectorXd MisfitSurface::calcLogPosteriors(const MatrixXd& points) {
  std::vector<Index> inside;
  for (Index i = 0; i < points.cols(); ++i) {
    if (points.col(i).cwiseAbs().maxCoeff() <= 1.0) {
      inside.push_back(i);
    }
  }
  VectorXd logs = VectorXd::Constant(points.cols(), -std::numeric_limits<double>::infinity());
  if (!inside.empty()) {
    logs(inside) = -0.5 * calcChiSquares(points(Eigen::all, inside));
  }
  for (const Index i : inside) {
    logs[i] += coordinates_.calcLogUniform(points.col(i));
  }
  return logs;
}

}  // namespace twinmap
