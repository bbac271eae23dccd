#include "framework/estimation/posterior/draws/response_curvature.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kAxisStep = 0.5;    // standard deviations: what bends within the posterior, not at a point
constexpr double kLeastRoom = 0.05;  // of a standard deviation: a prior's bound, where it hardly goes
/// Of the longest axis: two shorter ones bend by a hundredth of what it does, and what one bends with a
/// longer one is seen along that.
constexpr double kShortest = 0.1;

/// How far (in standard deviations, signed) a point may go along each axis within the bounds; 0: not.
VectorXd chooseSteps(const VectorXd& at, const MatrixXd& axes) {
  const auto findRoom = [&](const VectorXd& axis) {
    double room = kAxisStep;
    for (Index i = 0; i < at.size(); ++i) {
      if (axis[i] != 0.0) {
        room = std::min(room, ((axis[i] > 0.0 ? 1.0 : -1.0) - at[i]) / axis[i]);
      }
    }
    return room;
  };
  const double least = kShortest * axes.colwise().norm().maxCoeff();
  return VectorXd::NullaryExpr(at.size(), [&](Index k) {
    if (axes.col(k).norm() < least) {
      return 0.0;
    }
    const double up = findRoom(axes.col(k)), down = findRoom(-axes.col(k));
    const double step = up >= down ? up : -down;
    return std::abs(step) < kLeastRoom ? 0.0 : step;
  });
}

/// The residual (m) of all parts and its negative derivatives along the axes (m x u) at each of the points.
struct LinearResponse {
  VectorXd residual;
  MatrixXd jacobian;
};

std::vector<LinearResponse> linearizeResponses(MisfitSurface& surface, const MatrixXd& points,
                                               const MatrixXd& axes) {
  const LogCoordinates& coordinates = surface.getCoordinates();
  const auto count = static_cast<std::size_t>(points.cols());
  const MatrixXd box = surface.toBox(points);
  std::vector<LinearResponse> responses(count, {VectorXd(0), MatrixXd(0, axes.cols())});
  const std::vector<std::vector<LocalMisfit>> locals = surface.linearizeEach(box);
  for (std::size_t k = 0; k < locals.size(); ++k) {
    const MeasuredPart& part = surface.getParts()[k];
    const std::vector<LocalMisfit>& local = locals[k];
    for (std::size_t i = 0; i < count; ++i) {
      if (!local[i].status.ok || !local[i].jacobian.allFinite()) {
        return {};
      }
      const MatrixXd of_box = coordinates.calcSlopes(points.col(static_cast<Index>(i))).asDiagonal() * axes;
      const MatrixXd own_axes = of_box(part.unknown, Eigen::all);
      LinearResponse& all = responses[i];
      const Index before = all.residual.size(), rows = local[i].residual.size();
      all.residual.conservativeResize(before + rows);
      all.residual.tail(rows) = local[i].residual;
      MatrixXd jacobian(before + rows, axes.cols());
      jacobian << all.jacobian, local[i].jacobian * own_axes;
      all.jacobian = std::move(jacobian);
    }
  }
  return responses;
}

/// Columns for all pairs j <= k of sum_jk H_jk z_j z_k / 2, with H_jk the mean of what both axes say, or of
/// one where the other has no step.
MatrixXd pairBends(const std::vector<MatrixXd>& along, const VectorXd& steps, Index rows) {
  const Index u = steps.size();
  MatrixXd bends(rows, u * (u + 1) / 2);
  Index place = 0;
  for (Index j = 0; j < u; ++j) {
    for (Index k = j; k < u; ++k, ++place) {
      const MatrixXd &of_j = along[static_cast<std::size_t>(j)], &of_k = along[static_cast<std::size_t>(k)];
      if (j == k) {
        bends.col(place) = 0.5 * of_j.col(j);
      } else if (steps[j] == 0.0 || steps[k] == 0.0) {
        bends.col(place) = of_j.col(k) + of_k.col(j);  // one of them is 0
      } else {
        bends.col(place) = 0.5 * (of_j.col(k) + of_k.col(j));
      }
    }
  }
  return bends;
}

