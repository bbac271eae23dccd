#include "framework/report/sections/axis_choice.hpp"

namespace twinmap {

Choice makeParameterChoice(const std::string& name, const std::string& label,
                           const std::vector<ParameterSpec>& parameters, std::size_t chosen) {
  Choice choice{name, label, {}, chosen};
  for (const ParameterSpec& parameter : parameters) {
    choice.options.push_back(
        {parameter.name.text, makeLabel(parameter), {parameter.bounds.lower, parameter.bounds.upper}});
  }
  return choice;
}

std::map<std::string, SlotValue> makeChosenDomains() {
  return {{"x_domain", std::string("{x.domain}")}, {"y_domain", std::string("{y.domain}")}};
}

}  // namespace twinmap
