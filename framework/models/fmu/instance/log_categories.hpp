#pragma once

#include <filesystem>
#include <string>

namespace twinmap::fmi {

/// Whether a log category's name says that it is about what went wrong: "logStatusError", "logStatusFatal",
/// "logStatusDiscard", "logStatusWarning" of the standard and their like. The others may be a message a call.
bool isErrorCategory(const std::string& name);

/// "file:///tmp/a%20b/resources" (RFC 3986).
std::string toFileUri(const std::filesystem::path& path);

}  // namespace twinmap::fmi
