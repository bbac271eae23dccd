#include "framework/report/assets.hpp"

extern "C" {
extern const char twinmap_vega_begin[], twinmap_vega_end[];
extern const char twinmap_vega_lite_begin[], twinmap_vega_lite_end[];
extern const char twinmap_vega_embed_begin[], twinmap_vega_embed_end[];
extern const char twinmap_script_begin[], twinmap_script_end[];
extern const char twinmap_style_begin[], twinmap_style_end[];
extern const char twinmap_skeletons_begin[], twinmap_skeletons_end[];
}

namespace twinmap {
namespace {

std::string_view makeView(const char* begin, const char* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

}  // namespace

std::string_view getVegaScript() {
  return makeView(twinmap_vega_begin, twinmap_vega_end);
}

std::string_view getVegaLiteScript() {
  return makeView(twinmap_vega_lite_begin, twinmap_vega_lite_end);
}

std::string_view getVegaEmbedScript() {
  return makeView(twinmap_vega_embed_begin, twinmap_vega_embed_end);
}

std::string_view getReportScript() {
  return makeView(twinmap_script_begin, twinmap_script_end);
}

std::string_view getReportStyle() {
  return makeView(twinmap_style_begin, twinmap_style_end);
}

std::string_view getFigureSkeletons() {
  return makeView(twinmap_skeletons_begin, twinmap_skeletons_end);
}

}  // namespace twinmap
