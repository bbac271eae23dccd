#include "framework/models/fmu/package/xml_values.hpp"

#include <charconv>
#include <cstdint>
#include <cstring>

#include "framework/base/text/source_location.hpp"

namespace twinmap::fmi {
namespace {

std::string describeAttribute(const pugi::xml_node& node, const char* attribute) {
  const char* name = node.attribute("name").value();
  const std::string owner = *name == '\0' ? "" : " '" + std::string(name) + "'";
  return "<" + std::string(node.name()) + ">" + owner + ": " + attribute;
}

}  // namespace

void XmlFile::fail(const std::string& rule) const {
  throw ExperimentError(name + ": " + rule);
}

std::string requireText(const pugi::xml_node& node, const char* attribute, const XmlFile& file) {
  const pugi::xml_attribute found = node.attribute(attribute);
  if (!found) {
    file.fail(describeAttribute(node, attribute) + " is missing");
  }
  return found.value();
}

std::optional<double> findNumber(const pugi::xml_node& node, const char* attribute, const XmlFile& file) {
  const pugi::xml_attribute found = node.attribute(attribute);
  if (!found) {
    return std::nullopt;
  }
  const std::string text = found.value();
  const std::size_t begin = text.find_first_not_of(" \t\n\r+");
  const std::size_t end = text.find_last_not_of(" \t\n\r") + 1;
  double value = 0.0;
  const char* last = text.data() + end;
  const auto result = begin == std::string::npos ? std::from_chars_result{last, std::errc::invalid_argument}
                                                 : std::from_chars(text.data() + begin, last, value);
  if (result.ec != std::errc{} || result.ptr != last) {
    file.fail(describeAttribute(node, attribute) + " = '" + text + "' is not a number");
  }
  return value;
}

std::uint32_t requireIndex(const pugi::xml_node& node, const char* attribute, const XmlFile& file) {
  const std::string text = requireText(node, attribute, file);
  std::uint32_t value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc{} || result.ptr != text.data() + text.size()) {
    file.fail(describeAttribute(node, attribute) + " = '" + text + "' is not a whole number");
  }
  return value;
}

bool findFlag(const pugi::xml_node& node, const char* attribute, bool otherwise) {
  const pugi::xml_attribute found = node.attribute(attribute);
  if (!found) {
    return otherwise;
  }
  return std::strcmp(found.value(), "true") == 0 || std::strcmp(found.value(), "1") == 0;
}

}  // namespace twinmap::fmi
