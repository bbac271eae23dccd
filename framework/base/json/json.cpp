#include "framework/base/json/json.hpp"

namespace twinmap {

Json parseJson(std::string_view text) {
  return Json::parse(text.begin(), text.end());
}

Json tryParseJson(std::string_view text) {
  return Json::parse(text.begin(), text.end(), nullptr, false);
}

std::string formatJson(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace twinmap
