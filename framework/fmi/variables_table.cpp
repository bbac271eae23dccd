#include "framework/fmi/variables_table.hpp"

#include <algorithm>
#include <vector>

#include "framework/fmi/bind_variables.hpp"
#include "framework/fmi/package.hpp"

namespace twinmap::fmi {
namespace {

using Row = std::vector<std::string>;

std::string describeType(const Variable& variable) {
  std::string text = toText(variable.type);
  for (const std::size_t size : variable.dimensions) {
    text += "[" + std::to_string(size) + "]";
  }
  return text;
}

std::string describeUse(const Variable& variable) {
  if (!isNumeric(variable.type)) {
    return "none";
  }
  if (variable.causality == Causality::kInput) {
    return "excitation";
  }
  return explainFixed(variable).empty() ? "parameter" : "output";
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

/// Columns as wide as their longest entry; the last is free.
std::string align(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], row[i].size());
    }
  }
  std::string text;
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i] + (i + 1 < row.size() ? std::string(widths[i] - row[i].size() + 2, ' ') : "");
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace

std::string makeVariablesTable(const std::string& file) {
  const Package package(file);
  const ModelDescription& model = package.getDescription();
  std::string head = "# " + model.model_name + ": FMI " + model.version_text;
  for (const Kind kind : {Kind::kCoSimulation, Kind::kModelExchange}) {
    const bool has =
        kind == Kind::kCoSimulation ? model.co_simulation.has_value() : model.model_exchange.has_value();
    head += has ? std::string(", ") + toText(kind) : "";
  }
  head += model.description.empty() ? "\n" : "\n# " + model.description + "\n";
  std::vector<Row> rows{{"name", "causality", "variability", "type", "unit", "start", "use", "description"}};
  std::transform(model.variables.begin(), model.variables.end(), std::back_inserter(rows), makeRow);
  return head + align(rows);
}

}  // namespace twinmap::fmi
