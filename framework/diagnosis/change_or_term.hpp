#pragma once

#include <optional>
#include <vector>

#include "framework/diagnosis/problem/recorded_problem.hpp"
#include "framework/inference/inferrer.hpp"

namespace twinmap {

/// Recordings of a machine before and after what may be a change of it.
struct ChangeRecordings {
  RecordedFeatures all;                         ///< those before it, then those after it
  std::size_t before = 0;                       ///< how many are
  std::vector<InferredMeasurement> inferred{};  ///< each alone
};

/// What they say of a change of parameters.
struct ChangeEvidence {
  double log_evidence = 0.0;              ///< of those that change, the others staying, against none
  std::vector<std::size_t> parameters{};  ///< those, the one with the most evidence first
};

/// A term that the model may lack in the place of a change.
struct ChangeRival {
  MissingTerm term;  ///< `explains` of all recordings together
  double over_change =
      0.0;            ///< its log evidence less that of the change, and what choosing it among others costs
  double left = 0.0;  ///< log evidence of a change beside it
};

struct ChangeOrTerm {
  ChangeEvidence change;
  int tested = 0;  ///< terms
  std::optional<ChangeRival> rival{};
};

/// The evidence of parameters that differ in the residuals from `after` on, by the linear model. They are
/// taken one after the other, as long as each has some. sizes (p): of changes that matter, of the first
/// parameters. O(p^2 n u^2).
ChangeEvidence weighChange(const LinearizedRecordings& linear, Eigen::Index after,
                           const Eigen::VectorXd& sizes);

/// Whether one set of parameters with a further term explains recordings before and after a change. Else two
/// sets without it do so better. A rival has evidence (kTiedEvidence), more than the change has,
/// and leaves a tenth at most of what spoke for a change. So a machine that changed keeps its change,
/// also where its model lacks a term besides. Terms with states are asked where none without explains all.
/// Throws ExperimentError as requireSystem(), std::runtime_error where nothing can be simulated. Cost: a fit
/// from as many starts as recordings, two times the scores of all candidates, at most six fits with a term.
ChangeOrTerm weighChangeOrTerm(const ExperimentSpec& experiment, const ChangeRecordings& recordings);

}  // namespace twinmap
