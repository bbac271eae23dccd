#pragma once

#include <pugixml.hpp>
#include <string>

#include "framework/robots/robot.hpp"

namespace twinmap::robots {

/// An XML file that knows the lines of its elements. Errors are ExperimentErrors with file and line.
class XmlFile {
 public:
  /// Reads a file of at most 16 MiB. Throws for broken XML, with the line.
  explicit XmlFile(const std::string& path);

  const std::string& getPath() const { return path_; }
  const std::string& getText() const { return text_; }
  pugi::xml_node getRoot() const { return document_.document_element(); }
  int getLine(const pugi::xml_node& node) const { return calcLine(node.offset_debug()); }

  [[noreturn]] void fail(const pugi::xml_node& node, const std::string& what) const;

  /// An attribute that must be there.
  std::string getText(const pugi::xml_node& node, const char* attribute) const;
  /// Of an attribute: a number, or three apart by spaces; `fallback` where it is not there.
  double getNumber(const pugi::xml_node& node, const char* attribute, const double* fallback = nullptr) const;
  Vector getVector(const pugi::xml_node& node, const char* attribute, const Vector& fallback) const;

 private:
  int calcLine(std::ptrdiff_t offset) const;
  std::vector<double> readNumbers(const pugi::xml_node& node, const char* attribute, std::size_t count) const;

  std::string path_, text_;
  std::vector<std::ptrdiff_t> line_ends_;
  pugi::xml_document document_;
};

}  // namespace twinmap::robots
