#pragma once

#include <Eigen/Core>
#include <memory>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/experiment/points/prior.hpp"

namespace twinmap {

/// What is known of u unknowns before a measurement, as one normal distribution of them in half-widths of
/// their bounds from the middle:
///   misfit(x) = 3 (x - mean)' relative (x - mean),
/// 3 being the information of a uniform distribution over the box. Normal priors are as stated, correlated or
/// not; the others have the moments of Prior::calcNormalForm().
struct BoxPrior {
  Eigen::VectorXd mean;      ///< u; 0 of a uniform parameter
  Eigen::MatrixXd relative;  ///< u x u, information over 3; 1 of a uniform parameter
  /// Where the bounds are taken into account by themselves, what remains is exp(-x' within x / 2 + shift' x).
  Eigen::MatrixXd within;  ///< u x u; 0 of a uniform parameter
  Eigen::VectorXd shift;   ///< u
  Eigen::VectorXd stddev;  ///< u, half-widths: of each parameter within its bounds

  Eigen::Index count() const { return mean.size(); }
  bool isUniform() const { return !within.any() && !shift.any(); }
  Eigen::MatrixXd calcInformation() const;  ///< u x u: 3 relative
};

/// All of u unknowns uniform within their bounds.
BoxPrior makeUniformPrior(Eigen::Index unknown);
BoxPrior makeBoxPrior(const ModelSpec& model);

/// The prior of a model's unknown parameters itself; null where all are uniform within their bounds.
std::shared_ptr<const Prior> findPrior(const ModelSpec& model);

/// Mean and standard deviation (u) of the prior within the bounds, in the parameters' units.
struct PriorMoments {
  Eigen::VectorXd mean, stddev;
};
PriorMoments calcPriorMoments(const ModelSpec& model);

/// A point of the sampled box (m) to begin at where nothing is known: the medians of the priors, the middle
/// of the bounds where they are uniform.
Eigen::VectorXd calcPriorCenter(const ModelSpec& model);

}  // namespace twinmap
