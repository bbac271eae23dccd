#include "framework/estimation/ridges/flat_directions.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "framework/estimation/levels.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// What the information at one point says (p x p both).
struct KnownThere {
  MatrixXd projector;   ///< on the flat directions
  MatrixXd determined;  ///< covariance of what is determined, with the box as a normal distribution
};

KnownThere splitInformation(const MatrixXd& information) {
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(information);
  const Index flat = (eigen.values.array() < 4.0 * kFlatInformation).count(),
              rest = eigen.values.size() - flat;
  const MatrixXd level = eigen.vectors.leftCols(flat), steep = eigen.vectors.rightCols(rest);
  const VectorXd variances = (eigen.values.tail(rest).array() + kUniformInformation).inverse();
  return {level * level.transpose(), steep * variances.asDiagonal() * steep.transpose()};
}

/// Means over the points.
struct MeanKnown {
  MatrixXd joined;      ///< p x p: of the projectors' absolute values
  VectorXd determined;  ///< p: variance of what is determined
};

MeanKnown average(const std::vector<KnownThere>& known, Index parameters) {
  MeanKnown mean{MatrixXd::Zero(parameters, parameters), VectorXd::Zero(parameters)};
  for (const KnownThere& one : known) {
    mean.joined += one.projector.cwiseAbs();
    mean.determined += one.determined.diagonal();
  }
  const auto count = static_cast<double>(known.size());
  mean.joined /= count;
  mean.determined /= count;
  return mean;
}

/// The share of a flat direction's square from which on each parameter takes part (p). What is nearly as flat
/// mixes with what is flat, so that it is 3 %. It is less of a parameter that flat directions move by three
/// times what else is unknown of it. They must move it by 1 % of its width.
VectorXd calcLeastShares(const MeanKnown& mean) {
  constexpr double kTakesPart = 0.03, kThreeTimes = 9.0, kPercent = 1e-4;
  return (kUniformInformation * kThreeTimes * mean.determined)
      .cwiseMax(kUniformInformation * kPercent)
      .cwiseMin(kTakesPart);
}

/// Parameters that are joined by large entries of the mean of the projectors' absolute values.
std::vector<std::vector<Index>> findGroups(const MeanKnown& mean) {
  const VectorXd least = calcLeastShares(mean);
  const auto are_joined = [&](Index i, Index j) {
    return mean.joined(j, j) >= least[j] && mean.joined(i, j) >= std::sqrt(least[i] * least[j]);
  };
  std::vector<std::vector<Index>> groups;
  std::vector<bool> seen(static_cast<std::size_t>(least.size()), false);
  for (Index first = 0; first < least.size(); ++first) {
    if (seen[static_cast<std::size_t>(first)] || !are_joined(first, first)) {
      continue;
    }
    std::vector<Index> group{first};
    seen[static_cast<std::size_t>(first)] = true;
    for (std::size_t k = 0; k < group.size(); ++k) {
      for (Index j = 0; j < least.size(); ++j) {
        if (!seen[static_cast<std::size_t>(j)] && are_joined(group[k], j)) {
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
FlatDirections takeGroup(const std::vector<Index>& group, const std::vector<KnownThere>& known,
                         const MatrixXd& points) {
  std::vector<Index> dimensions;
  for (const KnownThere& one : known) {
    dimensions.push_back(std::lround(one.projector(group, group).trace()));
  }
  FlatDirections flat{group, findCommonest(dimensions), {}, {}, {}};
  std::vector<Index> taken;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (dimensions[i] == flat.dimension && flat.dimension > 0) {
      const MatrixXd block = known[i].projector(group, group);
      flat.changes.push_back(linalg::calcSymmetricEigen(block).vectors.rightCols(flat.dimension));
      flat.determined.emplace_back(known[i].determined(group, group));
      taken.push_back(static_cast<Index>(i));
    }
  }
  flat.points = points(Eigen::all, taken);
  if (taken.size() < kMinRidgePoints || 2 * taken.size() < known.size()) {
    flat.changes.clear();
  }
  return flat;
}

}  // namespace

std::vector<FlatDirections> findFlatDirections(const std::vector<MatrixXd>& information,
                                               const MatrixXd& points) {
  std::vector<KnownThere> known;
  std::vector<Index> places;
  for (std::size_t i = 0; i < information.size(); ++i) {
    if (information[i].size() > 0) {
      known.push_back(splitInformation(information[i]));
      places.push_back(static_cast<Index>(i));
    }
  }
  std::vector<FlatDirections> found;
  if (known.empty()) {
    return found;
  }
  for (const std::vector<Index>& group : findGroups(average(known, points.rows()))) {
    if (group.size() > 1) {
      FlatDirections flat = takeGroup(group, known, points(Eigen::all, places));
      if (!flat.changes.empty()) {
        found.push_back(std::move(flat));
      }
    }
  }
  return found;
}

bool mayBeFlat(const MatrixXd& covariance) {
  return !(kUniformInformation * linalg::calcSymmetricEigen(covariance).values.maxCoeff() <
           kMayBeFlat * kMayBeFlat);
}

}  // namespace twinmap
