#pragma once

#include <vector>

#include "framework/experiment_design/criterion.hpp"
#include "framework/spec/criterion_spec.hpp"
#include "framework/spec/parameter_spec.hpp"

namespace twinmap::experiment_design {

/// The criterion that an experiment asks for; the parameters it names are among `parameters`.
Criterion makeCriterion(const CriterionSpec& spec, const std::vector<ParameterSpec>& parameters);

}  // namespace twinmap::experiment_design
