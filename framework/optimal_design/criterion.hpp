#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/experiment/criterion_spec.hpp"
#include "framework/experiment/model/parameter_spec.hpp"

namespace twinmap::experiment_design {

/// What a design is judged by: the information matrix of one point of the box, in half-widths of the box,
/// prior included.
struct Criterion {
  enum class Kind { d_optimal, a_optimal, e_optimal, weighted };
  Kind kind = Kind::d_optimal;
  Eigen::VectorXd weights;  ///< weighted: of each parameter's variance, 0 or above
};

/// The cost of one information matrix M (p x p, positive definite), to be minimised, in log units so that it
/// can be compared between designs: -log det(M) / p, log(tr(M^-1) / p), -log of the least eigenvalue of M, or
/// log(sum_i w_i (M^-1)_ii / sum_i w_i). NaN where M is not positive definite. Cost: p^3.
double calcCost(const Criterion& criterion, const Eigen::MatrixXd& information);

/// The criterion that an experiment asks for; the parameters it names are among `parameters`.
Criterion makeCriterion(const CriterionSpec& spec, const std::vector<ParameterSpec>& parameters);

}  // namespace twinmap::experiment_design
