#include "framework/inference/known_value.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/experiment/check/known_names.hpp"

namespace twinmap {
namespace {

double findValue(const ParameterSpec& input, const std::vector<KnownValue>& values) {
  const auto has_name = [&](const KnownValue& value) { return value.name == input.name.text; };
  const auto found = std::find_if(values.begin(), values.end(), has_name);
  if (found == values.end()) {
    throw ExperimentError(
        fmt::format("the input '{}' is not given; must be, in {} within [{}, {}] (--set {}=VALUE)",
                    input.name.text, input.unit.empty() ? "its unit" : input.unit, input.bounds.lower,
                    input.bounds.upper, input.name.text));
  }
  if (std::count_if(values.begin(), values.end(), has_name) > 1) {
    throw ExperimentError(fmt::format("the input '{}' is given twice", input.name.text));
  }
  if (!(found->value >= input.bounds.lower && found->value <= input.bounds.upper)) {
    throw ExperimentError(
        fmt::format("the input {}={}: must be within the bounds [{}, {}] that the map was trained on",
                    input.name.text, found->value, input.bounds.lower, input.bounds.upper));
  }
  return found->value;
}

}  // namespace

KnownValue parseKnownValue(const std::string& text, const std::string& option) {
  const std::size_t equals = text.find('=');
  KnownValue known{text.substr(0, equals), 0.0};
  if (equals == std::string::npos || !parseLiteral(text.substr(equals + 1), known.value)) {
    throw ExperimentError(option + " " + text + ": must be NAME=NUMBER");
  }
  return known;
}

std::vector<KnownValue> parseKnownValues(const std::vector<std::string>& texts, const std::string& option) {
  std::vector<KnownValue> values;
  for (const std::string& text : texts) {
    values.push_back(parseKnownValue(text, option));
  }
  return values;
}

Eigen::VectorXd collectKnown(const std::vector<ParameterSpec>& inputs,
                             const std::vector<KnownValue>& values) {
  const std::vector<std::string> names = collectNames(inputs);
  for (const KnownValue& value : values) {
    if (std::find(names.begin(), names.end(), value.name) == names.end()) {
      throw ExperimentError("'" + value.name + "' is not an input of this experiment" +
                            suggestName(value.name, names));
    }
  }
  Eigen::VectorXd known(static_cast<Eigen::Index>(inputs.size()));
  for (Eigen::Index i = 0; i < known.size(); ++i) {
    known[i] = findValue(inputs[static_cast<std::size_t>(i)], values);
  }
  return known;
}

}  // namespace twinmap
