#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/features/feature_block.hpp"
#include "framework/inverse_map/training_control.hpp"
#include "framework/surrogate/forward_surrogate.hpp"
#include "kernels/surrogate/fit_shared_process.hpp"

namespace twinmap {

/// Simulations that a forward surrogate learns from.
struct ForwardSamples {
  std::vector<FeatureInfo> infos;    ///< d
  Eigen::MatrixXd points;            ///< m x n, normalised
  Eigen::MatrixXd clean_features;    ///< d x n
  Eigen::MatrixXd noise_covariance;  ///< d x d
  /// n, or none: derivatives of the features (d x u) with respect to the first u variables, normalised; empty
  /// where a simulation has none.
  std::vector<Eigen::MatrixXd> slopes{};
};

/// At how many of n simulations slopes with respect to u variables are learnt from: of all, as long as there
/// are at most 2000 values and slopes in all, which keeps a fit of a window below a second.
Eigen::Index countSlopePoints(Eigen::Index simulations, Eigen::Index unknown);

/// A forward surrogate, and what was chosen for each window of features.
struct ForwardFit {
  ForwardSurrogate surrogate;
  std::vector<gp::SharedChoice> choices;
};

/// Fits processes to the principal components of each window of whitened features. Components that move less
/// than 0.2 of the noise are left out; of the others those are kept that say most about the parameters, by sd
/// over sqrt(1 + error variance): at most 200, and as many as the errors of n simulations tell the
/// correlations of, n / 4 where the errors are far above the noise, and more the further they are below. The
/// correlation of the errors is that of the points left out, shrunk towards independence by at least 0.2
/// (Schaefer and Strimmer 2005). Where slopes are given, each window learns from them as well if that
/// predicts simulations left out better (gp::chooseWithSlopes). `similar`: choices for nearly the same
/// samples, to start from; empty to search anew. Throws std::invalid_argument for a feature without noise and
/// for too few simulations, gp::Stopped. Cost: a window some 60 evaluations of gp::LeftOutDensity on 300
/// points, 8 from similar choices; then 2 n^3 flops, with slopes 2 / 3 (n + u m)^3.
ForwardFit fitForward(const ForwardSamples& samples, const std::vector<gp::SharedChoice>& similar,
                      const TrainingControl& control);

}  // namespace twinmap
