#include "framework/report/sections/axis_choice.hpp"

#include "framework/report/sections/samples_table.hpp"
#include "framework/report/vega.hpp"

namespace twinmap {

Choice makeParameterChoice(const std::string& name, const std::string& label,
                           const std::vector<ParameterSpec>& parameters, std::size_t chosen) {
  Choice choice{name, label, {}, chosen};
  for (const ParameterSpec& parameter : parameters) {
    choice.options.push_back({parameter.name.text, makeLabel(parameter),
                              Json::array({parameter.bounds.lower, parameter.bounds.upper})});
  }
  return choice;
}

Json makeChosenAxis(const std::string& choice) {
  return makeQuantitative(getTrueColumn("{" + choice + "}"), "{" + choice + ".label}",
                          {{"scale", {{"domain", "{" + choice + ".domain}"}, {"nice", false}}}});
}

}  // namespace twinmap
