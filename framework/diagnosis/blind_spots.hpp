#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/diagnosis/candidates/term_candidate.hpp"
#include "framework/diagnosis/problem/recorded_problem.hpp"
#include "framework/diagnosis/scored_candidates.hpp"

namespace twinmap {

/// How blind a test is to a term before any measurement.
struct BlindSpot {
  TermCandidate candidate;
  double noticed = 0.0;      ///< size that is found in 95 % of measurements; infinite where it never is
  Eigen::VectorXd shifts{};  ///< p: how far the parameters have moved by then, in sds
};

/// Of candidates that were scored, where a model has p parameters of the machine.
std::vector<BlindSpot> calcBlindSpots(const ScoredCandidates& scored, Eigen::Index p, double level);

/// Shifts (p, in sds of scored) without those by more than bounds allow, 0 instead: such a parameter is not
/// determined beside others, whatever is missing.
Eigen::VectorXd keepWithinBounds(const Eigen::VectorXd& shifts, const ScoredCandidates& scored,
                                 const std::vector<ParameterSpec>& parameters);

/// Of all candidates at the centre of the box; by the linear model, within the bounds. Throws ExperimentError
/// where the size of the noise is unknown.
std::vector<BlindSpot> calcBlindSpots(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                                      double level);

}  // namespace twinmap
