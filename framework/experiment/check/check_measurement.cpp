#include "framework/experiment/check/check_measurement.hpp"

#include <algorithm>

#include "framework/base/text/number_text.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/expression/units.hpp"
#include "framework/experiment/model/output_units.hpp"

namespace twinmap {
namespace {

void checkUnit(const ColumnSpec& column, const std::string& needed) {
  if (column.unit) {
    calcUnitConversion(*column.unit, needed, column.where);
  }
}

std::string getUnit(const Name& output, const ModelSpec& model) {
  const std::vector<std::string> outputs = collectNames(model.outputs);
  requireKnown(output, outputs, "an output");
  const auto index = std::find(outputs.begin(), outputs.end(), output.text) - outputs.begin();
  return findOutputUnit(model.outputs[static_cast<std::size_t>(index)], model.system);
}

void checkColumn(const MeasuredColumnSpec& measured, const std::string& unit) {
  if (measured.column) {
    checkUnit(*measured.column, unit);
  }
  if (measured.time) {
    checkUnit(*measured.time, "s");
  }
  double number = 0.0;
  if (!parseLiteral(measured.delay.text, number)) {
    throw ExperimentError(
        measured.delay.where, measured.delay.text,
        "must be a number of seconds; a delay that nobody knows is one of a measured excitation "
        "(excitation.NAME.tables[].measured.delay)");
  }
}

/// What wraps has a turn: that of its unit, or of the range that it counts in.
void checkUnwrap(const Name& output, const MeasurementSpec& measurement, const ModelSpec& model) {
  const std::string unit = getUnit(output, model);
  const bool counts =
      std::any_of(measurement.ranges.begin(), measurement.ranges.end(),
                  [&](const MeasuredRangeSpec& range) { return range.name.text == output.text; });
  if (!counts && !findWholeTurn(unit)) {
    throw ExperimentError(output.where, output.text,
                          "is in '" + unit +
                              "', which is not a unit of angles: give the numbers that it counts between as "
                              "measurement.range, such as [0, 4096]");
  }
}

}  // namespace

void checkMeasurement(const MeasurementSpec& measurement, const ModelSpec& model) {
  if (measurement.time) {
    checkUnit(*measurement.time, "s");
  }
  for (const MeasuredColumnSpec& measured : measurement.columns) {
    checkColumn(measured, getUnit(measured.name, model));
  }
  for (const MeasuredRangeSpec& range : measurement.ranges) {
    getUnit(range.name, model);
  }
  for (const Name& output : measurement.unwrap) {
    checkUnwrap(output, measurement, model);
  }
}

}  // namespace twinmap
