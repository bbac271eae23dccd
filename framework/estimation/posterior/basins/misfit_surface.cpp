#include "framework/estimation/posterior/basins/misfit_surface.hpp"

#include <algorithm>

#include "framework/estimation/bounded_information.hpp"
#include "framework/estimation/box_points.hpp"
#include "framework/estimation/run_tasks.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/simulation/simulator_team.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Adds a part's linear model, in half-widths of the bounds, to the surface's. Its own descent holds the box
/// as a normal distribution, too.
void addPart(const LocalMisfit& local, const MeasuredPart& part, LocalSurface& surface) {
  surface.simulated = surface.simulated && local.status.ok && std::isfinite(local.chi_square);
  if (!surface.simulated) {
    return;
  }
  const Index before = surface.residual.size();
  surface.residual.conservativeResize(before + local.residual.size());
  surface.residual.tail(local.residual.size()) = local.residual;
  surface.residuals += local.residuals;
  surface.weights.conservativeResize(surface.residual.size());
  auto weights = surface.weights.tail(local.residual.size());
  if (part.losses.empty()) {
    weights.setOnes();
    surface.chi_square += local.chi_square;
    surface.loss += local.chi_square;
    surface.information(part.unknown, part.unknown) += local.information;
    surface.descent(part.unknown) += local.descent + kHalfWidthInformation * local.at;
    return;
  }
  const LinearLoss linear = part.losses[part.window].linearize(local.residual, local.jacobian);
  weights = linear.weights;
  surface.chi_square += linear.chi_square;
  surface.loss += linear.loss;
  surface.information(part.unknown, part.unknown) += linear.information;
  surface.descent(part.unknown) += linear.descent;
}

/// Of each of the points (u x n) of the part's own box.
VectorXd calcPartLosses(const MeasuredPart& part, const MatrixXd& own) {
  if (part.losses.empty()) {
    return part.misfit->evaluate(own) - kHalfWidthInformation * own.colwise().squaredNorm().transpose();
  }
  return part.misfit->sumUp(own, [&](const MatrixXd& residuals) {
    VectorXd losses(residuals.cols());
    for (Index i = 0; i < residuals.cols(); ++i) {
      losses[i] = part.losses[part.window].calc(residuals.col(i));
    }
    return losses;
  });
}

}  // namespace

int MisfitSurface::getSimulations() const {
  int simulations = 0;
  for (const MeasuredPart& part : parts_) {
    simulations += part.misfit->getSimulations();
  }
  return simulations;
}

std::size_t MisfitSurface::countWindows() const {
  std::size_t count = 0;
  for (const MeasuredPart& part : parts_) {
    count = std::max(count, part.model == nullptr ? 1 : part.model->getWindows().size());
  }
  return count;
}

void MisfitSurface::setWindow(std::size_t window) {
  sees_all_ = window + 1 >= countWindows();
  for (MeasuredPart& part : parts_) {
    if (part.model == nullptr) {
      continue;
    }
    const std::vector<GrowingWindow>& windows = part.model->getWindows();
    part.window = std::min(window, windows.size() - 1);
    part.misfit->setWindow(windows[part.window]);
  }
}

MatrixXd MisfitSurface::toBox(const MatrixXd& points) const {
  return mapColumns(points, [&](const VectorXd& at) { return coordinates_.toBox(at); });
}

void MisfitSurface::visitParts(const std::function<void(std::size_t part)>& visit) const {
  runTasks(side_by_side_ ? countThreads() : 1, parts_.size(), visit);
}

std::vector<std::vector<LocalMisfit>> MisfitSurface::linearizeEach(const MatrixXd& box) {
  std::vector<std::vector<LocalMisfit>> locals(parts_.size());
  visitParts(
      [&](std::size_t k) { locals[k] = parts_[k].misfit->linearizeAll(box(parts_[k].unknown, Eigen::all)); });
  return locals;
}

