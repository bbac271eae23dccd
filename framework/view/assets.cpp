#include "framework/view/assets.hpp"

extern "C" {
extern const char twinmap_view_script_begin[], twinmap_view_script_end[];
extern const char twinmap_view_style_begin[], twinmap_view_style_end[];
}

namespace twinmap::view {
namespace {

std::string_view makeView(const char* begin, const char* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

}  // namespace

std::string_view getScript() {
  return makeView(twinmap_view_script_begin, twinmap_view_script_end);
}

std::string_view getStyle() {
  return makeView(twinmap_view_style_begin, twinmap_view_style_end);
}

}  // namespace twinmap::view
