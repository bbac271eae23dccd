#include <algorithm>
#include <iostream>
#include <vector>

#include "framework/base/text/text_tables.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/models/fmu/package/package.hpp"
#include "framework/models/fmu/run/bind_variables.hpp"

namespace twinmap::cli {
namespace {

using fmi::Kind;
using fmi::Variable;

using Row = std::vector<std::string>;

std::string describeType(const Variable& variable) {
  std::string text = toText(variable.type);
  for (const std::size_t size : variable.dimensions) {
    text += "[" + std::to_string(size) + "]";
  }
  return text;
}

std::string describeUse(const Variable& variable) {
  if (!fmi::isNumeric(variable.type)) {
    return "none";
  }
  if (variable.causality == fmi::Causality::kInput) {
    return "excitation";
  }
  return fmi::explainFixed(variable).empty() ? "parameter" : "output";
}

Row makeRow(const Variable& variable) {
  constexpr std::size_t kLongestStart = 24;  // characters; of arrays and texts
  const std::string& start = variable.start;
  return {variable.name,
          toText(variable.causality),
          toText(variable.variability),
          describeType(variable),
          variable.unit.empty() ? "-" : variable.unit,
          start.empty()                  ? "-"
          : start.size() > kLongestStart ? start.substr(0, kLongestStart) + "..."
                                         : start,
          describeUse(variable),
          variable.description};
}

}  // namespace

void printVariables(const std::string& file) {
  const fmi::Package package(file);
  const fmi::ModelDescription& model = package.getDescription();
  std::string head = "# " + model.model_name + ": FMI " + model.version_text;
  for (const Kind kind : {Kind::kCoSimulation, Kind::kModelExchange}) {
    const bool has =
        kind == Kind::kCoSimulation ? model.co_simulation.has_value() : model.model_exchange.has_value();
    head += has ? std::string(", ") + toText(kind) : "";
  }
  head += model.description.empty() ? "\n" : "\n# " + model.description + "\n";
  std::vector<Row> rows{{"name", "causality", "variability", "type", "unit", "start", "use", "description"}};
  std::transform(model.variables.begin(), model.variables.end(), std::back_inserter(rows), makeRow);
  std::cout << head << alignRows(rows, rows.front().size());
}

}  // namespace twinmap::cli
