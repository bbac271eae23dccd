#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/interval_reach.hpp"
#include "framework/estimation/mixture.hpp"

namespace twinmap {

/// Inferred parameters of n samples (p x n each): the mean and the standard deviation of a normal
/// distribution, or of a mixture.
struct Predictions {
  Eigen::MatrixXd mean;
  Eigen::MatrixXd stddev;
  /// p x p, of each sample's errors, where the map tells them apart; else empty.
  std::vector<Eigen::MatrixXd> correlations{};
  /// Of each sample, where the map gives mixtures; else empty.
  std::vector<Mixture> mixtures{};
  /// Of intervals, where they are not those of these distributions; of a mixture in calcDepth().
  IntervalReach reach{};
};

/// In other units, as convert() of a mixture; the mean and standard deviation of a mixture follow from it.
void convert(const Eigen::VectorXd& center, const Eigen::VectorXd& unit, const Eigen::VectorXd& stddev_scale,
             Predictions& predictions);

/// An answer that knows less of a parameter than its bounds do, its standard deviation being more than their
/// half width, is drawn towards their center until it is that: what a network extrapolates to may be
/// thousands of widths away. Bounds alone leave .58 of the half width, so that answers that tell anything are
/// left as they are. All p numbers each; the result does not allocate.
void shrinkToBounds(const Eigen::VectorXd& center, const Eigen::VectorXd& half_width,
                    Eigen::Ref<Eigen::VectorXd> mean, Eigen::Ref<Eigen::VectorXd> stddev);

/// The same of each sample, and of its mixture.
void shrinkToBounds(const Eigen::VectorXd& center, const Eigen::VectorXd& half_width,
                    Predictions& predictions);

/// How far a parameter's truths (p x n) lie from what was predicted, in standard deviations (n): of mixtures,
/// calcDepth(), at some 0.1 ms a sample.
Eigen::VectorXd calcDepths(const Predictions& predictions, const Eigen::MatrixXd& truth,
                           Eigen::Index parameter);

/// How far intervals must reach to hold what they say (calcReach()) of each parameter's truths (p x n),
/// `draws` of each sample; empty where normal distributions' do, and for fewer than 400 samples, whose
/// quantiles are chance: 2.5 % of those of 50 % intervals, 1 % of those of 95 %.
IntervalReach calcIntervalReach(const Predictions& predictions, const Eigen::MatrixXd& truth, int draws);

/// The correlation matrix of a covariance (p x p, positive diagonal).
Eigen::MatrixXd calcCorrelation(const Eigen::MatrixXd& covariance);

}  // namespace twinmap
