#pragma once

#include <string>

#include "framework/export/model/exported_model.hpp"

namespace twinmap {

/// All numbers of a map, as docs/how-to/export-to-a-controller.md documents them: matrices as lists of rows,
/// everything finite. Throws std::runtime_error for a number that is not.
std::string makeMapJson(const ExportedModel& model);

}  // namespace twinmap
