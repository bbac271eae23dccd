#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/diagnosis/candidates/term_candidate.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// An experiment with terms whose coefficients are further parameters, the last ones. Their bounds lie about
/// 0, so that the centre of the box, where an equilibrium may be sought, stays where it was.
struct AugmentedExperiment {
  ExperimentSpec experiment;
  Eigen::Index added = 0;  ///< parameters behind those that were there
};

/// All candidates at once, for their derivatives at coefficients of 0: own scales are numbers. share: of a
/// coefficient's size, the half width of its bounds, by which the tolerance of its derivatives goes.
AugmentedExperiment addAll(const ExperimentSpec& experiment, const std::vector<TermCandidate>& candidates,
                           double share = 1.0);

/// One term, its own scales parameters as well; no candidate of the experiment any more. largest: of its
/// coefficient, on either side. The parameters have the names of makeParameterName().
AugmentedExperiment addTerm(const ExperimentSpec& experiment, const TermCandidate& candidate, double largest);

/// Throws ExperimentError where a term has changed the machine in each trial otherwise, as one that begins
/// with the trial's own initial state: a file has one machine for all.
void requireSharedSystem(const ExperimentSpec& experiment);

/// Of a parameter of the machine, in all trials.
void setBounds(std::size_t parameter, const Bounds& bounds, ExperimentSpec& experiment);

/// "drag_x" of "drag.x", or with digits behind it where that is taken.
std::string makeParameterName(const ModelSpec& model, const std::string& term);

}  // namespace twinmap
