#pragma once

#include "framework/simulation/model_numbers.hpp"

namespace twinmap {

/// Turns the quantities of a model from elsewhere into what its sensors show: gain * quantity + offset.
/// `response`: the outputs one below the other. `numbers`: updated for the sample. Throws SimulationFailure
/// for a gain or offset that is not finite.
void applySensors(const ModelSpec& model, ModelNumbers& numbers, Eigen::Ref<Eigen::VectorXd> response);

/// Multiplies derivatives of the quantities (responses x any) by the gains, which must not depend on what
/// they are derivatives by. As applySensors otherwise.
void applyGains(const ModelSpec& model, ModelNumbers& numbers, Eigen::Ref<Eigen::MatrixXd> derivatives);

}  // namespace twinmap
