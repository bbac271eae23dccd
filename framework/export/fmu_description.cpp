#include "framework/export/fmu_description.hpp"

#include <fmt/core.h>

#include <set>

#include "framework/base/text/escape.hpp"
#include "framework/estimation/box_prior.hpp"
#include "framework/export/c_code/c_tables.hpp"

namespace twinmap {
namespace {

/// A variable as both versions describe it.
struct FmuVariable {
  std::string type;  ///< "Real", "Integer", "Boolean", "Enumeration", as FMI 2.0 calls them
  std::string name, unit, description, causality, variability, start;
};

constexpr const char* kStatusItems[][2] = {
    {"ok", "0"},         {"model_mismatch", "1"}, {"outside_training", "2"},
    {"at_bounds", "4"},  {"uninformative", "8"},  {"estimator_limited", "16"},
    {"not_judged", "32"}};

void addInputVariables(const ExportedModel& model, std::vector<FmuVariable>& variables) {
  const ResponseLayout& layout = model.layout;
  for (std::size_t i = 0; i < layout.output_names.size(); ++i) {
    variables.push_back({"Real", layout.output_names[i], layout.output_units[i], "measured signal", "input",
                         "continuous", "0.0"});
  }
  for (const ParameterSpec& input : model.experiment.model.inputs) {
    variables.push_back({"Real", input.name.text, input.unit, "known input of the set-up", "input",
                         "discrete", toC(0.5 * (input.bounds.lower + input.bounds.upper))});
  }
  variables.push_back({"Boolean", "trigger", "", "infers from the window that ends now where it rises",
                       "input", "discrete", "false"});
  variables.push_back({"Real", "trigger_time", "s", "infers from the window that ends then, once; 0: never",
                       "parameter", "fixed", toC(model.layout.times[model.layout.times.size() - 1])});
}

void addEstimates(const ExportedModel& model, const char* group, const char* meaning,
                  std::vector<FmuVariable>& variables) {
  const std::string kind = group;
  const PriorMoments prior = calcPriorMoments(model.experiment.model);
  Eigen::Index p = 0;
  for (const ParameterSpec& parameter : model.experiment.model.parameters) {
    const double mean = prior.mean[p], sd = prior.stddev[p];
    ++p;
    const double start = kind == "mean" ? mean
                         : kind == "sd" ? sd
                                        : mean + (kind == "lower" ? -1 : 1) * kNormal95 * sd;
    variables.push_back({"Real", kind + "." + parameter.name.text, parameter.unit, meaning, "output",
                         "discrete", toC(start)});
  }
}

/// Of what is followed over time.
void addTrack(const ExportedModel& model, std::vector<FmuVariable>& variables) {
  addEstimates(model, "track.mean", "tracked parameter", variables);
  addEstimates(model, "track.sd", "its standard deviation", variables);
  addEstimates(model, "track.lower", "lower end of its 95 % interval", variables);
  addEstimates(model, "track.upper", "upper end of its 95 % interval", variables);
  variables.push_back(
      {"Real", "track.alarm.statistic", "", "1 and above is an alarm", "output", "discrete", "0.0"});
  variables.push_back({"Real", "track.alarm.time", "s", "of the last change", "output", "discrete", "0.0"});
  variables.push_back({"Real", "track.alarm.size", "", "of the last change, in the parameter's unit",
                       "output", "discrete", "0.0"});
  variables.push_back(
      {"Real", "track.alarm.sd", "", "of that size, in the parameter's unit", "output", "discrete", "0.0"});
  variables.push_back(
      {"Integer", "track.alarms", "", "how many changes were announced", "output", "discrete", "0"});
  variables.push_back({"Integer", "track.alarm.parameter", "",
                       "that changed last, from 1; 0: none, or several at once", "output", "discrete", "0"});
}

std::vector<FmuVariable> listVariables(const ExportedModel& model, bool tracks) {
  std::vector<FmuVariable> variables;
  addInputVariables(model, variables);
  addEstimates(model, "mean", "inferred parameter", variables);
  addEstimates(model, "sd", "its standard deviation", variables);
  addEstimates(model, "lower", "lower end of its 95 % interval", variables);
  addEstimates(model, "upper", "upper end of its 95 % interval", variables);
  variables.push_back(
      {"Real", "p_value", "", "of the residual, as if the model were right", "output", "discrete", "0.0"});
  variables.push_back({"Enumeration", "status", "", "the most severe status", "output", "discrete", "32"});
  variables.push_back(
      {"Integer", "statuses", "", "all that is, the sum of their values", "output", "discrete", "0"});
  variables.push_back({"Integer", "inferences", "", "how many there have been", "output", "discrete", "0"});
  variables.push_back({"Integer", "measurement_error", "",
                       "why the last window could not be used; 0: it could", "output", "discrete", "0"});
  if (tracks) {
    addTrack(model, variables);
  }
  return variables;
}

std::string makeUnits(const std::vector<FmuVariable>& variables) {
  std::set<std::string> units;
  for (const FmuVariable& variable : variables) {
    units.insert(variable.unit);
  }
  units.erase("");
  std::string text = "  <UnitDefinitions>\n";
  for (const std::string& unit : units) {
    text += fmt::format("    <Unit name=\"{}\"/>\n", escapeHtml(unit));
  }
  return text + "  </UnitDefinitions>\n";
}

std::string makeItems(const char* indent) {
  std::string text;
  for (const auto& item : kStatusItems) {
    text += fmt::format("{}<Item name=\"{}\" value=\"{}\"/>\n", indent, item[0], item[1]);
  }
  return text;
}

std::string makeUnitAttribute(const FmuVariable& variable) {
  return variable.unit.empty() ? "" : fmt::format(" unit=\"{}\"", escapeHtml(variable.unit));
}

/// What is calculated has no start value.
bool isCalculated(const FmuVariable& variable) {
  return variable.causality == "output";
}

const char* getInitial(const FmuVariable& variable) {
  return variable.causality == "input" ? ""
         : isCalculated(variable)      ? " initial=\"calculated\""
                                       : " initial=\"exact\"";
}

std::string makeStart(const FmuVariable& variable) {
  return isCalculated(variable) ? "" : fmt::format(" start=\"{}\"", variable.start);
}

std::string makeVariable2(const FmuVariable& variable, std::size_t reference) {
  return fmt::format(
      "    <ScalarVariable name=\"{}\" valueReference=\"{}\" description=\"{}\" causality=\"{}\" "
      "variability=\"{}\"{}>\n"
      "      <{}{}{}{}/>\n    </ScalarVariable>\n",
      escapeHtml(variable.name), reference, escapeHtml(variable.description), variable.causality,
      variable.variability, getInitial(variable), variable.type,
      variable.type == "Enumeration" ? " declaredType=\"Status\"" : "", makeUnitAttribute(variable),
      makeStart(variable));
}

std::string makeVariable3(const FmuVariable& variable, std::size_t reference) {
  const std::string type = variable.type == "Real"      ? "Float64"
                           : variable.type == "Integer" ? "Int32"
                                                        : variable.type;
  return fmt::format(
      "    <{} name=\"{}\" valueReference=\"{}\" description=\"{}\" causality=\"{}\" "
      "variability=\"{}\"{}{}{}{}/>\n",
      type, escapeHtml(variable.name), reference, escapeHtml(variable.description), variable.causality,
      variable.variability, getInitial(variable), type == "Enumeration" ? " declaredType=\"Status\"" : "",
      makeUnitAttribute(variable), makeStart(variable));
}

std::string makeVariables(const std::vector<FmuVariable>& variables, int version) {
  std::string text = "  <ModelVariables>\n", outputs, initial;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    text += version == 2 ? makeVariable2(variables[i], i) : makeVariable3(variables[i], i);
    if (variables[i].causality == "output") {
      initial += version == 2 ? "" : fmt::format("    <InitialUnknown valueReference=\"{}\"/>\n", i);
      outputs += version == 2 ? fmt::format("      <Unknown index=\"{}\"/>\n", i + 1)
                              : fmt::format("    <Output valueReference=\"{}\"/>\n", i);
    }
  }
  if (version == 3) {
    text += fmt::format(
        "    <Float64 name=\"time\" valueReference=\"{}\" description=\"of the last sample\" "
        "causality=\"independent\" variability=\"continuous\" unit=\"s\"/>\n",
        variables.size());
  } else {
    outputs = "    <Outputs>\n" + outputs + "    </Outputs>\n    <InitialUnknowns>\n" + outputs +
              "    </InitialUnknowns>\n";
  }
  return text + "  </ModelVariables>\n  <ModelStructure>\n" + outputs + initial + "  </ModelStructure>\n";
}

std::string makeInterface(const FmuIdentity& identity, int version) {
  const std::string begin =
      fmt::format("  <CoSimulation modelIdentifier=\"{}\" canHandleVariableCommunicationStepSize=\"true\"",
                  identity.identifier);
  if (version == 3) {
    return begin + "/>\n";
  }
  std::string text = begin + ">\n    <SourceFiles>\n";
  for (const std::string& source : identity.sources) {
    text += fmt::format("      <File name=\"{}\"/>\n", source);
  }
  return text + "    </SourceFiles>\n  </CoSimulation>\n";
}

}  // namespace

