#include "framework/experiment/check/check_measurement.hpp"

#include <algorithm>

#include "framework/experiment/check/check_experiment.hpp"
#include "framework/experiment/expression/output_units.hpp"
#include "framework/experiment/expression/units.hpp"

namespace twinmap {
namespace {

void checkUnit(const ColumnSpec& column, const std::string& needed) {
  if (column.unit) {
    calcUnitConversion(*column.unit, needed, column.where);
  }
}

}  // namespace

void checkMeasurement(const MeasurementSpec& measurement, const ModelSpec& model) {
  if (measurement.time) {
    checkUnit(*measurement.time, "s");
  }
  const std::vector<std::string> outputs = collectNames(model.outputs);
  for (const MeasuredColumnSpec& measured : measurement.columns) {
    requireKnown(measured.name, outputs, "an output");
    const auto index = std::find(outputs.begin(), outputs.end(), measured.name.text) - outputs.begin();
    checkUnit(measured.column, findOutputUnit(model.outputs[index], model.system));
  }
}

}  // namespace twinmap
