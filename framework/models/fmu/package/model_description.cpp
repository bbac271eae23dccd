#include "framework/models/fmu/package/model_description.hpp"

#include <algorithm>
#include <stdexcept>

namespace twinmap::fmi {

const char* toText(Type type) {
  static constexpr const char* kNames[] = {"Float64", "Float32",     "Int8",   "UInt8",  "Int16",
                                           "UInt16",  "Int32",       "UInt32", "Int64",  "UInt64",
                                           "Boolean", "Enumeration", "String", "Binary", "Clock"};
  return kNames[static_cast<int>(type)];
}

const char* toText(Causality causality) {
  static constexpr const char* kNames[] = {
      "parameter", "calculatedParameter", "structuralParameter", "input", "output", "local", "independent",
      "dependent"};
  return kNames[static_cast<int>(causality)];
}

const char* toText(Variability variability) {
  static constexpr const char* kNames[] = {"constant", "fixed", "tunable", "discrete", "continuous"};
  return kNames[static_cast<int>(variability)];
}

const char* toText(Kind kind) {
  return kind == Kind::kCoSimulation ? "co_simulation" : "model_exchange";
}

bool isNumeric(Type type) {
  return type != Type::kString && type != Type::kBinary && type != Type::kClock;
}

std::size_t Variable::getSize() const {
  std::size_t size = 1;
  for (const std::size_t dimension : dimensions) {
    size *= dimension;
  }
  return size;
}

const Capabilities& ModelDescription::getCapabilities(Kind kind) const {
  const std::optional<Capabilities>& own = kind == Kind::kCoSimulation ? co_simulation : model_exchange;
  if (!own) {
    throw std::logic_error("the FMU has no such kind");
  }
  return *own;
}

const Variable* ModelDescription::findTimedClock() const {
  const auto found = std::find_if(variables.begin(), variables.end(),
                                  [](const Variable& variable) { return variable.timed_clock; });
  return found == variables.end() ? nullptr : &*found;
}

}  // namespace twinmap::fmi
