#include "framework/serve/live/page_files.hpp"

extern "C" {
extern const char twinmap_live_page_begin[], twinmap_live_page_end[];
extern const char twinmap_live_style_begin[], twinmap_live_style_end[];
extern const char twinmap_live_script_begin[], twinmap_live_script_end[];
extern const char twinmap_live_chart_begin[], twinmap_live_chart_end[];
extern const char twinmap_open_api_begin[], twinmap_open_api_end[];
}

namespace twinmap::serve {
namespace {

std::string_view makeFileView(const char* begin, const char* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

}  // namespace

std::string_view getLivePage() {
  return makeFileView(twinmap_live_page_begin, twinmap_live_page_end);
}

std::string_view getLiveStyle() {
  return makeFileView(twinmap_live_style_begin, twinmap_live_style_end);
}

std::string_view getLiveScript() {
  return makeFileView(twinmap_live_script_begin, twinmap_live_script_end);
}

std::string_view getChartScript() {
  return makeFileView(twinmap_live_chart_begin, twinmap_live_chart_end);
}

std::string_view getOpenApi() {
  return makeFileView(twinmap_open_api_begin, twinmap_open_api_end);
}

}  // namespace twinmap::serve
