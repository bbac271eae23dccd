#pragma once

#include "framework/simulation/integration/ode_problem.hpp"

namespace twinmap {

bool isFinite(const OdeProblem::State& x);

/// The size of the first step from x at t, where the derivative is dxdt, at most `length` (s): Hairer,
/// Norsett, Wanner I, II.4, algorithm for the starting step size. Cost: one evaluation of f.
double calcFirstStep(OdeProblem& problem, double t, const OdeProblem::State& x, const OdeProblem::State& dxdt,
                     double length, const IntegrationOptions& options);

}  // namespace twinmap
