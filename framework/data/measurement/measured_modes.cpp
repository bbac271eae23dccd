#include "framework/data/measurement/measured_modes.hpp"

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "framework/base/text/number_text.hpp"
#include "framework/data/measurement/time_series.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr const char *kMode = "mode", *kFrequency = "frequency", *kDampingRatio = "damping_ratio";
constexpr const char *kFrequencyStddev = "frequency_sd", *kDampingRatioStddev = "damping_ratio_sd";

/// What a column of modes may hold.
struct ModeQuantity {
  const char *column, *unit;
  double least, most;
  const char* rule;
};

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr ModeQuantity kFrequencies{kFrequency, "Hz", 0.0, kNoLimit, "must be 0 or above"};
constexpr ModeQuantity kDampingRatios{kDampingRatio, "1", -1.0, 1.0,
                                      "must be from -1 to 1; give percent as 'damping_ratio [%]'"};
constexpr ModeQuantity kFrequencyStddevs{kFrequencyStddev, "Hz", 1e-300, kNoLimit, "must be above 0"};
constexpr ModeQuantity kDampingRatioStddevs{kDampingRatioStddev, "1", 1e-300, kNoLimit, "must be above 0"};

/// The row of each of the layout's modes; -1 where there is none.
std::vector<Index> findModeRows(const Table& table, Index rows, Index modes) {
  std::vector<Index> found(static_cast<std::size_t>(modes), -1);
  const Column* numbers = findColumn(table, kMode);
  for (Index row = 0; row < rows; ++row) {
    const double number = numbers != nullptr ? numbers->values[row] : static_cast<double>(row + 1);
    if (!(number >= 1.0) || number != std::round(number)) {
      throw MeasurementError(
          fmt::format("{}: column '{}' has {} in row {}; must be 1, 2, ... from the lowest mode",
                      table.source, kMode, toText(number), row + 1));
    }
    if (number > static_cast<double>(modes)) {
      continue;
    }
    Index& place = found[static_cast<std::size_t>(number) - 1];
    if (place >= 0) {
      throw MeasurementError(fmt::format("{}: column '{}' has {} in rows {} and {}; each mode has one row",
                                         table.source, kMode, toText(number), place + 1, row + 1));
    }
    place = row;
  }
  return found;
}

/// The numbers of a column for the modes; NaN where the column or the row is missing.
VectorXd takeModes(const Table& table, const std::vector<Index>& rows, const ModeQuantity& quantity) {
  VectorXd taken =
      VectorXd::Constant(static_cast<Index>(rows.size()), std::numeric_limits<double>::quiet_NaN());
  const Column* column = findColumn(table, quantity.column);
  if (column == nullptr) {
    return taken;
  }
  const VectorXd values =
      readValues(table, {quantity.column, {}, {}}, quantity.unit, 0, column->values.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] < 0) {
      continue;
    }
    const double value = values[rows[i]];
    if (value < quantity.least || value > quantity.most) {
      throw MeasurementError(fmt::format("{}: column '{}' has {} in row {}; {}", table.source,
                                         quantity.column, toText(column->values[rows[i]]), rows[i] + 1,
                                         quantity.rule));
    }
    taken[static_cast<Index>(i)] = value;
  }
  return taken;
}

void remark(const VectorXd& found, const char* what, std::vector<std::string>& remarks) {
  if (const Index missing = found.array().isNaN().count(); missing > 0) {
    remarks.push_back(fmt::format("{} of {} {} of modes", missing, found.size(), what));
  }
}

}  // namespace

std::vector<std::string> listModeColumns() {
  return {kMode, kFrequency, kDampingRatio, kFrequencyStddev, kDampingRatioStddev};
}

MeasuredModes readModes(const Table& table, const ResponseLayout& layout) {
  const Column *frequency = findColumn(table, kFrequency), *damping = findColumn(table, kDampingRatio);
  if (frequency == nullptr && damping == nullptr) {
    throw MeasurementError(
        table.source + ": has no column 'frequency' or 'damping_ratio'; a table of modes has a row for each");
  }
  const Index count = (frequency != nullptr ? frequency : damping)->values.size();
  for (const std::string& name : listModeColumns()) {
    if (const Column* column = findColumn(table, name)) {
      requireLength(table, *column, count);
    }
  }
  const std::vector<Index> rows = findModeRows(table, count, layout.modes);
  MeasuredModes modes;
  modes.frequencies = takeModes(table, rows, kFrequencies);
  modes.damping_ratios = takeModes(table, rows, kDampingRatios);
  modes.frequency_stddevs = takeModes(table, rows, kFrequencyStddevs);
  modes.damping_ratio_stddevs = takeModes(table, rows, kDampingRatioStddevs);
  remark(modes.frequencies, "frequencies", modes.remarks);
  remark(modes.damping_ratios, "damping ratios", modes.remarks);
  return modes;
}

std::filesystem::path findModesFile(const std::filesystem::path& measurement, const MeasurementSpec& spec) {
  return spec.modes ? measurement.parent_path() / spec.modes->text
                    : std::filesystem::path(measurement).replace_extension(".modes.csv");
}

}  // namespace twinmap
