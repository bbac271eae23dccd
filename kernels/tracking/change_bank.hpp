#pragma once

#include <array>
#include <optional>

#include "kernels/tracking/belief.hpp"

namespace twinmap::tracking {

/// One change that may have been: of a parameter, just before a measurement.
struct Supposed {
  Eigen::Index parameter = 0;
  double time = 0.0;          ///< of that measurement
  Eigen::VectorXd signature;  ///< n: what a change of 1 is of the state now, beside the belief
  double size = 0.0;          ///< mean
  double variance = 0.0;      ///< of the size
  double log_ratio = 0.0;     ///< of the likelihood with it, over that without
};

/// Changes before each of the last measurements, the oldest first.
struct ChangeBank {
  std::vector<Supposed> changes;
  /// Of each measurement that changes are supposed before, log_weights of the rates then (rates x unknown
  /// rates).
  std::vector<Eigen::MatrixXd> log_weights;
};

/// What a measurement says of changes, given how the belief took it.
struct ChangeEvidence {
  const StateRows& rows;
  const std::vector<Innovation>& innovations;  ///< as if it were good
  double log_bad = 0.0;  ///< log ratio of its densities where it is bad and where it is good, priors included
  bool is_used = true;   ///< whether the belief took it
  Eigen::Index parameters = 0;
};

/// How many measurements back changes are supposed. A change of one standard deviation of a measurement is
/// found within half of it, and the walk takes what is slower.
constexpr std::size_t kChangeWindow = 40;

/// Moves all that is supposed over a step of time. Then a change of each parameter is supposed here, of
/// normal size with the given standard deviations (p).
void supposeChanges(const Model& model, double dt, double time, const Eigen::VectorXd& stddev,
                    const Eigen::MatrixXd& log_weights, ChangeBank& bank);

/// Each change's likelihood ratio, size and signature after a measurement. A measurement is bad with some
/// probability, with the change or without, so that one of them alone moves no ratio far.
void weighChanges(const ChangeEvidence& evidence, ChangeBank& bank);

/// Shiryaev and Roberts' statistic: the sum of likelihood ratios over times, weighed over parameters (weights
/// sum to 1). Without a change its mean grows by 1 a measurement.
double calcShiryaevRoberts(const Model& model, const ChangeBank& bank);

/// Places ratio / (ratio + kSlowRatio) of the walks that lives were simulated for, between which thresholds
/// are interpolated.
inline constexpr double kSlowRatio = 0.1;
inline constexpr std::array<double, 4> kRatioPlaces{0.0, 0.5, 0.76, 0.909};

/// Above which it is an alarm, to be false as often as the model says. It depends on how fast walks forget.
/// ratios (p): each walk's standard deviation between two measurements over that of a measurement.
double calcThreshold(const Model& model, const Eigen::VectorXd& ratios);

/// Of each supposed change, its share of that statistic.
Eigen::VectorXd calcChangeShares(const Model& model, const ChangeBank& bank);

/// Mean and covariance of a belief over all supposed changes, each with its probability; none has the rest.
void addChanges(const Eigen::VectorXd& probabilities, const ChangeBank& bank, Belief& belief);

/// A change that was announced.
struct Change {
  Eigen::Index parameter = 0;
  double time = 0.0;                    ///< of the first measurement after it, the likeliest
  double earliest = 0.0, latest = 0.0;  ///< 95 % of them
  double size = 0.0, stddev = 0.0;
  double probability = 0.0;       ///< that it is this parameter
  Eigen::VectorXd probabilities;  ///< p
  /// Before the measurements, of a change of it thereabouts against none: those at which the threshold is
  /// even.
  double log_prior_odds = 0.0;
  std::size_t place = 0;  ///< of the likeliest, among the bank's
};
Change describeChange(const Model& model, double threshold, const ChangeBank& bank);

}  // namespace twinmap::tracking
