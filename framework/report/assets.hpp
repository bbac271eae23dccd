#pragma once

#include <string_view>

namespace twinmap {

/// Files that the page is made of, embedded into the binary by assets.s.in.
std::string_view getVegaScript();
std::string_view getVegaLiteScript();
std::string_view getVegaEmbedScript();
std::string_view getReportScript();
std::string_view getReportStyle();

/// A JSON object: each skeleton of web/figures by its name.
std::string_view getFigureSkeletons();

}  // namespace twinmap
