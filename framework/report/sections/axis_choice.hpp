#pragma once

#include "framework/experiment/model/model_spec.hpp"
#include "framework/report/figure.hpp"

namespace twinmap {

/// A choice among the parameters, whose domain is their bounds.
Choice makeParameterChoice(const std::string& name, const std::string& label,
                           const std::vector<ParameterSpec>& parameters, std::size_t chosen);

/// The domains of the axes "{x}" and "{y}" that the reader chooses, for the slots x_domain and y_domain.
std::map<std::string, SlotValue> makeChosenDomains();

}  // namespace twinmap
