#include "framework/estimation/posterior/basins/valley.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/estimation/posterior/basins/search_team.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Index kWayPoints = 5;
constexpr double kBears = 25.0;  // chi-square above the best that still bears some of the posterior

/// A straight way whose points are to be corrected at right angles to it.
struct Way {
  VectorXd from, direction;     // u; direction has length 1
  std::vector<double> lengths;  // of the points along it
  double spacing = 0.0;
  std::size_t basin = 0, other = 0;  // the basins at its ends; the same where it leads out of one
};

/// The ends of a way are known; so are barriers that are higher than what the way's own points reach.
Way connect(const std::vector<Basin>& basins, std::size_t from, std::size_t to) {
  Way way;
  way.from = basins[from].local.at;
  const VectorXd apart = basins[to].local.at - way.from;
  const double length = apart.norm();
  way.direction = apart / length;
  way.spacing = length / static_cast<double>(kWayPoints + 1);
  for (Index k = 1; k <= kWayPoints; ++k) {
    way.lengths.push_back(static_cast<double>(k) * way.spacing);
  }
  way.basin = from;
  way.other = to;
  return way;
}

std::size_t findNearestBefore(const std::vector<Basin>& basins, std::size_t k) {
  const VectorXd& at = basins[k].local.at;
  const auto end = basins.begin() + static_cast<std::ptrdiff_t>(k);
  const auto nearest = std::min_element(basins.begin(), end, [&](const Basin& a, const Basin& b) {
    return (a.local.at - at).squaredNorm() < (b.local.at - at).squaredNorm();
  });
  return static_cast<std::size_t>(nearest - basins.begin());
}

/// Both ways along the flattest direction of a basin, as far as the bounds allow.
std::vector<Way> lead(const Basin& basin, std::size_t place) {
  constexpr double kReaches[] = {0.8, 1.6, 2.4};  // standard deviations
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(basin.covariance);
  const Index flattest = eigen.values.size() - 1;
  const double stddev = std::sqrt(eigen.values[flattest]);
  std::vector<Way> ways;
  for (const double side : {-1.0, 1.0}) {
    Way way;
    way.from = basin.local.at;
    way.direction = side * eigen.vectors.col(flattest);
    way.spacing = kReaches[0] * stddev;
    way.basin = way.other = place;
    for (const double reach : kReaches) {
      if ((way.from + reach * stddev * way.direction).cwiseAbs().maxCoeff() <= 1.0) {
        way.lengths.push_back(reach * stddev);
      }
    }
    ways.push_back(std::move(way));
  }
  return ways;
}

MatrixXd listPoints(const std::vector<Way>& ways, Index dimensions) {
  std::vector<VectorXd> points;
  for (const Way& way : ways) {
    for (const double length : way.lengths) {
      points.emplace_back((way.from + length * way.direction).cwiseMax(-1.0).cwiseMin(1.0));
    }
  }
  MatrixXd columns(dimensions, static_cast<Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    columns.col(static_cast<Index>(i)) = points[i];
  }
  return columns;
}

/// Ways out of basins whose straight line leaves the valley: chi-square is more than 4 above what the linear
/// model says.
std::vector<Way> listBent(MisfitSurface& surface, const std::vector<Basin>& basins) {
  constexpr double kNoticed = 4.0;
  std::vector<Way> ways;
  for (std::size_t k = 0; k < basins.size(); ++k) {
    for (Way& way : lead(basins[k], k)) {
      if (!way.lengths.empty()) {
        ways.push_back(std::move(way));
      }
    }
  }
  if (ways.empty()) {
    return {};
  }
  std::vector<Way> tests = ways;
  for (Way& test : tests) {
    test.lengths = {test.lengths.back()};
  }
  const VectorXd reached = surface.calcMisfits(listPoints(tests, surface.getDimensions()));
  std::vector<Way> bent;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const LocalSurface& local = basins[ways[i].basin].local;
    const VectorXd step = ways[i].lengths.back() * ways[i].direction;
    const double expected = local.misfit - 2.0 * step.dot(local.descent) + step.dot(local.information * step);
    if (reached[static_cast<Index>(i)] > expected + kNoticed) {
      bent.push_back(std::move(ways[i]));
    }
  }
  return bent;
}

/// A point of a floor as a basin that reaches as far along the way as the next point.
Basin makeFloor(const LocalSurface& local, const Way& way) {
  const MatrixXd information =
      local.information + way.direction * way.direction.transpose() / (way.spacing * way.spacing);
  return {local, calcBasinCovariance(information), 0};
}

}  // namespace

Valleys followValleys(MisfitSurface& surface, const std::vector<Basin>& basins) {
  constexpr int kIterations = 4;
  constexpr double kBarrier = 4.0;
  std::vector<Way> ways = listBent(surface, basins);
  for (std::size_t k = 1; k < basins.size(); ++k) {
    ways.push_back(connect(basins, findNearestBefore(basins, k), k));
  }
  Valleys valleys;
  const MatrixXd starts = listPoints(ways, surface.getDimensions());
  if (starts.cols() == 0) {
    return valleys;
  }
  MatrixXd held(starts.rows(), starts.cols());
  Index column = 0;
  for (const Way& way : ways) {
    for (std::size_t k = 0; k < way.lengths.size(); ++k) {
      held.col(column++) = way.direction;
    }
  }
  SearchTeam team(surface, starts, held);
  team.run(kIterations);
  const double limit = basins.front().local.misfit + kBears;
  column = 0;
  for (const Way& way : ways) {
    double highest = 0.0;
    for (std::size_t k = 0; k < way.lengths.size(); ++k) {
      const LocalSurface& local = team.getLocal(column++);
      highest = std::max(highest, local.simulated ? local.misfit : std::numeric_limits<double>::infinity());
      if (local.simulated && local.misfit < limit) {
        valleys.floors.push_back(makeFloor(local, way));
      }
    }
    const double ends = std::max(basins[way.basin].local.misfit, basins[way.other].local.misfit);
    if (way.basin != way.other && highest < ends + kBarrier) {
      valleys.connected.emplace_back(way.basin, way.other);
    }
  }
  return valleys;
}

}  // namespace twinmap
