#pragma once

#include "framework/estimation/refined/refine.hpp"
#include "framework/estimation/trained/trust_model.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// What is known of a measurement before it is refined.
struct InitialEstimate {
  Eigen::VectorXd mean;          ///< p, by the inverse map
  Eigen::VectorXd explanation;   ///< sampled point that explains the features best; empty without trust model
  Eigen::VectorXd known;         ///< q
  Eigen::MatrixXd covariance{};  ///< u x u of the unknown there, in half-widths; empty without trust model
};

/// A point of the sampled box: the given parameters, the nuisance parameters of `explanation` (a point of the
/// box, or empty: the prior's), the known inputs.
Eigen::VectorXd makePoint(const ModelSpec& model, const Eigen::VectorXd& parameters,
                          const Eigen::VectorXd& explanation, const Eigen::VectorXd& known);

/// What a refinement searches all unknown parameters from: the map's estimate; the point whose interpolated
/// features explain the measured ones best; the training simulations whose features are most similar. Without
/// a trust model the first and the middle of the box. Cost: r n flops for n simulations of r scores.
RefinementTask makeRefinementTask(const ModelSpec& model, const TrustModel* trust,
                                  const Eigen::VectorXd& features, const InitialEstimate& initial);

/// Whether an experiment's estimates are to be refined. Automatic: where the simulator gives exact
/// derivatives (it runs in lanes), all features are linear in the response or have a linear form, so that
/// their noise is known without sampling, and all have noise: a refinement is then possible and takes
/// milliseconds. Measured times do not decide, so that results do not depend on them.
bool shouldRefine(RefineMode mode, const Simulator& simulator, const FeatureNoise& noise);

}  // namespace twinmap
