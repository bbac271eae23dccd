#pragma once

#include "framework/data/measurement/files/table.hpp"

namespace twinmap {

/// See readTable().
Table readMatTable(const std::filesystem::path& path, const std::vector<std::string>& wanted,
                   MissingCells missing);

}  // namespace twinmap
