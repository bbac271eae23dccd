#include "framework/optimal_design/make_criterion.hpp"

#include <algorithm>

namespace twinmap::experiment_design {

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
