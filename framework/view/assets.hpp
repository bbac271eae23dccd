#pragma once

#include <string_view>

namespace twinmap::view {

/// Files that the page is made of, embedded into the binary by assets.s.in: three.js with web/view.js, and
/// the style.
std::string_view getScript();
std::string_view getStyle();

}  // namespace twinmap::view
