#pragma once

#include "framework/surrogate/fit_forward.hpp"
#include "framework/surrogate/train_surrogate.hpp"

namespace twinmap {

/// Simulations left out of a training, and what was inferred of them from the measured features, draw by
/// draw.
struct HeldOut {
  Eigen::MatrixXd truth;    ///< p x c
  Predictions predictions;  ///< p x c, before any scaling
};

/// Leaves out every fifth simulation in turn, fits everything anew from the choices made for all, and infers
/// the measured features of those left out. `whole` gives box and sizes.
HeldOut crossValidate(const Surrogate& whole, const SurrogateSamples& samples, const ForwardSamples& forward,
                      const ForwardChoices& choices, const TrainingControl& control);

/// What follows for the standard deviations.
SurrogateValidation validate(const HeldOut& held_out);

}  // namespace twinmap
