#include "framework/optimal_design/criterion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap::experiment_design {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of the variances in the mean that A-optimal and weighted designs minimise; they sum to 1.
VectorXd calcShares(const Criterion& criterion, Eigen::Index parameters) {
  return criterion.kind == Criterion::Kind::weighted
             ? VectorXd(criterion.weights / criterion.weights.sum())
             : VectorXd::Constant(parameters, 1.0 / static_cast<double>(parameters));
}

}  // namespace

double calcCost(const Criterion& criterion, const MatrixXd& information) {
  const linalg::Cholesky factor = linalg::calcCholesky(information);
  if (!factor.positive_definite) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  if (criterion.kind == Criterion::Kind::d_optimal) {
    return -2.0 * factor.lower.diagonal().array().log().mean();
  }
  if (criterion.kind == Criterion::Kind::e_optimal) {
    return -std::log(linalg::calcSymmetricEigenvalues(information)[0]);
  }
  return std::log(
      linalg::invertPositiveDefinite(information).diagonal().dot(calcShares(criterion, information.rows())));
}

using Eigen::Index;
using Eigen::VectorXd;

Criterion makeCriterion(const CriterionSpec& spec, const std::vector<ParameterSpec>& parameters) {
  if (std::holds_alternative<DOptimalSpec>(spec.kind)) {
    return {Criterion::Kind::d_optimal, {}};
  }
  if (std::holds_alternative<AOptimalSpec>(spec.kind)) {
    return {Criterion::Kind::a_optimal, {}};
  }
  if (std::holds_alternative<EOptimalSpec>(spec.kind)) {
    return {Criterion::Kind::e_optimal, {}};
  }
  Criterion criterion{Criterion::Kind::weighted, VectorXd::Zero(static_cast<Index>(parameters.size()))};
  const Name* only = std::get_if<Name>(&spec.kind);
  const std::vector<ParameterWeight> weights = only != nullptr ? std::vector<ParameterWeight>{{*only, 1.0}}
                                                               : std::get<ParameterWeights>(spec.kind).values;
  for (const ParameterWeight& weight : weights) {
    const auto found = std::find_if(parameters.begin(), parameters.end(), [&](const ParameterSpec& one) {
      return one.name.text == weight.name.text;
    });
    criterion.weights[found - parameters.begin()] = weight.weight;
  }
  return criterion;
}

}  // namespace twinmap::experiment_design
