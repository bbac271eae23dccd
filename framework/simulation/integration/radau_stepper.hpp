#pragma once

#include <memory>

#include "framework/simulation/integration/hybrid_stepper.hpp"

namespace twinmap {

/// Radau IIA of order 5 with three stages, for stiff problems: L-stable, without loss of order where a state
/// follows what drives it fast (Hairer, Wanner: Solving Ordinary Differential Equations II, IV.5 and IV.8).
/// Its equations are solved by simplified Newton iterations with the Jacobian at the beginning of the step,
/// the problem's or by differences; the dense output is the collocation polynomial. Cost of a step of n
/// states: the Jacobian (by differences n evaluations), 1 evaluation, 3 an iteration, of which there are 3 to
/// 10, and a linear system of 3 n an iteration.
std::unique_ptr<HybridStepper> makeRadauStepper(const IntegrationOptions& options);

}  // namespace twinmap
