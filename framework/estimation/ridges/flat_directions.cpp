#include "framework/estimation/ridges/flat_directions.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The data leave half of the box's standard deviation: sqrt(12 / (12 + information)) = 1/2.
constexpr double kFlatInformation = 36.0;
constexpr double kTakesPart = 0.03;

/// The projector (p x p) on the flat directions of one point.
MatrixXd calcFlatProjector(const MatrixXd& information) {
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(information);
  const Index flat = (eigen.values.array() < kFlatInformation).count();
  const MatrixXd vectors = eigen.vectors.leftCols(flat);
  return vectors * vectors.transpose();
}

/// Parameters that are joined by large entries of the mean of the projectors' absolute values.
std::vector<std::vector<Index>> findGroups(const MatrixXd& joined) {
  std::vector<std::vector<Index>> groups;
  std::vector<bool> seen(static_cast<std::size_t>(joined.rows()), false);
  for (Index first = 0; first < joined.rows(); ++first) {
    if (seen[static_cast<std::size_t>(first)] || joined(first, first) < kTakesPart) {
      continue;
    }
    std::vector<Index> group{first};
    seen[static_cast<std::size_t>(first)] = true;
    for (std::size_t k = 0; k < group.size(); ++k) {
      for (Index j = 0; j < joined.rows(); ++j) {
        if (!seen[static_cast<std::size_t>(j)] && joined(j, j) >= kTakesPart &&
            joined(group[k], j) >= kTakesPart) {
          seen[static_cast<std::size_t>(j)] = true;
          group.push_back(j);
        }
      }
    }
    std::sort(group.begin(), group.end());
    groups.push_back(group);
  }
  return groups;
}

Index findCommonest(const std::vector<Index>& numbers) {
  std::map<Index, int> counts;
  for (const Index number : numbers) {
    ++counts[number];
  }
  const auto most = std::max_element(counts.begin(), counts.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end() ? 0 : most->first;
}

/// The directions of a group; without changes where the points disagree on their number.
FlatDirections takeGroup(const std::vector<Index>& group, const std::vector<MatrixXd>& projectors,
                         const MatrixXd& points) {
  constexpr std::size_t kMinPoints = 3;
  std::vector<Index> dimensions;
  for (const MatrixXd& projector : projectors) {
    dimensions.push_back(std::lround(projector(group, group).trace()));
  }
  FlatDirections flat{group, findCommonest(dimensions), {}, {}};
  std::vector<Index> taken;
  for (std::size_t i = 0; i < projectors.size(); ++i) {
    if (dimensions[i] == flat.dimension && flat.dimension > 0) {
      const MatrixXd block = projectors[i](group, group);
      flat.changes.push_back(linalg::calcSymmetricEigen(block).vectors.rightCols(flat.dimension));
      taken.push_back(static_cast<Index>(i));
    }
  }
  flat.points = points(Eigen::all, taken);
  if (taken.size() < kMinPoints || 2 * taken.size() < projectors.size()) {
    flat.changes.clear();
  }
  return flat;
}

}  // namespace

std::vector<FlatDirections> findFlatDirections(const std::vector<MatrixXd>& information,
                                               const MatrixXd& points) {
  std::vector<MatrixXd> projectors;
  std::vector<Index> known;
  MatrixXd joined = MatrixXd::Zero(points.rows(), points.rows());
  for (std::size_t i = 0; i < information.size(); ++i) {
    if (information[i].size() > 0) {
      projectors.push_back(calcFlatProjector(information[i]));
      joined += projectors.back().cwiseAbs();
      known.push_back(static_cast<Index>(i));
    }
  }
  std::vector<FlatDirections> found;
  if (projectors.empty()) {
    return found;
  }
  for (const std::vector<Index>& group : findGroups(joined / static_cast<double>(projectors.size()))) {
    if (group.size() > 1) {
      FlatDirections flat = takeGroup(group, projectors, points(Eigen::all, known));
      if (!flat.changes.empty()) {
        found.push_back(std::move(flat));
      }
    }
  }
  return found;
}

bool mayBeFlat(const MatrixXd& covariance) {
  constexpr double kBoxVariance = 1.0 / 12.0, kShare = 0.25;
  return !(linalg::calcSymmetricEigen(covariance).values.maxCoeff() < kShare * kShare * kBoxVariance);
}

}  // namespace twinmap
