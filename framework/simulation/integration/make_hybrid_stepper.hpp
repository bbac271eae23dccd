#pragma once

#include <memory>

#include "framework/simulation/integration/hybrid_stepper.hpp"

namespace twinmap {

/// Dormand and Prince's explicit 5(4) pair, or Radau IIA for stiff problems (radau_stepper.hpp).
enum class HybridMethod { kExplicit, kImplicit };

std::unique_ptr<HybridStepper> makeHybridStepper(HybridMethod method, const IntegrationOptions& options);

}  // namespace twinmap
