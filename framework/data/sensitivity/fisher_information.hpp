#pragma once

#include <Eigen/Core>

#include "framework/data/features/labelled_features.hpp"
#include "framework/data/noise/noise_whitener.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// What noisy features say about the parameters, in units of the bounds' widths:
/// J' C^-1 J (p x p) for sensitivities J (d x p, per width) and noise covariance C.
Eigen::MatrixXd calcFisherInformation(const NoiseWhitener& noise, const Eigen::MatrixXd& sensitivities);

/// What is known before a measurement (u x u, per width) where all of u parameters are uniform within their
/// bounds: 12 each.
Eigen::MatrixXd makeUniformInformation(Eigen::Index parameters);

/// What remains of the information about the first `count` parameters when the others are unknown, but for
/// what is known of them before: without correlations in `prior`, I_pp - I_pn (I_nn + P_nn)^-1 I_np, whose
/// limit covariance (with calcMarginalPrior()) is the block of that of the whole. prior: u x u.
Eigen::MatrixXd calcMarginalInformation(const Eigen::MatrixXd& information, Eigen::Index count,
                                        const Eigen::MatrixXd& prior);
/// The same of uniform parameters.
Eigen::MatrixXd calcMarginalInformation(const Eigen::MatrixXd& information, Eigen::Index count);

/// The prior of the first `count` parameters alone: P_pp - P_pn P_nn^-1 P_np.
Eigen::MatrixXd calcMarginalPrior(const Eigen::MatrixXd& prior, Eigen::Index count);

/// The covariance (p x p, in widths) that no estimator beats on average over the prior: the inverse of the
/// information plus that of the prior, which counts as a normal distribution of its variance (van Trees'
/// bound with it).
Eigen::MatrixXd calcLimitCovariance(const Eigen::MatrixXd& information, const Eigen::MatrixXd& prior);
/// The same of uniform parameters: a uniform distribution has the variance width^2 / 12.
Eigen::MatrixXd calcLimitCovariance(const Eigen::MatrixXd& information);

/// Whether an experiment asks for the information limit and all outputs that its features read have noise:
/// without noise there is no limit.
bool asksForInformationLimit(const ExperimentSpec& experiment);

/// Whether a run of the experiment computes the limit: where it asks for it and every feature turned out to
/// have noise.
bool hasInformationLimit(const ExperimentSpec& experiment, const LabelledFeatures& samples);

}  // namespace twinmap