std::vector<LocalSurface> MisfitSurface::linearize(const MatrixXd& points) {
  const MatrixXd box = toBox(points);
  const Index u = points.rows();
  std::vector<LocalSurface> surfaces(static_cast<std::size_t>(points.cols()));
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    LocalSurface& surface = surfaces[i];
    surface.simulated = true;
    surface.at = points.col(static_cast<Index>(i));
    surface.information = MatrixXd::Zero(u, u);
    surface.descent = VectorXd::Zero(u);
  }
  const std::vector<std::vector<LocalMisfit>> locals = linearizeEach(box);
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      addPart(locals[k][i], parts_[k], surfaces[i]);
    }
  }
  for (LocalSurface& surface : surfaces) {
    if (surface.simulated) {
      surface.degrees = calcDegrees(surface.residuals, BoundedInformation(surface.information));
      const VectorXd slopes = coordinates_.calcSlopes(surface.at);
      surface.information = slopes.asDiagonal() * surface.information * slopes.asDiagonal();
      surface.descent = slopes.cwiseProduct(surface.descent);
      addPrior(surface);
    }
  }
  return surfaces;
}

LocalSurface MisfitSurface::convert(const LocalSurface& local, const MisfitSurface& from) const {
  LocalSurface converted = local;
  converted.at = coordinates_.fromParameters(from.coordinates_.toParameters(local.at));
  if (!prior_.isUniform()) {
    const PriorMisfit prior = from.linearizePrior(local.at);
    converted.information -= prior.information;
    converted.descent -= prior.descent;
  }
  const VectorXd slopes =
      coordinates_.calcSlopes(converted.at).cwiseQuotient(from.coordinates_.calcSlopes(local.at));
  converted.information = slopes.asDiagonal() * converted.information * slopes.asDiagonal();
  converted.descent = slopes.cwiseProduct(converted.descent);
  addPrior(converted);
  return converted;
}

void MisfitSurface::addPrior(LocalSurface& surface) const {
  surface.misfit = surface.loss;
  if (prior_.isUniform()) {
    return;
  }
  const PriorMisfit prior = linearizePrior(surface.at);
  surface.misfit += prior.misfit;
  surface.information += prior.information;
  surface.descent += prior.descent;
}

MatrixXd MisfitSurface::spreadAsPrior(const MatrixXd& points) const {
  return mapColumns(points, [&](const VectorXd& at) {
    return clampToBox(coordinates_.fromParameters(prior_.calcPoint(0.5 * (at.array() + 1.0))));
  });
}

PriorMisfit MisfitSurface::linearizePrior(const VectorXd& at) const {
  PriorMisfit prior = prior_.calcMisfit(coordinates_.toParameters(at));
  const VectorXd slopes = coordinates_.calcSlopes(at).cwiseProduct(coordinates_.getHalfWidths());
  prior.information = slopes.asDiagonal() * prior.information * slopes.asDiagonal();
  prior.descent = slopes.cwiseProduct(prior.descent);
  return prior;
}

VectorXd MisfitSurface::calcLosses(const MatrixXd& points) {
  const MatrixXd box = toBox(points);
  MatrixXd losses(points.cols(), static_cast<Index>(parts_.size()));
  visitParts([&](std::size_t k) {
    losses.col(static_cast<Index>(k)) = calcPartLosses(parts_[k], box(parts_[k].unknown, Eigen::all));
  });
  VectorXd sums = VectorXd::Zero(points.cols());
  for (const auto& of_part : losses.colwise()) {
    sums += of_part;
  }
  return sums;
}

VectorXd MisfitSurface::calcMisfits(const MatrixXd& points) {
  VectorXd misfits = calcLosses(points);
  for (Index i = 0; i < points.cols() && !prior_.isUniform(); ++i) {
    misfits[i] += prior_.calcMisfit(coordinates_.toParameters(points.col(i))).misfit;
  }
  return misfits;
}

VectorXd MisfitSurface::calcLogPosteriors(const MatrixXd& points) {
  return calcInBox(points, [&](const MatrixXd& inside) {
    VectorXd logs = -0.5 * calcLosses(inside);
    for (Index i = 0; i < logs.size(); ++i) {
      logs[i] += calcLogPrior(inside.col(i));
    }
    return logs;
  });
}

}  // namespace twinmap
