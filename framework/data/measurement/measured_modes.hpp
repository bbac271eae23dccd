#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/data/measurement/files/table.hpp"
#include "framework/experiment/measurement_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// Modes as they were identified from a measurement.
struct MeasuredModes {
  Eigen::VectorXd frequencies, damping_ratios;  ///< of the layout's modes (Hz, 1); NaN where missing
  /// Standard deviations, where the table has them; NaN where it has none.
  Eigen::VectorXd frequency_stddevs, damping_ratio_stddevs;
  std::vector<std::string> remarks;  ///< what is missing, a phrase each
};

/// The columns of a table of modes, for readTable().
std::vector<std::string> listModeColumns();

/// Modes from a table with a row each: columns `frequency` and `damping_ratio`, at least one of them, in Hz
/// and 1 or the units that the table states; their standard deviations `frequency_sd` and `damping_ratio_sd`
/// in the same units unless the table states others; `mode`, a number from 1 on, where rows are not in the
/// order of the model's modes or some are missing. Rows beyond the layout's modes are not used. Throws
/// MeasurementError for a table without such columns, numbers that no mode can have and a mode given twice.
MeasuredModes readModes(const Table& table, const ResponseLayout& layout);

/// Where the modes of a measurement stand beside its outputs: where the experiment says, else in the file of
/// the same name that ends in ".modes.csv".
std::filesystem::path findModesFile(const std::filesystem::path& measurement, const MeasurementSpec& spec);

}  // namespace twinmap
