#include "framework/report/vega.hpp"

namespace twinmap {
namespace {

constexpr std::size_t kColors = 8;

Json makeEncoding(const std::string& field, const char* type, const std::string& title, const Json& more) {
  Json encoding{{"field", field}, {"type", type}, {"title", title.empty() ? Json(nullptr) : Json(title)}};
  encoding.update(more);
  return encoding;
}

}  // namespace

Json makeQuantitative(const std::string& field, const std::string& title, const Json& more) {
  return makeEncoding(field, "quantitative", title, more);
}

Json makeNominal(const std::string& field, const std::string& title, const Json& more) {
  return makeEncoding(field, "nominal", title, more);
}

Json makeDomain(double lower, double upper) {
  return {{"scale", {{"domain", {lower, upper}}, {"nice", false}, {"zero", false}}}};
}

Json makeFreeScale() {
  return {{"scale", {{"zero", false}}}};
}

Json makeLogScale() {
  return {{"scale", {{"type", "log"}, {"nice", false}, {"padding", 8}}}};
}

Json makePanelSpec(const std::string& table, int height) {
  return {{"$schema", "https://vega.github.io/schema/vega-lite/v5.json"},
          {"width", "container"},
          {"height", height},
          {"data", {{"name", table}}},
          {"params", {{{"name", "selected"}, {"value", nullptr}}}}};
}

Json makeBrush() {
  return Json::array({{{"name", "brush"}, {"select", {{"type", "interval"}}}}});
}

std::string getColor(std::size_t index) {
  return "var(--color-" + std::to_string(index % kColors) + ")";
}

Json getDash(std::size_t index) {
  const std::vector<Json> dashes{Json::array({1, 0}),       Json::array({6, 3}),  Json::array({2, 2}),
                                 Json::array({8, 3, 2, 3}), Json::array({12, 3}), Json::array({1, 4})};
  return dashes[index % dashes.size()];
}

Json makeColorScale(const std::vector<std::string>& names) {
  Json colors = Json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    colors.push_back(getColor(i));
  }
  return {{"scale", {{"domain", names}, {"range", colors}}}};
}

Json makeDashScale(const std::vector<std::string>& names) {
  Json dashes = Json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    dashes.push_back(getDash(i));
  }
  return {{"scale", {{"domain", names}, {"range", dashes}}}};
}

std::string makeLabel(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " [" + unit + "]";
}

std::string makeLabel(const ParameterSpec& parameter) {
  return makeLabel(parameter.name.text, parameter.unit);
}

}  // namespace twinmap
