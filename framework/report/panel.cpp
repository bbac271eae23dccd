#include "framework/report/panel.hpp"

#include <fmt/core.h>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

std::string getColor(std::size_t index) {
  constexpr std::size_t kColors = 8;  // of the palette
  return fmt::format("var(--color-{})", index % kColors);
}

std::string makeLabel(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : fmt::format("{} [{}]", name, unit);
}

std::string makeLabel(const ParameterSpec& parameter) {
  return makeLabel(parameter.name.text, parameter.unit);
}

}  // namespace twinmap
