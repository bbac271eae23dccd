#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "framework/data/features/noise_covariance.hpp"
#include "framework/optimal_design/criterion.hpp"

namespace twinmap::experiment_design {

/// Which candidates are measured: their indices, ascending.
using Subset = std::vector<Eigen::Index>;

/// What noisy features say at points of the box.
struct CandidateFeatures {
  std::vector<Eigen::MatrixXd> sensitivities;  ///< of each point: d x u, per width of the bounds
  NoiseCovariance noise_covariance;            ///< d x d
};

/// The information of subsets of candidates, each some of the features. Where the noise of no two candidates
/// is correlated, informations add up and are computed once; else a subset's is J' C^-1 J of its own
/// features. Immutable.
class CandidateInformation {
 public:
  /// groups: the features (rows) of each candidate; parameters: the first p of the u unknowns, the others are
  /// nuisance. Throws std::invalid_argument for a feature without noise.
  CandidateInformation(CandidateFeatures features, std::vector<std::vector<Eigen::Index>> groups,
                       Eigen::Index parameters);

  Eigen::Index countCandidates() const { return static_cast<Eigen::Index>(groups_.size()); }
  std::size_t countPoints() const { return features_.sensitivities.size(); }

  /// Of p parameters at a point, per width^2, nuisance marginalised, without the box's own.
  Eigen::MatrixXd calcInformation(const Subset& subset, std::size_t point) const;

  /// The mean over the points of calcCost(), the box as prior.
  double calcMeanCost(const Subset& subset, const Criterion& criterion) const;

 private:
  std::vector<Eigen::MatrixXd> calcWhole(const Subset& subset) const;

  CandidateFeatures features_;
  std::vector<std::vector<Eigen::Index>> groups_;
  Eigen::Index parameters_;
  std::vector<std::vector<Eigen::MatrixXd>> own_;  // of each candidate at each point, u x u; or empty
};

/// The subset of `count` candidates with the least mean cost that greedy additions to `begun`, and then
/// exchanges of one candidate for another until none helps, lead to; of equal ones the first. `proceed` is
/// called now and then, and may throw to stop. Throws std::runtime_error where no cost is finite.
Subset extendSubset(
    const CandidateInformation& candidates, const Criterion& criterion, Subset begun, Eigen::Index count,
    const std::function<void()>& proceed = [] {});

}  // namespace twinmap::experiment_design
