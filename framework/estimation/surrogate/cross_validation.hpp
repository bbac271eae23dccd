#pragma once

#include "framework/estimation/run_tasks.hpp"
#include "framework/estimation/surrogate/fit_forward.hpp"
#include "framework/estimation/surrogate/surrogate.hpp"
#include "framework/estimation/surrogate/surrogate_samples.hpp"

namespace twinmap {

/// Parts of the simulations that are left out in turn.
inline constexpr Eigen::Index kFolds = 5;

/// So many simulations of a box of so many variables can be trained with and cross-validated.
Eigen::Index countLeastSimulations(Eigen::Index variables);

/// Simulations left out of a training, and what was inferred of them from the measured features, draw by
/// draw.
struct HeldOut {
  Eigen::MatrixXd truth;         ///< p x c
  Estimates predictions;         ///< p x c, before any scaling
  Eigen::MatrixXd limit_stddev;  ///< p x c, what the measurement allows
};

/// Some of the simulations, in the order given.
ForwardSamples selectSimulations(const ForwardSamples& samples, const std::vector<Eigen::Index>& kept);

/// A surrogate for the box of `whole` that some simulations are left out of, fitted from the choices made for
/// all, without any scaling of its standard deviations.
Surrogate fitSimilar(const Surrogate& whole, const ForwardSamples& samples, const ForwardChoices& choices,
                     const TrainingControl& control);

/// The simulations that each of five folds keeps: all but every fifth.
std::vector<std::vector<Eigen::Index>> listFolds(Eigen::Index simulations);

/// Infers the measured features of the simulations that each fold leaves out by its surrogate, fitted to the
/// others by the choices made for all (ForwardFit::folds). `whole` gives box and sizes.
HeldOut crossValidate(const Surrogate& whole, const SurrogateSamples& samples, const ForwardSamples& forward,
                      std::vector<ForwardSurrogate> folds, const TrainingControl& control);

/// What follows for the standard deviations; limit_scale is left to others.
SurrogateValidation validate(const HeldOut& held_out);

}  // namespace twinmap
