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

constexpr int kValues = 13, kStartsPerValue = 4;

/// Where a profile looks: even steps of a coordinate over what bears some of the posterior.
VectorXd listValues(const importance::WeightedDraws& draws, Index j) {
  const double mean = importance::calcMean(draws)[j];
  const double reach = kBasinReach * std::sqrt(importance::calcCovariance(draws)(j, j));
  const VectorXd ends = importance::calcQuantiles({draws.points.row(j), draws.weights},
                                                  (VectorXd(2) << kRareLevel, 1.0 - kRareLevel).finished())
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
  SearchTeam team(surface, starts, VectorXd::Unit(starts.rows(), j).replicate(1, starts.cols()));
  team.run(kFewIterations);
  for (Index i = 0; i < starts.cols(); ++i) {
    const LocalSurface& local = team.getLocal(i);
    LocalSurface& kept = best[static_cast<std::size_t>(i * kValues / starts.cols())];
    if (local.simulated && (!kept.simulated || local.misfit < kept.misfit)) {
      kept = local;
    }
  }
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
