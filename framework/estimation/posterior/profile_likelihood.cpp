#include "framework/estimation/posterior/profile_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "framework/estimation/posterior/basins/search_team.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Points (u x n) that are put off from the mean of the draws in one coordinate each, the others as the
/// draws go along with it; and the coordinates, as unit vectors.
struct Ends {
  MatrixXd points, coordinates;
};

Ends listEnds(const importance::WeightedDraws& draws) {
  constexpr double kReach = 5.0, kLeastReach = 0.8 * kReach;  // standard deviations
  const VectorXd mean = importance::calcMean(draws);
  const MatrixXd covariance = importance::calcCovariance(draws);
  const Index u = mean.size();
  Ends ends{MatrixXd(u, 2 * u), MatrixXd(u, 2 * u)};
  Index count = 0;
  for (Index j = 0; j < u; ++j) {
    const double stddev = std::sqrt(covariance(j, j));
    for (const double side : {-1.0, 1.0}) {
      const double apart = std::min(kReach * stddev, 1.0 - side * mean[j]);
      if (stddev > 0.0 && apart >= kLeastReach * stddev) {
        const VectorXd point = mean + side * apart * covariance.col(j) / covariance(j, j);
        ends.points.col(count) = point.cwiseMax(-1.0).cwiseMin(1.0);
        ends.coordinates.col(count++) = VectorXd::Unit(u, j);
      }
    }
  }
  return {ends.points.leftCols(count), ends.coordinates.leftCols(count)};
}

constexpr int kValues = 13, kStartsPerValue = 4;

/// Where a profile looks: even steps of a coordinate over what bears some of the posterior.
VectorXd listValues(const importance::WeightedDraws& draws, Index j) {
  constexpr double kReach =
      3.0;                       // standard deviations: 4.5 below the largest of a normal density's logarithm
  constexpr double kEnd = 1e-3;  // a ridge ends at bounds, beyond which nothing fits
  const double mean = importance::calcMean(draws)[j];
  const double reach = kReach * std::sqrt(importance::calcCovariance(draws)(j, j));
  const VectorXd ends = importance::calcQuantiles({draws.points.row(j), draws.weights},
                                                  (VectorXd(2) << kEnd, 1.0 - kEnd).finished())
                            .transpose();
  return VectorXd::LinSpaced(kValues, std::max(ends[0], mean - reach), std::min(ends[1], mean + reach));
}

/// The draws (u x kStartsPerValue) that bear most weight near a value of coordinate j, put there. Near is a
/// step between values.
MatrixXd listStarts(const importance::WeightedDraws& draws, Index j, double value, double near) {
  const Eigen::ArrayXd apart = (draws.points.row(j).transpose().array() - value) / near;
  const Eigen::ArrayXd scores = draws.weights.array().log() - 0.5 * apart.square();
  std::vector<Index> order(static_cast<std::size_t>(scores.size()));
  std::iota(order.begin(), order.end(), Index{0});
  std::partial_sort(order.begin(), order.begin() + kStartsPerValue, order.end(),
                    [&](Index a, Index b) { return scores[a] > scores[b]; });
  order.resize(kStartsPerValue);
  MatrixXd starts = draws.points(Eigen::all, order);
  starts.row(j).setConstant(value);
  return starts;
}

/// Searches from starts in which coordinate j stays, as many in a row for each value, and keeps the best of
/// each.
void search(MisfitSurface& surface, Index j, const MatrixXd& starts, std::vector<LocalSurface>& best) {
  constexpr int kIterations = 10;
  SearchTeam team(surface, starts, VectorXd::Unit(starts.rows(), j).replicate(1, starts.cols()));
  team.run(kIterations);
  for (Index i = 0; i < starts.cols(); ++i) {
    const LocalSurface& local = team.getLocal(i);
    LocalSurface& kept = best[static_cast<std::size_t>(i * kValues / starts.cols())];
    if (local.simulated && (!kept.simulated || local.misfit < kept.misfit)) {
      kept = local;
    }
  }
}

/// What was found at the values next to each, put there: with several flat directions searches end early.
MatrixXd startFromNeighbours(const std::vector<LocalSurface>& best, Index j, const VectorXd& values,
                             const MatrixXd& starts) {
  constexpr Index kNeighbours = 2;
  MatrixXd neighbours(starts.rows(), kNeighbours * kValues);
  for (Index i = 0; i < kValues; ++i) {
    const Index others[kNeighbours] = {std::max<Index>(i - 1, 0), std::min<Index>(i + 1, kValues - 1)};
    for (Index k = 0; k < kNeighbours; ++k) {
      const LocalSurface& other = best[static_cast<std::size_t>(others[k])];
      auto start = neighbours.col(kNeighbours * i + k);
      start = other.simulated ? other.at : VectorXd(starts.col(i * kStartsPerValue));
      start[j] = values[i];
    }
  }
  return neighbours;
}

Profile calcProfile(MisfitSurface& surface, const importance::WeightedDraws& draws, Index j) {
  const VectorXd values = listValues(draws, j);
  const Index u = draws.points.rows();
  MatrixXd starts(u, kValues * kStartsPerValue);
  for (Index i = 0; i < kValues; ++i) {
    starts.middleCols(i * kStartsPerValue, kStartsPerValue) =
        listStarts(draws, j, values[i], std::max(values[1] - values[0], 1e-12));
  }
  std::vector<LocalSurface> best(kValues);
  search(surface, j, starts, best);
  search(surface, j, startFromNeighbours(best, j, values, starts), best);
  Profile profile{j, MatrixXd(u, kValues), VectorXd(kValues)};
  Index found = 0;
  for (const LocalSurface& local : best) {
    if (local.simulated) {
      profile.points.col(found) = local.at;
      profile.log_ratios[found++] = -0.5 * local.misfit;
    }
  }
  profile.points = MatrixXd(profile.points.leftCols(found));
  profile.log_ratios = VectorXd(profile.log_ratios.head(found));
  return profile;
}

}  // namespace

bool endTooEarly(MisfitSurface& surface, const importance::WeightedDraws& draws, double least_misfit) {
  constexpr int kIterations = 6;
  constexpr double kProfileRise = 1.5;
  const Ends ends = listEnds(draws);
  if (ends.points.cols() == 0) {
    return false;
  }
  SearchTeam team(surface, ends.points, ends.coordinates);
  team.run(kIterations);
  const std::vector<LocalSurface> profile = team.listEnds();
  return std::any_of(profile.begin(), profile.end(),
                     [&](const LocalSurface& local) { return local.misfit < least_misfit + kProfileRise; });
}

std::vector<Profile> calcProfiles(MisfitSurface& surface, const importance::WeightedDraws& draws,
                                  double least_misfit, Index count) {
  std::vector<Profile> profiles;
  double largest = -0.5 * least_misfit;
  for (Index j = 0; j < count; ++j) {
    profiles.push_back(calcProfile(surface, draws, j));
    const VectorXd& found = profiles.back().log_ratios;
    largest = found.size() > 0 ? std::max(largest, found.maxCoeff()) : largest;
  }
  for (Profile& profile : profiles) {
    profile.log_ratios.array() -= largest;
  }
  return profiles;
}

}  // namespace twinmap