/// Orthonormal columns that hold nearly all of the given ones, by Gram and Schmidt's method, the largest of
/// what is left first. Cost: three products with them a column.
MatrixXd findDirections(MatrixXd left) {
  constexpr double kNegligible = 1e-5;  // of the sum of squares
  const double enough = kNegligible * left.squaredNorm();
  MatrixXd directions(left.rows(), 0);
  VectorXd sizes = left.colwise().squaredNorm();
  while (sizes.sum() > enough && directions.cols() < left.cols()) {
    Index largest = 0;
    sizes.maxCoeff(&largest);
    const VectorXd direction = left.col(largest).normalized();
    left -= direction * (direction.transpose() * left);
    sizes = left.colwise().squaredNorm();
    directions.conservativeResize(left.rows(), directions.cols() + 1);
    directions.rightCols(1) = direction;
  }
  return directions;
}

}  // namespace

std::optional<ResponseCurvature> ResponseCurvature::measure(MisfitSurface& surface, const Basin& basin) {
  if (std::any_of(surface.getParts().begin(), surface.getParts().end(),
                  [](const MeasuredPart& part) { return !part.losses.empty(); })) {
    return {};
  }
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(basin.covariance);
  const MatrixXd axes =
      eigen.vectors * eigen.values.cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().asDiagonal();
  const VectorXd steps = chooseSteps(basin.local.at, axes);
  const Index u = steps.size();
  std::vector<Index> moved;
  for (Index k = 0; k < u; ++k) {
    if (steps[k] != 0.0) {
      moved.push_back(k);
    }
  }
  MatrixXd points = basin.local.at.replicate(1, 1 + static_cast<Index>(moved.size()));
  points.rightCols(static_cast<Index>(moved.size())) += axes(Eigen::all, moved) * steps(moved).asDiagonal();
  const std::vector<LinearResponse> responses = linearizeResponses(surface, points, axes);
  if (responses.empty()) {
    return {};
  }
  const LinearResponse& center = responses.front();
  std::vector<MatrixXd> along(static_cast<std::size_t>(u), MatrixXd::Zero(center.jacobian.rows(), u));
  for (std::size_t i = 0; i < moved.size(); ++i) {
    along[static_cast<std::size_t>(moved[i])] =
        (responses[i + 1].jacobian - center.jacobian) / steps[moved[i]];
  }
  ResponseCurvature curvature(basin.local.at, axes);
  curvature.reduce(center.residual, center.jacobian, pairBends(along, steps, center.residual.size()));
  return curvature;
}

ResponseCurvature::ResponseCurvature(const VectorXd& at, const MatrixXd& axes)
    : at_(at), to_axes_(axes.cwiseAbs2().colwise().sum().cwiseInverse().asDiagonal() * axes.transpose()) {}

void ResponseCurvature::reduce(const VectorXd& residual, const MatrixXd& jacobian, const MatrixXd& bends) {
  const MatrixXd directions = findDirections(bends);
  std::vector<Index> bent;
  Index column = 0;
  for (Index j = 0; j < at_.size(); ++j) {
    for (Index k = j; k < at_.size(); ++k, ++column) {
      if (!bends.col(column).isZero(0.0)) {
        bent.push_back(column);
        pairs_.emplace_back(j, k);
      }
    }
  }
  bends_ = directions.transpose() * bends(Eigen::all, bent);
  jacobian_ = directions.transpose() * jacobian;
  residual_ = directions.transpose() * residual;
}

VectorXd ResponseCurvature::multiplyPairs(const VectorXd& z) const {
  VectorXd products(bends_.cols());
  for (Index i = 0; i < products.size(); ++i) {
    const auto& [j, k] = pairs_[static_cast<std::size_t>(i)];
    products[i] = z[j] * z[k];
  }
  return products;
}

double ResponseCurvature::calcBend(const VectorXd& point) const {
  const VectorXd z = to_axes_ * (point - at_);
  const VectorXd bend = bends_ * multiplyPairs(z);
  return 0.5 * bend.squaredNorm() - bend.dot(residual_ - jacobian_ * z);
}

VectorXd ResponseCurvature::calcBendSlope(const VectorXd& point) const {
  const VectorXd z = to_axes_ * (point - at_);
  const VectorXd bend = bends_ * multiplyPairs(z);
  const VectorXd by_pair = bends_.transpose() * (bend - residual_ + jacobian_ * z);
  VectorXd slope = jacobian_.transpose() * bend;
  for (Index i = 0; i < by_pair.size(); ++i) {
    const auto& [j, k] = pairs_[static_cast<std::size_t>(i)];
    slope[j] += by_pair[i] * z[k];
    slope[k] += by_pair[i] * z[j];
  }
  return to_axes_.transpose() * slope;
}

}  // namespace twinmap
