#include "framework/models/fmu/instance/value_group.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>

#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/source_location.hpp"

namespace twinmap::fmi {
namespace {

const Variable* findVariable(const ModelDescription& description, const std::string& name) {
  const auto found = std::find_if(description.variables.begin(), description.variables.end(),
                                  [&](const Variable& variable) { return variable.name == name; });
  return found == description.variables.end() ? nullptr : &*found;
}

/// Integers of "1,3" in order; empty if it is anything else.
std::vector<std::size_t> readSubscripts(const std::string& text) {
  std::vector<std::size_t> subscripts;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    part.erase(0, part.find_first_not_of(' '));
    std::size_t value = 0;
    const auto result = std::from_chars(part.data(), part.data() + part.size(), value);
    if (result.ec != std::errc{} || result.ptr != part.data() + part.size()) {
      return {};
    }
    subscripts.push_back(value);
  }
  return subscripts;
}

std::string describeSizes(const Variable& variable) {
  std::string text = variable.name + "[";
  for (std::size_t i = 0; i < variable.dimensions.size(); ++i) {
    text += (i == 0 ? "1.." : ", 1..") + std::to_string(variable.dimensions[i]);
  }
  return text + "]";
}

/// Row-major position of an element.
std::size_t calcElement(const Variable& variable, const std::vector<std::size_t>& subscripts,
                        const std::string& name) {
  std::size_t element = 0;
  bool inside = subscripts.size() == variable.dimensions.size();
  for (std::size_t i = 0; inside && i < subscripts.size(); ++i) {
    inside = subscripts[i] >= 1 && subscripts[i] <= variable.dimensions[i];
    element = element * variable.dimensions[i] + subscripts[i] - 1;
  }
  if (!inside) {
    throw ExperimentError("the FMU's variable '" + name + "' does not exist: its elements are " +
                          describeSizes(variable));
  }
  return element;
}

ValueSlot findElement(const ModelDescription& description, const std::string& name) {
  const std::size_t bracket = name.rfind('[');
  if (bracket != std::string::npos && name.back() == ']') {
    const std::vector<std::size_t> subscripts =
        readSubscripts(name.substr(bracket + 1, name.size() - bracket - 2));
    const Variable* variable = findVariable(description, name.substr(0, bracket));
    if (variable != nullptr && !subscripts.empty() && !variable->dimensions.empty()) {
      return {variable, calcElement(*variable, subscripts, name)};
    }
  }
  std::vector<std::string> names;
  for (const Variable& variable : description.variables) {
    names.push_back(variable.name);
  }
  throw ExperimentError("the FMU has no variable '" + name + "'" + suggestName(name, names));
}

/// Start values of all elements; what the model description leaves out is 0.
std::vector<double> readStart(const Variable& variable) {
  std::vector<double> values;
  std::istringstream words(variable.start);
  for (std::string word; words >> word;) {
    double value = word == "true" ? 1.0 : 0.0;
    std::from_chars(word.data() + (word[0] == '+' ? 1 : 0), word.data() + word.size(), value);
    values.push_back(value);
  }
  values.resize(variable.getSize(), values.size() == 1 ? values[0] : 0.0);
  return values;
}

/// Where the elements of each variable begin in their batch.
using Positions = std::map<std::uint32_t, std::size_t>;

std::size_t place(const Variable& variable, ValueGroup::Batch& batch, Positions& positions) {
  const auto [position, added] = positions.emplace(variable.reference, batch.values.size());
  if (added) {
    const std::vector<double> start = readStart(variable);
    batch.references.push_back(variable.reference);
    batch.values.insert(batch.values.end(), start.begin(), start.end());
  }
  return position->second;
}

}  // namespace

ValueSlot findSlot(const ModelDescription& description, const std::string& name) {
  const Variable* variable = findVariable(description, name);
  const ValueSlot slot = variable != nullptr ? ValueSlot{variable, 0} : findElement(description, name);
  if (variable != nullptr && !variable->dimensions.empty()) {
    throw ExperimentError("the FMU's variable '" + name + "' is an array: name one of its elements, " +
                          describeSizes(*variable));
  }
  if (!isNumeric(slot.variable->type)) {
    throw ExperimentError("the FMU's variable '" + name + "' is a " + toText(slot.variable->type) +
                          ", no number");
  }
  return slot;
}

ValueGroup::ValueGroup(const std::vector<ValueSlot>& slots) : count_(slots.size()) {
  std::map<Type, std::size_t> batch_of;
  std::vector<Positions> positions;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const Variable& variable = *slots[i].variable;
    const auto [found, added] = batch_of.emplace(variable.type, batches_.size());
    if (added) {
      batches_.push_back({variable.type, {}, {}, {}});
      positions.emplace_back();
    }
    Batch& batch = batches_[found->second];
    const std::size_t begin = place(variable, batch, positions[found->second]);
    batch.uses.push_back({begin + slots[i].element, i});
  }
}

}  // namespace twinmap::fmi
