#pragma once

#include <string>

namespace twinmap {

/// The JSON schema (draft 2020-12) of experiment files, for editors: keys with their meaning, types, ranges.
/// What relates several values (names, units, times) only the reader checks.
std::string makeJsonSchema();

}  // namespace twinmap
