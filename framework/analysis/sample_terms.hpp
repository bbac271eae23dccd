#pragma once

#include <Eigen/Core>

#include "framework/estimation/estimate.hpp"
#include "framework/experiment/model/model_spec.hpp"
#include "framework/experiment/parameter_figures.hpp"

namespace twinmap {

/// Test samples of one parameter, in its unit.
struct ParameterSamples {
  Eigen::ArrayXd truth, mean, stddev;
  Eigen::ArrayXd limit_stddev;              ///< NaN where the limit is not known
  std::vector<MarginalMixture> mixtures{};  ///< where the distributions are no normal ones; else empty
  Eigen::ArrayXd z{};  ///< the truths as normal quantiles, where known otherwise; else empty
  std::vector<IntervalFactor> factors{};  ///< where intervals are not those of the distributions; else empty
  Eigen::VectorXd weights{};              ///< Estimates::weights, where given
  std::vector<Eigen::Index> repeated{};   ///< Estimates::repeated

  Eigen::Index count() const { return truth.size() - static_cast<Eigen::Index>(repeated.size()); }
};

/// What each of n samples adds to the mean of terms of the estimates (k x n + repeated) with their weights:
/// the mean of the result is theirs, and it varies as they do. The terms themselves where there are no
/// weights.
Eigen::MatrixXd sumUp(const Eigen::MatrixXd& terms, const Eigen::VectorXd& weights,
                      const std::vector<Eigen::Index>& repeated);

/// Those of one row of p x n each; limit_stddev may be empty.
ParameterSamples takeParameter(const Eigen::MatrixXd& truth, const Estimates& predictions,
                               const Eigen::MatrixXd& limit_stddev, Eigen::Index row);

/// What each sample adds to the figures, which depend on the samples through the means of these terms alone.
/// Errors and z are stored less their means, so that no digits of the standard deviations are lost.
struct SampleTerms {
  Eigen::MatrixXd terms;  ///< k x n
  double error_offset = 0.0;
  double z_offset = 0.0;
};

/// Of mixtures, z is the normal quantile of the probability integral transform, and intervals are the
/// smallest highest-density sets, or those that `factors` says.
SampleTerms calcSampleTerms(const ParameterSpec& parameter, const ParameterSamples& samples);

/// The figures of kFigureColumns, in their order, of a set with the given means of the terms (k) and number
/// of samples: a FigureFunction of `of`.
Eigen::VectorXd calcFigureValues(const SampleTerms& of, const Eigen::VectorXd& mean, double samples);

}  // namespace twinmap
