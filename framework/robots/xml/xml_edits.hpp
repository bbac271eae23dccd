#pragma once

#include <string>
#include <vector>

#include "framework/robots/xml/xml_file.hpp"

namespace twinmap::robots {

/// As attributes have several numbers: apart by spaces, with all digits.
std::string joinNumbers(const std::vector<double>& numbers);

/// Changes of numbers in an XML file, each at its place: all other bytes stay as they are.
class XmlEdits {
 public:
  explicit XmlEdits(const XmlFile& file) : file_(file) {}

  /// Of the numbers in an attribute those that differ from what the file says; an attribute that is not there
  /// is added where a number is not 0. `node`: an element of the file.
  void setNumbers(const pugi::xml_node& node, const char* attribute, const std::vector<double>& old,
                  const std::vector<double>& numbers);

  /// Takes an attribute out, if it is there, with the space before it.
  void removeAttribute(const pugi::xml_node& node, const char* attribute);

  /// Adds an element without children as the first child of another.
  void addElement(const pugi::xml_node& parent, const std::string& text);

  /// The file with all changes.
  std::string apply() const;

 private:
  struct Edit {
    std::size_t begin, length;
    std::string text;
  };
  struct Span {
    std::size_t begin, end;
  };

  Span findStartTag(const pugi::xml_node& node) const;
  bool findValue(const Span& tag, const std::string& attribute, Span& value) const;
  void setWords(const Span& value, const std::vector<double>& old, const std::vector<double>& numbers);

  const XmlFile& file_;
  std::vector<Edit> edits_;
};

}  // namespace twinmap::robots
