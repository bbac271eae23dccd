#pragma once

#include <string>

#include "framework/export/c_code/c_source.hpp"

namespace twinmap {

/// sizeof(PREFIX_state) with 8-byte doubles and 4-byte ints, bytes.
std::size_t calcStateBytes(const CSource& source);

/// An upper bound of the stack that an inference takes, bytes: the local arrays and a reserve for registers.
std::size_t calcStackBytes(const CSource& source);

/// README.md of exported C: how to call it, what it needs, what its answers mean.
std::string makeCReadme(const ExportedModel& model, const COptions& options, const CSource& source);

}  // namespace twinmap
