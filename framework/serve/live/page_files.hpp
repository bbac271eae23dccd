#pragma once

#include <string_view>

namespace twinmap::serve {

// What the server sends as it is, embedded into the binary by page_files.s.in.
std::string_view getLivePage();
std::string_view getLiveStyle();
std::string_view getLiveScript();
std::string_view getChartScript();
std::string_view getOpenApi();

}  // namespace twinmap::serve
