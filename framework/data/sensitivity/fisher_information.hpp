#pragma once

#include <Eigen/Core>

#include "framework/data/features/labelled_features.hpp"
#include "framework/data/noise/noise_whitener.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// What noisy features say about the parameters, in units of the bounds' widths:
/// J' C^-1 J (p x p) for sensitivities J (d x p, per width) and noise covariance C.
Eigen::MatrixXd calcFisherInformation(const NoiseWhitener& noise, const Eigen::MatrixXd& sensitivities);

/// What remains of the information about the first `count` parameters when the others are unknown, but for
/// their bounds: I_pp - I_pn (I_nn + 12)^-1 I_np, whose limit covariance is the block of that of the whole.
Eigen::MatrixXd calcMarginalInformation(const Eigen::MatrixXd& information, Eigen::Index count);

/// The covariance (p x p, in widths) that no estimator beats on average over the box: the inverse of the
/// information plus that of the box, which is 12 for each parameter because a uniform distribution has the
/// variance width^2 / 12 (van Trees' bound with the box's variance).
Eigen::MatrixXd calcLimitCovariance(const Eigen::MatrixXd& information);

/// Whether an experiment asks for the information limit and all outputs that its features read have noise:
/// without noise there is no limit.
bool asksForInformationLimit(const ExperimentSpec& experiment);

/// Whether a run of the experiment computes the limit: where it asks for it and every feature turned out to
/// have noise.
bool hasInformationLimit(const ExperimentSpec& experiment, const LabelledFeatures& samples);

}  // namespace twinmap
