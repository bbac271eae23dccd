#pragma once

#include <vector>

#include "framework/diagnosis/term_ranking.hpp"
#include "framework/inference/inferrer.hpp"

namespace twinmap {

/// Searched from `starts` (u x n), with the noise of the residual where its size is not known. It has no
/// point where nothing can be simulated.
CurrentFit fitFrom(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                   const Eigen::MatrixXd& starts);

/// The one with the largest evidence by a fit, of the three best that stand out; null of none. Leaves those
/// three, p: parameters of the machine. Cost: three fits.
const RankedTerm* fitBest(const CurrentFit& current, const RecordedFeatures& recordings,
                          const ScoredCandidates& scored, Eigen::Index p, std::vector<RankedTerm>& ranked);

/// Whether the recordings do not tell a term that was fitted from the best one.
bool isTied(const RankedTerm& one, const RankedTerm& best);

/// Whether what remains with a term is noise of the sizes that are supposed.
bool explains(const CurrentFit& current, const RecordedFeatures& recordings, const FittedTerm& term);

/// chi_square: without it. Rivals are those of `ranked` that are tied with it.
MissingTerm describeMissing(const RankedTerm& best, const std::vector<RankedTerm>& ranked, double chi_square);

}  // namespace twinmap
