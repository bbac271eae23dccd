#pragma once

#include "framework/diagnosis/candidates/augment.hpp"
#include "framework/diagnosis/candidates/term_candidate.hpp"
#include "framework/diagnosis/problem/recorded_problem.hpp"

namespace twinmap {

/// Goes on with a fit toward the limits that scales of a term have at 0 (OwnScale::has_limit). Dry friction
/// that sets in at once is such a limit. Bounds fall by the scale's reach until the recordings exclude them.
/// Or until the recordings no longer tell them from a reach below: then the limit is among what is drawn.
/// They end, too, where nothing can be simulated. The coefficient has the number `first` in `experiment`.
/// Its scales follow it, and their bounds change. The fit is replaced where it goes on.
/// Cost: a simulation with derivatives, and some fits where the linear model does not exclude the bound.
void followToLimit(const RecordedFeatures& recordings, Eigen::Index first, const TermCandidate& candidate,
                   ExperimentSpec& experiment, RecordingFit& fit);

}  // namespace twinmap
