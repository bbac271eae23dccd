#pragma once

#include <vector>

#include "framework/experiment/criterion_spec.hpp"
#include "framework/experiment/model/parameter_spec.hpp"
#include "framework/optimal_design/criterion.hpp"

namespace twinmap::experiment_design {

/// The criterion that an experiment asks for; the parameters it names are among `parameters`.
Criterion makeCriterion(const CriterionSpec& spec, const std::vector<ParameterSpec>& parameters);

}  // namespace twinmap::experiment_design
