#pragma once

#include "framework/data/measurement/files/table.hpp"

namespace twinmap {

/// Numbers of a measurement in memory, under what would be the header of their column: "enc1", "enc1 [mm]".
struct NamedColumn {
  std::string header;
  Eigen::Ref<const Eigen::VectorXd> values;
};

/// The table that a file with these columns would give; `wanted` as of readTable(). Throws MeasurementError
/// for a name that stands twice, and for a wanted column that is empty or has a number that is not finite;
/// NaN is a cell that is missing.
Table makeTable(const std::string& source, const std::vector<NamedColumn>& columns,
                const std::vector<std::string>& wanted = {}, MissingCells missing = MissingCells::kRefuse);

}  // namespace twinmap
