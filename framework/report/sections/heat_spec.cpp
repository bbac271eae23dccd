#include "framework/report/sections/heat_spec.hpp"

namespace twinmap {

Json makeHeatSpec(const std::string& table, int rows, const Json& x, const Json& y, const Json& color,
                  const std::string& value, const std::string& light_text, const std::string& format) {
  constexpr int kRowHeight = 26, kFrame = 10;
  Json spec = makePanelSpec(table, kFrame + kRowHeight * rows);
  spec.erase("params");
  spec["encoding"] = {{"x", x}, {"y", y}};
  spec["layer"] = {
      {{"mark", {{"type", "rect"}}}, {"encoding", {{"color", color}}}},
      {{"mark", {{"type", "text"}, {"fontSize", 11}}},
       {"encoding",
        {{"text", makeQuantitative(value, value, {{"format", format}})},
         {"color", {{"condition", {{"test", light_text}, {"value", "#ffffff"}}}, {"value", "#101010"}}}}}}};
  return spec;
}

Json makeSignedColor(const std::string& field) {
  return makeQuantitative(field, field,
                          {{"scale", {{"scheme", "purpleorange"}, {"domain", {-1, 1}}, {"reverse", true}}}});
}

}  // namespace twinmap
