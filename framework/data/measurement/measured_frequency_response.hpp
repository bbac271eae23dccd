#pragma once

#include <string>
#include <vector>

#include "framework/data/features/feature_block.hpp"
#include "framework/data/measurement/files/table.hpp"
#include "framework/experiment/measurement_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// Frequency responses as they were measured: real and imaginary parts in the places of the features that
/// they are.
struct MeasuredLines {
  Eigen::VectorXd features;          ///< d', of the features' linear form; NaN where missing
  Eigen::VectorXd stddevs;           ///< d'; NaN where the table states none
  std::vector<std::string> remarks;  ///< what is missing, a phrase each
};

/// Whether a table holds frequency responses: it has a column `frequency`, and some features are lines of
/// frequency responses. infos: of the features in their linear form.
bool isFrequencyResponse(const Table& table, const std::vector<FeatureInfo>& infos);

/// The columns of such a table, for readTable(); none where no feature is a line of a frequency response.
std::vector<std::string> listLineColumns(const MeasurementSpec& spec, const ResponseLayout& layout,
                                         const std::vector<FeatureInfo>& infos);

/// From a table with a row for each frequency (column `frequency`, Hz or the unit stated): of an output x
/// that responds to F the columns `x_real` and `x_imaginary`, or `x_magnitude` and `x_phase` (rad or the unit
/// stated), in x's unit over F's or the unit stated, and `x_sd`, the standard deviation of each of both
/// parts, if it is known. For x may stand the name of its column (MeasurementSpec::columns), or `x/F` where
/// there are several signals; where there is one response alone, the names may stand without `x_`. Lines
/// whose frequency is not there (within 1e-6), or whose cells are empty, are missing. Throws MeasurementError
/// for missing columns, a frequency that stands twice, a standard deviation that is not above 0.
MeasuredLines readFrequencyResponse(const Table& table, const MeasurementSpec& spec,
                                    const ResponseLayout& layout, const std::vector<FeatureInfo>& infos);

}  // namespace twinmap
