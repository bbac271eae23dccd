#pragma once

#include <optional>
#include <pugixml.hpp>
#include <string>

namespace twinmap::fmi {

/// What messages call the file whose XML is read: "crane.fmu: modelDescription.xml".
struct XmlFile {
  std::string name;

  [[noreturn]] void fail(const std::string& rule) const;
};

/// The attribute's text; throws ExperimentError if it is not there.
std::string requireText(const pugi::xml_node& node, const char* attribute, const XmlFile& file);

/// A number in the notation of XML schema, whatever the locale; none if the attribute is not there. Throws
/// ExperimentError for another text.
std::optional<double> findNumber(const pugi::xml_node& node, const char* attribute, const XmlFile& file);

/// A whole number from 0 to 2^32 - 1; throws ExperimentError for another text or none.
std::uint32_t requireIndex(const pugi::xml_node& node, const char* attribute, const XmlFile& file);

/// "true" and "1" are true; without the attribute `otherwise`.
bool findFlag(const pugi::xml_node& node, const char* attribute, bool otherwise = false);

}  // namespace twinmap::fmi
