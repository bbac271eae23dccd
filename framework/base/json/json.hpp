#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "framework/base/json/json_fwd.hpp"

// Reading and writing are compiled once: they are a fifth of what a file that includes the library compiles.
namespace twinmap {

/// Throws Json::parse_error.
Json parseJson(std::string_view text);

/// A discarded value (Json::is_discarded) where the text is not JSON.
Json tryParseJson(std::string_view text);

/// On one line, or indented. Bytes that are no UTF-8 become U+FFFD.
std::string formatJson(const Json& json, int indent = -1);

}  // namespace twinmap
