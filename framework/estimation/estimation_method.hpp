#pragma once

namespace twinmap {

/// What made an estimate: the trained estimator by its kind, or a refinement on the simulator.
enum class EstimationMethod { kGp, kSurrogate, kNetwork, kRefined };

/// "gp", "surrogate", "network", "refined".
const char* toString(EstimationMethod method);

}  // namespace twinmap
