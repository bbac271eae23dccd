#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/data/measurement/files/table.hpp"

namespace twinmap {

/// Reads a file by the extension of its name: .csv, .txt, .tsv, .dat (see readCsv), .mat (MATLAB version 4,
/// 5 or 7.3: variables that are real vectors), .h5, .hdf5 (datasets of one dimension by their path,
/// "run1/enc1"; their attribute `unit` or `units`). `wanted`: names of the columns to keep, those of them
/// that the file has; empty: all that are columns of numbers, the others are skipped with the reason.
/// Throws MeasurementError for a file that cannot be read and a wanted column that is not a column of
/// numbers.
Table readTable(const std::filesystem::path& path, const std::vector<std::string>& wanted = {},
                MissingCells missing = MissingCells::kRefuse);

/// Throws MeasurementError where a file that is to be that of a run or an experiment is a recording, by the
/// extension of its name: all of the above but .h5 and .hdf5, which maps have as well.
void refuseRecording(const std::filesystem::path& run);

}  // namespace twinmap
