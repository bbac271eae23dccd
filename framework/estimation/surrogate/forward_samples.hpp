#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/data/features/feature_block.hpp"
#include "framework/data/noise/noise_whitener.hpp"
#include "kernels/surrogate/slope_covariance.hpp"

namespace twinmap {

/// Simulations that a forward surrogate learns from.
struct ForwardSamples {
  std::vector<FeatureInfo> infos;    ///< d
  Eigen::MatrixXd points;            ///< m x n, normalised
  Eigen::MatrixXd clean_features;    ///< d x n
  NoiseCovariance noise_covariance;  ///< d x d
  /// n, or none: derivatives of the features (d x u) with respect to the first u variables, normalised; empty
  /// where a simulation has none.
  std::vector<Eigen::MatrixXd> slopes{};
};

/// At how many of n simulations slopes with respect to u variables are learnt from: of all, as long as there
/// are at most 2000 values and slopes in all, which keeps a fit of a window below a second.
Eigen::Index countSlopePoints(Eigen::Index simulations, Eigen::Index unknown);

/// How many of the m with slopes may do where a response is simple, rising: as many as leave 700 values and
/// slopes in all, but no less than a quarter, which takes a twentieth of the time; then half of them.
std::vector<Eigen::Index> listFewSlopePoints(Eigen::Index simulations, Eigen::Index unknown,
                                             Eigen::Index with_slopes);

/// They in units of the noise, in the order in which processes take them, those with slopes first.
struct WhitenedSamples {
  Eigen::MatrixXd points;    ///< m x n
  Eigen::MatrixXd features;  ///< k x n
  gp::SlopeData slopes;      ///< of the features
};

WhitenedSamples whiten(const ForwardSamples& samples, const Eigen::VectorXd& center,
                       const NoiseWhitener& noise);

/// The order in which whiten() takes the simulations.
std::vector<Eigen::Index> orderSimulations(const ForwardSamples& samples);

/// Some of the whitened samples (rising), their features from their own mean on; slopes of those that have
/// any.
WhitenedSamples selectWhitened(const WhitenedSamples& whitened, const std::vector<Eigen::Index>& kept);

}  // namespace twinmap
