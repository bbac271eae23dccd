#include <map>
#include <sstream>

#include "framework/models/fmu/package/model_description.hpp"
#include "framework/models/fmu/package/read_variables.hpp"
#include "framework/models/fmu/package/xml_values.hpp"

namespace twinmap::fmi {
namespace {

Version readVersion(const std::string& text, const XmlFile& file) {
  if (text.rfind("2.", 0) == 0) {
    return Version::k2;
  }
  if (text.rfind("3.", 0) == 0) {
    return Version::k3;
  }
  file.fail("fmiVersion = '" + text + "': only FMI 2.0 and 3.0 are supported");
}

std::optional<Capabilities> readCapabilities(const pugi::xml_node& node, Version version,
                                             const XmlFile& file) {
  if (!node) {
    return std::nullopt;
  }
  Capabilities can;
  can.model_identifier = requireText(node, "modelIdentifier", file);
  if (can.model_identifier.empty() || can.model_identifier.find('/') != std::string::npos) {
    file.fail("modelIdentifier = '" + can.model_identifier + "' is not the name of a library");
  }
  can.needs_execution_tool = findFlag(node, "needsExecutionTool");
  can.can_be_instantiated_only_once = findFlag(node, "canBeInstantiatedOnlyOncePerProcess");
  can.variable_step = findFlag(node, "canHandleVariableCommunicationStepSize");
  can.internal_step = findNumber(node, "fixedInternalStepSize", file);
  can.might_return_early = findFlag(node, "mightReturnEarlyFromDoStep");
  can.event_mode = findFlag(node, "hasEventMode");
  can.needs_completed_integrator_step = version == Version::k2
                                            ? !findFlag(node, "completedIntegratorStepNotNeeded")
                                            : findFlag(node, "needsCompletedIntegratorStep");
  can.directional_derivatives = findFlag(
      node, version == Version::k2 ? "providesDirectionalDerivative" : "providesDirectionalDerivatives");
  for (const pugi::xml_node& source : node.child("SourceFiles").children("File")) {
    can.source_files.push_back(requireText(source, "name", file));
  }
  return can;
}

BaseUnit readBaseUnit(const pugi::xml_node& node, const XmlFile& file) {
  BaseUnit unit;
  for (std::size_t i = 0; i < unit.exponents.size(); ++i) {
    unit.exponents[i] = static_cast<int>(findNumber(node, BaseUnit::kNames[i], file).value_or(0.0));
  }
  unit.factor = findNumber(node, "factor", file).value_or(1.0);
  unit.offset = findNumber(node, "offset", file).value_or(0.0);
  return unit;
}

void readUnits(const pugi::xml_node& root, const XmlFile& file, ModelDescription& model) {
  for (const pugi::xml_node& unit : root.child("UnitDefinitions").children("Unit")) {
    std::optional<BaseUnit>& base = model.units[requireText(unit, "name", file)];
    if (const pugi::xml_node node = unit.child("BaseUnit")) {
      base = readBaseUnit(node, file);
    }
  }
}

/// The derivatives of FMI 2.0 are listed by the index of their variable, counted from 1.
void readStructure2(const pugi::xml_node& structure, const XmlFile& file, ModelDescription& model) {
  for (const pugi::xml_node& unknown : structure.child("Derivatives").children("Unknown")) {
    const std::uint32_t index = requireIndex(unknown, "index", file);
    if (index < 1 || index > model.variables.size()) {
      file.fail("ModelStructure names variable " + std::to_string(index) + ", which does not exist");
    }
    model.state_derivatives.push_back(static_cast<int>(index) - 1);
  }
}

void readDependencies(const pugi::xml_node& unknown, ModelDescription& model) {
  std::istringstream words(unknown.attribute("dependencies").value());
  for (std::uint32_t reference = 0; words >> reference;) {
    model.dependencies.insert(reference);
  }
}

void readStructure3(const pugi::xml_node& structure, const XmlFile& file, ModelDescription& model) {
  std::map<std::uint32_t, int> indices;
  for (std::size_t i = 0; i < model.variables.size(); ++i) {
    indices.emplace(model.variables[i].reference, static_cast<int>(i));
  }
  for (const pugi::xml_node& node : structure.children("ContinuousStateDerivative")) {
    const auto found = indices.find(requireIndex(node, "valueReference", file));
    if (found == indices.end()) {
      file.fail("ModelStructure names a state derivative that does not exist");
    }
    model.state_derivatives.push_back(found->second);
    readDependencies(node, model);
  }
  for (const pugi::xml_node& node : structure.children("Output")) {
    readDependencies(node, model);
  }
  for (const pugi::xml_node& node : structure.children("EventIndicator")) {
    static_cast<void>(node);
    ++model.event_indicators;
  }
}

void readHead(const pugi::xml_node& root, const XmlFile& file, ModelDescription& model) {
  model.version_text = requireText(root, "fmiVersion", file);
  model.version = readVersion(model.version_text, file);
  model.model_name = root.attribute("modelName").value();
  model.description = root.attribute("description").value();
  model.generation_tool = root.attribute("generationTool").value();
  model.token = requireText(root, model.version == Version::k2 ? "guid" : "instantiationToken", file);
  model.co_simulation = readCapabilities(root.child("CoSimulation"), model.version, file);
  model.model_exchange = readCapabilities(root.child("ModelExchange"), model.version, file);
  if (!model.co_simulation && !model.model_exchange) {
    file.fail("the FMU has neither Co-Simulation nor Model Exchange");
  }
  for (const pugi::xml_node& category : root.child("LogCategories").children("Category")) {
    model.log_categories.push_back(requireText(category, "name", file));
  }
  const pugi::xml_node defaults = root.child("DefaultExperiment");
  model.default_experiment = {findNumber(defaults, "startTime", file), findNumber(defaults, "stopTime", file),
                              findNumber(defaults, "tolerance", file),
                              findNumber(defaults, "stepSize", file)};
}

}  // namespace

ModelDescription readModelDescription(const std::filesystem::path& xml, const std::string& file_name) {
  const XmlFile file{file_name + ": modelDescription.xml"};
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_file(xml.c_str());
  if (!result) {
    file.fail("is not XML: " + std::string(result.description()) + " at byte " +
              std::to_string(result.offset));
  }
  const pugi::xml_node root = document.child("fmiModelDescription");
  if (!root) {
    file.fail("has no <fmiModelDescription>");
  }
  ModelDescription model;
  readHead(root, file, model);
  readUnits(root, file, model);
  const pugi::xml_node structure = root.child("ModelStructure");
  if (model.version == Version::k2) {
    model.variables = readVariables2(root, file);
    readStructure2(structure, file, model);
    model.event_indicators =
        static_cast<std::size_t>(findNumber(root, "numberOfEventIndicators", file).value_or(0.0));
  } else {
    model.variables = readVariables3(root, file);
    readStructure3(structure, file, model);
  }
  return model;
}

}  // namespace twinmap::fmi
