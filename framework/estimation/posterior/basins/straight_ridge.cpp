#include "framework/estimation/posterior/basins/straight_ridge.hpp"

#include <algorithm>
#include <cmath>

#include "framework/estimation/box_points.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/surrogate/box_moments.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// A direction of a basin, one standard deviation long, and what a step of it costs elsewhere.
struct Bend {
  VectorXd direction;
  double cost = 0.0;    // of the step at the basin
  LocalSurface beyond;  // a standard deviation further on
};

/// The directions whose bend matters, both ways as far as the bounds allow.
std::vector<Bend> listBends(MisfitSurface& surface, const Basin& basin) {
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(basin.covariance);
  const Index flattest = eigen.values.size() - 1;
  std::vector<Bend> bends;
  MatrixXd points(basin.local.at.size(), 0);
  for (Index k = flattest; k >= 0; --k) {
    if (k < flattest && eigen.values[k] < 1.0 / (kFlatInformation + kHalfWidthInformation)) {
      break;
    }
    for (const double side : {-1.0, 1.0}) {
      const VectorXd direction = side * std::sqrt(eigen.values[k]) * eigen.vectors.col(k);
      const double reach = calcReach(basin.local.at, direction, 1.0);
      if (reach > 0.0) {
        points.conservativeResize(Eigen::NoChange, points.cols() + 1);
        points.rightCols(1) = basin.local.at + reach * direction;
        bends.push_back({direction, direction.dot(basin.local.information * direction), {}});
      }
    }
  }
  if (bends.empty()) {
    return bends;
  }
  std::vector<LocalSurface> reached = surface.linearize(points);
  for (std::size_t i = 0; i < bends.size(); ++i) {
    bends[i].beyond = std::move(reached[i]);
  }
  bends.erase(
      std::remove_if(bends.begin(), bends.end(), [](const Bend& bend) { return !bend.beyond.simulated; }),
      bends.end());
  return bends;
}

/// Parameters in their logarithms that take part in a direction: a tenth of its largest.
std::vector<Index> listParticipants(const std::vector<Bend>& bends, const LogCoordinates& coordinates) {
  constexpr double kTakesPart = 0.1;
  constexpr std::size_t kMost = 10;
  std::vector<Index> participants;
  for (Index j = 0; j < coordinates.getCount(); ++j) {
    const bool takes_part = std::any_of(bends.begin(), bends.end(), [&](const Bend& bend) {
      return std::abs(bend.direction[j]) > kTakesPart * bend.direction.cwiseAbs().maxCoeff();
    });
    if (coordinates.isLog(j) && takes_part && participants.size() < kMost) {
      participants.push_back(j);
    }
  }
  return participants;
}

/// How much dearer the steps are beyond than at the basin, with some parameters as they are.
double calcGrowth(const std::vector<Bend>& bends, const MatrixXd& ratios, const std::vector<Index>& plain) {
  double growth = 0.0;
  for (std::size_t i = 0; i < bends.size(); ++i) {
    VectorXd direction = bends[i].direction;
    for (const Index j : plain) {
      direction[j] *= ratios(j, static_cast<Index>(i));
    }
    growth = std::max(growth, direction.dot(bends[i].beyond.information * direction) - bends[i].cost);
  }
  return growth;
}

/// Those of `all` whose bit is set.
std::vector<Index> choose(const std::vector<Index>& all, unsigned bits) {
  std::vector<Index> chosen;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if ((bits >> k & 1u) != 0u) {
      chosen.push_back(all[k]);
    }
  }
  return chosen;
}

}  // namespace

RidgeShape findRidgeShape(MisfitSurface& surface, const Basin& basin) {
  constexpr double kStraight = 1.0, kStraighter = 0.5;
  RidgeShape shape;
  const std::vector<Bend> bends = listBends(surface, basin);
  const LogCoordinates& coordinates = surface.getCoordinates();
  MatrixXd ratios(basin.local.at.size(), static_cast<Index>(bends.size()));
  for (std::size_t i = 0; i < bends.size(); ++i) {
    ratios.col(static_cast<Index>(i)) =
        coordinates.calcSlopes(basin.local.at).cwiseQuotient(coordinates.calcSlopes(bends[i].beyond.at));
  }
  double least = calcGrowth(bends, ratios, {});
  if (least > kStraight) {
    const std::vector<Index> participants = listParticipants(bends, coordinates);
    const double most = kStraighter * least;
    for (unsigned bits = 1; bits < (1u << participants.size()); ++bits) {
      const std::vector<Index> plain = choose(participants, bits);
      const double growth = calcGrowth(bends, ratios, plain);
      if (growth < std::min(least, most)) {
        least = growth;
        shape.plain = plain;
      }
    }
  }
  shape.is_straight = least < kStraight;
  return shape;
}

Basin levelBasin(const Basin& basin) {
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(basin.local.information);
  Basin levelled = basin;
  VectorXd variances = (eigen.values.array() + kHalfWidthInformation).inverse();
  VectorXd& at = levelled.local.at;
  for (Index k = 0; k < eigen.values.size() && eigen.values[k] < kFlatInformation; ++k) {
    const VectorXd direction = eigen.vectors.col(k);
    const double lower = -calcReach(at, -direction), upper = calcReach(at, direction);
    if (upper > lower) {
      const double middle = 0.5 * (lower + upper), half = 0.5 * (upper - lower);
      const double information = std::max(0.0, eigen.values[k]);
      const gp::Moments cut = gp::calcBoxMoments(
          MatrixXd::Constant(1, 1, half * half * information),
          VectorXd::Constant(1, half * (direction.dot(basin.local.descent) - information * middle)));
      at += (middle + half * cut.mean[0]) * direction;
      variances[k] = std::max(variances[k], half * half * cut.covariance(0, 0));
    }
  }
  levelled.covariance = eigen.vectors * variances.asDiagonal() * eigen.vectors.transpose();
  return levelled;
}

}  // namespace twinmap
