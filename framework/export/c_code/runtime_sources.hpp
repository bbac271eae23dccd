#pragma once

#include <string>
#include <string_view>

namespace twinmap {

/// A file of runtime/ by its name, embedded into the binary by runtime.s.in. Throws std::logic_error for a
/// name that is not there.
std::string_view getRuntimeSource(std::string_view name);

/// `text` with `slot` (such as "@TABLES@") replaced everywhere.
std::string fillSlot(std::string text, std::string_view slot, std::string_view content);

}  // namespace twinmap
