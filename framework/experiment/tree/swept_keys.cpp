#include "framework/experiment/tree/swept_keys.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <set>

#include "framework/experiment/tree/read_value.hpp"

namespace twinmap {
namespace {

constexpr const char* kDots = "..";
constexpr long kMaxSweptValues = 10000, kLargest = 1L << 53;

bool parseWhole(const std::string& text, long& value) {
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  return error == std::errc() && end == last;
}

/// Appends the numbers of "a..b", both included.
void appendRange(const YamlNode& node, std::vector<YamlNode>& values) {
  const std::size_t dots = node.scalar.find(kDots);
  long first = 0, last = 0;
  if (!parseWhole(node.scalar.substr(0, dots), first) || !parseWhole(node.scalar.substr(dots + 2), last) ||
      first < -kLargest || last > kLargest || last < first || last - first >= kMaxSweptValues) {
    throw ExperimentError(node.where, node.scalar,
                          "is not a range; write first..last, whole numbers, last not below first, at most "
                          "10000 of them");
  }
  for (long number = first; number <= last; ++number) {
    values.push_back(makeScalar(std::to_string(number)));
    values.back().where = node.where;
  }
}

void appendValue(const YamlNode& node, std::vector<YamlNode>& values) {
  if (node.kind == YamlNode::Kind::kNull) {
    throw ExperimentError(node.where, "", "is an empty value of the sweep");
  }
  if (node.kind == YamlNode::Kind::kScalar && !node.quoted && isRange(node.scalar)) {
    appendRange(node, values);
  } else {
    values.push_back(node);
  }
}

std::vector<YamlNode> readValues(const YamlNode& node) {
  std::vector<YamlNode> values;
  if (node.kind == YamlNode::Kind::kScalar && !node.quoted && isRange(node.scalar)) {
    appendRange(node, values);
    return values;
  }
  requireKind(node, YamlNode::Kind::kSequence, "a list of values, or a range such as 1..10");
  if (node.items.empty()) {
    throw ExperimentError(node.where, "[]", "must list at least one value");
  }
  for (const YamlNode& item : node.items) {
    appendValue(item, values);
  }
  return values;
}

void requireDistinct(const std::vector<YamlNode>& values) {
  std::set<std::string> seen;
  for (const YamlNode& value : values) {
    if (!seen.insert(writeYaml(value)).second) {
      throw ExperimentError(value.where, describeValue(value), "is given twice in the sweep");
    }
  }
}

bool isPartOf(const std::string& whole, const std::string& key) {
  return key.rfind(whole, 0) == 0 &&
         (key.size() == whole.size() || key[whole.size()] == '.' || key[whole.size()] == '[');
}

void requireApart(const SweptKey& key, const std::vector<SweptKey>& others) {
  for (const SweptKey& other : others) {
    if (isPartOf(other.key, key.key) || isPartOf(key.key, other.key)) {
      throw ExperimentError(key.where, key.key, "overlaps with the swept key '" + other.key + "'");
    }
  }
}

}  // namespace

bool isRange(const std::string& text) {
  return text.find(kDots) != std::string::npos && std::all_of(text.begin(), text.end(), [](unsigned char c) {
           return std::isdigit(c) != 0 || c == '.' || c == '-';
         });
}

bool isSweepable(const std::string& key) {
  const std::string last = key.substr(key.rfind('.') + 1);  // npos + 1 is 0
  return key != "name" && last != "description" && !isPartOf("sweep", key);
}

void readValue(const YamlNode& node, SweptKeys& value) {
  requireKind(node, YamlNode::Kind::kMap, "a map from key paths to lists of values");
  if (node.entries.empty()) {
    throw ExperimentError(node.where, "{}", "must name at least one key path with its values");
  }
  for (const YamlEntry& entry : node.entries) {
    if (!isSweepable(entry.key)) {
      throw ExperimentError(entry.key_where, entry.key, "cannot be swept");
    }
    SweptKey key{entry.key, readValues(entry.value), entry.key_where};
    requireDistinct(key.values);
    requireApart(key, value.keys);
    value.keys.push_back(std::move(key));
  }
}

YamlNode writeValue(const SweptKeys& value) {
  YamlNode map = makeMap();
  for (const SweptKey& key : value.keys) {
    YamlNode values = makeSequence();
    values.items = key.values;
    map.entries.push_back({key.key, {}, std::move(values)});
  }
  return map;
}

}  // namespace twinmap
