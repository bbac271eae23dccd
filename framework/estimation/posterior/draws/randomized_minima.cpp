#include "framework/estimation/posterior/draws/randomized_minima.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/random/scrambled_sobol.hpp"
#include "framework/base/random/standard_normal.hpp"
#include "framework/estimation/box_points.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/estimation/posterior/draws/draw_channels.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/sampling/draw_rounds.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kAxisStep = 0.5;  // standard deviations: what bends within the posterior, not at a point
/// Of the longest axis: two shorter ones bend by a hundredth of what it does, and what one bends with a
/// longer one is seen along that.
constexpr double kShortest = 0.1;

/// How far (in standard deviations, signed) a point may go along each axis within the bounds; 0: not.
VectorXd chooseSteps(const VectorXd& at, const MatrixXd& axes) {
  const double least = kShortest * axes.colwise().norm().maxCoeff();
  return VectorXd::NullaryExpr(at.size(), [&](Index k) {
    if (axes.col(k).norm() < least) {
      return 0.0;
    }
    const double up = calcReach(at, axes.col(k), kAxisStep), down = calcReach(at, -axes.col(k), kAxisStep);
    const double step = up >= down ? up : -down;
    return std::abs(step) < kImmaterial ? 0.0 : step;
  });
}

/// Of each axis with a step, J' (J at the step - J) / step: negative derivatives of the residual of all parts
/// along the axes (u x u). Empty where one cannot be simulated.
std::vector<MatrixXd> measureBends(MisfitSurface& surface, const VectorXd& at, const MatrixXd& axes,
                                   const VectorXd& steps) {
  const Index u = at.size();
  std::vector<Index> moved;
  for (Index k = 0; k < u; ++k) {
    if (steps[k] != 0.0) {
      moved.push_back(k);
    }
  }
  MatrixXd points = at.replicate(1, 1 + static_cast<Index>(moved.size()));
  points.rightCols(static_cast<Index>(moved.size())) += axes(Eigen::all, moved) * steps(moved).asDiagonal();
  const std::vector<std::vector<LocalMisfit>> locals = surface.linearizeEach(surface.toBox(points));
  std::vector<MatrixXd> bends(static_cast<std::size_t>(u), MatrixXd::Zero(u, u));
  for (std::size_t part = 0; part < locals.size(); ++part) {
    MatrixXd center;
    for (std::size_t i = 0; i < locals[part].size(); ++i) {
      const LocalMisfit& local = locals[part][i];
      if (!local.status.ok || !local.jacobian.allFinite()) {
        return {};
      }
      const VectorXd slopes = surface.getCoordinates().calcSlopes(points.col(static_cast<Index>(i)));
      const MatrixXd of_box = slopes.asDiagonal() * axes;
      const MatrixXd jacobian = local.jacobian * of_box(surface.getParts()[part].unknown, Eigen::all);
      if (i == 0) {
        center = jacobian;
      } else {
        const Index k = moved[i - 1];
        bends[static_cast<std::size_t>(k)] += center.transpose() * (jacobian - center) / steps[k];
      }
    }
  }
  return bends;
}

}  // namespace

std::optional<RandomizedMinima> RandomizedMinima::measure(MisfitSurface& surface, const Basin& basin) {
  if (std::any_of(surface.getParts().begin(), surface.getParts().end(),
                  [](const MeasuredPart& part) { return !part.losses.empty(); })) {
    return {};
  }
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(basin.covariance);
  const MatrixXd axes =
      eigen.vectors * eigen.values.cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().asDiagonal();
  const VectorXd steps = chooseSteps(basin.local.at, axes);
  const std::vector<MatrixXd> bends = measureBends(surface, basin.local.at, axes, steps);
  if (bends.empty()) {
    return {};
  }
  RandomizedMinima minima(basin.local.at, axes, axes.transpose() * basin.local.descent);
  minima.pairBends(bends, steps);
  return minima;
}

void RandomizedMinima::pairBends(const std::vector<MatrixXd>& bends, const VectorXd& steps) {
  for (Index j = 0; j < steps.size(); ++j) {
    for (Index k = j; k < steps.size(); ++k) {
      const VectorXd both =
          bends[static_cast<std::size_t>(j)].col(k) + bends[static_cast<std::size_t>(k)].col(j);
      const bool seen_once = steps[j] == 0.0 || steps[k] == 0.0;  // the other one is 0
      const VectorXd mixed = seen_once ? both : VectorXd(0.5 * both);
      if (!mixed.isZero(0.0)) {
        pairs_.push_back({j, k, (j == k ? 0.5 : 1.0) * mixed});
      }
    }
  }
}

VectorXd RandomizedMinima::bend(const VectorXd& z) const {
  VectorXd bent = z;
  for (const Pair& pair : pairs_) {
    bent += z[pair.j] * z[pair.k] * pair.bend;
  }
  return bent;
}

MatrixXd RandomizedMinima::calcSlopes(const VectorXd& z) const {
  MatrixXd slopes = MatrixXd::Identity(z.size(), z.size());
  for (const Pair& pair : pairs_) {
    slopes.col(pair.j) += z[pair.k] * pair.bend;
    slopes.col(pair.k) += z[pair.j] * pair.bend;
  }
  return slopes;
}

std::optional<VectorXd> RandomizedMinima::solve(const VectorXd& wanted) const {
  constexpr int kMaxSteps = 50, kMaxHalvings = 20;
  VectorXd z = VectorXd::Zero(wanted.size()), missing = wanted;
  for (int step = 0; step < kMaxSteps; ++step) {
    if (missing.norm() < kSameNumber * (1.0 + wanted.norm())) {
      return z;
    }
    VectorXd move = linalg::solveLinear(calcSlopes(z), missing);
    VectorXd next = wanted - bend(z + move);
    for (int i = 0; i < kMaxHalvings && !(next.norm() < missing.norm()); ++i) {
      move *= 0.5;
      next = wanted - bend(z + move);
    }
    if (!(next.norm() < missing.norm())) {
      return {};
    }
    z += move;
    missing = next;
  }
  return {};
}

std::optional<RandomizedMinima::Draw> RandomizedMinima::draw(const VectorXd& normals) const {
  const std::optional<VectorXd> z = solve(offset_ + normals);
  if (!z) {
    return {};
  }
  const linalg::LogDeterminant volume = linalg::calcLogDeterminant(calcSlopes(*z));
  if (!(volume.sign > 0.0)) {
    return {};
  }
  return Draw{at_ + axes_ * *z, volume.log_size - 0.5 * normals.squaredNorm()};
}

importance::AdaptiveDraws sampleRandomizedMinima(MisfitSurface& surface, const RandomizedMinima& minima,
                                                 int draws, int most_rounds, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::kPosterior);
  const auto draw_round = [&](int round) {
    const MatrixXd normals = drawSobol(static_cast<int>(surface.getDimensions()), draws, random, kOfMinima,
                                       static_cast<std::uint64_t>(round))
                                 .unaryExpr(&toStandardNormal);
    MatrixXd points(surface.getDimensions(), draws);
    VectorXd log_densities(draws);
    Index found = 0;
    for (const auto& column : normals.colwise()) {
      if (const auto drawn = minima.draw(column)) {
        points.col(found) = drawn->point;
        log_densities[found++] = drawn->log_density;
      }
    }
    points.conservativeResize(Eigen::NoChange, found);
    return importance::Round{points, surface.calcLogPosteriors(points) - log_densities.head(found)};
  };
  return importance::drawInRounds(draw_round, most_rounds);
}

}  // namespace twinmap
