#pragma once

#include "framework/report/figure.hpp"
#include "framework/spec/model_spec.hpp"

namespace twinmap {

/// A choice among the parameters, whose domain is their bounds.
Choice makeParameterChoice(const std::string& name, const std::string& label,
                           const std::vector<ParameterSpec>& parameters, std::size_t chosen);

/// The axis of the true value of the parameter that is chosen.
Json makeChosenAxis(const std::string& choice);

}  // namespace twinmap