std::string makeFmuDescription(const ExportedModel& model, const FmuIdentity& identity, int version) {
  const std::vector<FmuVariable> variables = listVariables(model, identity.tracks);
  const Eigen::VectorXd& times = model.layout.times;
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription fmiVersion=\"{}.0\" modelName=\"{}\" "
      "{}=\"{}\" description=\"{}\" generationTool=\"twinmap\" variableNamingConvention=\"structured\">\n",
      version, escapeHtml(model.experiment.name.text), version == 2 ? "guid" : "instantiationToken",
      identity.token,
      "parameters of a machine inferred from measured signals, with their standard deviations");
  text += makeInterface(identity, version) + makeUnits(variables) + "  <TypeDefinitions>\n";
  text += version == 2
              ? "    <SimpleType name=\"Status\">\n      <Enumeration>\n" + makeItems("        ") +
                    "      </Enumeration>\n    </SimpleType>\n"
              : "    <EnumerationType name=\"Status\">\n" + makeItems("      ") + "    </EnumerationType>\n";
  const double interval = model.sample_interval.value_or(times[times.size() - 1]);
  text += fmt::format(
      "  </TypeDefinitions>\n  <DefaultExperiment startTime=\"0.0\" stopTime=\"{}\" stepSize=\"{}\"/>\n",
      toC(times[times.size() - 1] + interval), toC(interval));
  return text + makeVariables(variables, version) + "</fmiModelDescription>\n";
}

std::string makeBuildDescription(const FmuIdentity& identity) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiBuildDescription fmiVersion=\"3.0\">\n"
      "  <BuildConfiguration modelIdentifier=\"{}\">\n    <SourceFileSet language=\"C99\">\n",
      identity.identifier);
  for (const std::string& source : identity.sources) {
    text += fmt::format("      <SourceFile name=\"{}\"/>\n", source);
  }
  return text +
         "    </SourceFileSet>\n    <Library name=\"m\"/>\n  </BuildConfiguration>\n</fmiBuildDescription>\n";
}

}  // namespace twinmap
