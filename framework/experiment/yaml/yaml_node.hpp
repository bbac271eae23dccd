#pragma once

#include <string>
#include <vector>

#include "framework/base/text/source_location.hpp"

namespace twinmap {

struct YamlEntry;

/// A YAML value with its place in the file. Plain data: aliases are expanded, maps keep file order.
struct YamlNode {
  enum class Kind { kNull, kScalar, kSequence, kMap };

  Kind kind = Kind::kNull;
  std::string scalar;              ///< kScalar: the text as written, without quotes
  bool quoted = false;             ///< kScalar: written in quotes, so it is a text and no number
  std::vector<YamlNode> items;     ///< kSequence
  std::vector<YamlEntry> entries;  ///< kMap, unique keys
  SourceLocation where;

  YamlNode();
  YamlNode(const YamlNode&);
  YamlNode(YamlNode&&) noexcept;
  YamlNode& operator=(const YamlNode&);
  YamlNode& operator=(YamlNode&&) noexcept;
  ~YamlNode();

  const YamlNode* find(const std::string& key) const;
  YamlNode* find(const std::string& key);
};

struct YamlEntry {
  std::string key;
  SourceLocation key_where;
  YamlNode value;
};

YamlNode makeScalar(std::string text, bool quoted = false);
YamlNode makeMap();
YamlNode makeSequence();

/// A short list as it stands, "a list", "a map", "nothing" or the scalar's own text: what a message shows as
/// the value found.
std::string describeValue(const YamlNode& node);

/// Parses one YAML document. Throws ExperimentError for a syntax error, a duplicate key, a merge key, a tag,
/// a second document, a NUL byte, what is not UTF-8, more than a million values (aliases expanded), more than
/// 20 levels, or a key of more than 100 characters.
YamlNode parseYaml(const std::string& text, const std::string& file);

/// Reads and parses a file of at most 16 MiB; ExperimentError also where it cannot be read.
YamlNode loadYaml(const std::string& path);

/// Block-style YAML that parses to the same tree; flow style for lists and maps of scalars.
std::string writeYaml(const YamlNode& root);

/// Sets every location's key path from its place in the tree ("a.b[0].c"), starting at `key_path`.
void setKeyPaths(YamlNode& node, const std::string& key_path);

}  // namespace twinmap
