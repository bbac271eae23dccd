#pragma once

#include "framework/diagnosis/candidates/augment.hpp"
#include "framework/diagnosis/candidates/term_candidate.hpp"
#include "framework/diagnosis/problem/recorded_problem.hpp"

namespace twinmap {

/// Goes on with a fit toward the limits that a term's own scales have at 0 (OwnScale::has_limit), as dry
/// friction that sets in at once is one of friction that sets in over a speed. Bounds fall by the scale's
/// reach until the recordings exclude what lies at them, or no longer tell it from what lies a reach below:
/// then the limit itself is among what is fitted and drawn. They end, too, where nothing can be simulated.
/// first: of the term's coefficient in `experiment`, whose bounds are changed; fit: within them, replaced
/// where it goes on. Cost: where the linear model does not exclude the bound, a fit of the other parameters
/// for each fall of it, mostly two to four.
void followToLimit(const RecordedFeatures& recordings, Eigen::Index first, const TermCandidate& candidate,
                   ExperimentSpec& experiment, RecordingFit& fit);

}  // namespace twinmap
