#include "framework/models/fmu/package/read_variables.hpp"

#include <cstring>

namespace twinmap::fmi {
namespace {

template <class Enum, std::size_t N>
Enum readEnum(const pugi::xml_node& node, const char* attribute, const Enum (&values)[N], Enum otherwise,
              const XmlFile& file) {
  const pugi::xml_attribute found = node.attribute(attribute);
  if (!found) {
    return otherwise;
  }
  for (const Enum value : values) {
    if (std::strcmp(toText(value), found.value()) == 0) {
      return value;
    }
  }
  file.fail("variable '" + std::string(node.attribute("name").value()) + "': " + attribute + " = '" +
            found.value() + "' is none of the standard's");
}

constexpr Causality kCausalities[] = {Causality::kParameter,
                                      Causality::kCalculatedParameter,
                                      Causality::kStructuralParameter,
                                      Causality::kInput,
                                      Causality::kOutput,
                                      Causality::kLocal,
                                      Causality::kIndependent,
                                      Causality::kDependent};
constexpr Variability kVariabilities[] = {Variability::kConstant, Variability::kFixed, Variability::kTunable,
                                          Variability::kDiscrete, Variability::kContinuous};

bool isParameter(Causality causality) {
  return causality == Causality::kParameter || causality == Causality::kCalculatedParameter ||
         causality == Causality::kStructuralParameter;
}

Variability chooseVariability(const Variable& variable) {
  if (isParameter(variable.causality)) {
    return Variability::kFixed;
  }
  return variable.type == Type::kFloat64 || variable.type == Type::kFloat32 ? Variability::kContinuous
                                                                            : Variability::kDiscrete;
}

Initial readInitial(const pugi::xml_node& node, const Variable& variable, const XmlFile& file) {
  const std::string text = node.attribute("initial").value();
  if (text.empty()) {
    return chooseInitial(variable.causality, variable.variability);
  }
  if (text != "exact" && text != "approx" && text != "calculated") {
    file.fail("variable '" + variable.name + "': initial = '" + text + "' is none of the standard's");
  }
  return text == "exact" ? Initial::kExact : text == "approx" ? Initial::kApprox : Initial::kCalculated;
}

/// The attribute of the variable, else of its declared type.
pugi::xml_node choose(const pugi::xml_node& typed, const pugi::xml_node& type_node, const char* attribute) {
  return typed.attribute(attribute) ? typed : type_node;
}

}  // namespace

Initial chooseInitial(Causality causality, Variability variability) {
  if (causality == Causality::kInput || causality == Causality::kIndependent) {
    return Initial::kNone;
  }
  const bool given = causality == Causality::kParameter || causality == Causality::kStructuralParameter;
  return given || variability == Variability::kConstant ? Initial::kExact : Initial::kCalculated;
}

void readAttributes(const pugi::xml_node& node, const pugi::xml_node& typed, const pugi::xml_node& type_node,
                    const XmlFile& file, Variable& variable) {
  variable.name = requireText(node, "name", file);
  variable.reference = requireIndex(node, "valueReference", file);
  variable.description = node.attribute("description").value();
  variable.causality = readEnum(node, "causality", kCausalities, Causality::kLocal, file);
  variable.variability = readEnum(node, "variability", kVariabilities, chooseVariability(variable), file);
  variable.initial = readInitial(node, variable, file);
  variable.unit = choose(typed, type_node, "unit").attribute("unit").value();
  variable.start = typed.attribute("start").value();
  variable.relative_quantity = findFlag(choose(typed, type_node, "relativeQuantity"), "relativeQuantity");
  if (variable.type == Type::kFloat64 || variable.type == Type::kFloat32) {
    variable.minimum = findNumber(choose(typed, type_node, "min"), "min", file);
    variable.maximum = findNumber(choose(typed, type_node, "max"), "max", file);
    variable.nominal = findNumber(choose(typed, type_node, "nominal"), "nominal", file);
  }
}

}  // namespace twinmap::fmi
