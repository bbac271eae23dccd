#include "framework/experiment/tree/read_value.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/base/text/trim.hpp"

namespace twinmap {
namespace {

bool hasLeadingZero(const std::string& text) {
  const std::size_t first = text.find_first_not_of("+-");
  return first != std::string::npos && first + 1 < text.size() && text[first] == '0' &&
         std::isdigit(static_cast<unsigned char>(text[first + 1])) != 0;
}

const std::string& requireScalar(const YamlNode& node, const std::string& expected) {
  requireKind(node, YamlNode::Kind::kScalar, expected);
  return node.scalar;
}

double readInteger(const YamlNode& node, const NumberRule& rule) {
  double number = 0.0;
  readValue(node, number, rule);
  if (number != std::floor(number)) {
    throw ExperimentError(node.where, node.scalar, "must be a whole number");
  }
  return number;
}

}  // namespace

void requireKind(const YamlNode& node, YamlNode::Kind kind, const std::string& expected) {
  if (node.kind != kind) {
    throw ExperimentError(node.where, describeValue(node), "must be " + expected);
  }
}

void requireLength(const YamlNode& node, std::size_t count) {
  const bool is_list = node.kind == YamlNode::Kind::kSequence;
  if (is_list && node.items.size() == count) {
    return;
  }
  throw ExperimentError(
      node.where, describeValue(node),
      "must be a list of " + std::to_string(count) + " values" +
          (is_list ? ", not of " + std::to_string(node.items.size()) : "") +
          (is_list && node.items.size() > count ? "; decimals are written with a point, as 0.1" : ""));
}

void requireIdentifier(const Name& name) {
  const auto is_word = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  const bool valid = !name.text.empty() && std::isdigit(static_cast<unsigned char>(name.text[0])) == 0 &&
                     std::all_of(name.text.begin(), name.text.end(), is_word);
  if (!valid) {
    throw ExperimentError(name.where, name.text,
                          "is not a valid name; use letters, digits and '_', beginning with no digit");
  }
}

void readValue(const YamlNode& node, double& value, const NumberRule& rule) {
  const std::string text = describeValue(node);
  if (node.kind == YamlNode::Kind::kScalar && hasLeadingZero(text)) {
    throw ExperimentError(node.where, text, "begins with 0, which some read as octal; write it without");
  }
  double number = 0.0;
  const bool is_number =
      node.kind == YamlNode::Kind::kScalar && !node.quoted && parseLiteral(node.scalar, number);
  const bool in_range =
      number <= rule.maximum && (rule.minimum_allowed ? number >= rule.minimum : number > rule.minimum);
  if (!is_number || !in_range) {
    throw ExperimentError(node.where, text, rule.text);
  }
  value = number;
}

void readValue(const YamlNode& node, int& value, const NumberRule& rule) {
  NumberRule bounded = rule;
  bounded.minimum = std::max(rule.minimum, -1e9);
  bounded.maximum = std::min(rule.maximum, 1e9);
  value = static_cast<int>(readInteger(node, bounded));
}

void readValue(const YamlNode& node, std::uint64_t& value) {
  constexpr double kLargest =
      9007199254740991.0;  // 2^53 - 1: from 2^53, doubles stand for their neighbours too
  constexpr NumberRule kSeed{0.0, kLargest, true, "must be a whole number from 0 to 9007199254740991"};
  value = static_cast<std::uint64_t>(readInteger(node, kSeed));
}

void readValue(const YamlNode& node, bool& value) {
  const bool is_plain = node.kind == YamlNode::Kind::kScalar && !node.quoted;
  if (!is_plain || (node.scalar != "true" && node.scalar != "false")) {
    throw ExperimentError(node.where, describeValue(node), "must be true or false");
  }
  value = node.scalar == "true";
}

void readValue(const YamlNode& node, std::string& value) {
  value = requireScalar(node, "a text");
}

void readValue(const YamlNode& node, Expression& value) {
  const std::string text = trim(requireScalar(node, "a number or an expression"));
  if (text.empty()) {
    throw ExperimentError(node.where, "", "must be a number or an expression");
  }
  if (hasLeadingZero(text)) {
    throw ExperimentError(node.where, text, "begins with 0, which some read as octal; write it without");
  }
  value = {text, node.where};
}

void readValue(const YamlNode& node, Name& value) {
  value = {requireScalar(node, "a name"), node.where};
  if (value.text.empty()) {
    throw ExperimentError(node.where, "", "must be a name");
  }
}

void readValue(const YamlNode& node, Bounds& value) {
  std::array<double, 2> ends{};
  readValue(node, ends);
  if (!(ends[0] < ends[1])) {
    throw ExperimentError(node.where, "[" + node.items[0].scalar + ", " + node.items[1].scalar + "]",
                          "must be [lower, upper] with lower below upper");
  }
  value = {ends[0], ends[1], node.where};
}

void readValue(const YamlNode& node, ColumnSpec& value) {
  value = parseColumn(requireScalar(node, "a column, 'NAME' or 'NAME [unit]'"), node.where);
  if (value.name.empty()) {
    throw ExperimentError(node.where, node.scalar, "must name a column, 'NAME' or 'NAME [unit]'");
  }
}

namespace {

bool isAutomatic(const YamlNode& node) {
  return node.kind == YamlNode::Kind::kScalar && node.scalar == "automatic";
}

}  // namespace

void readValue(const YamlNode& node, ComponentCount& value) {
  constexpr NumberRule kCountOrAutomatic{kCount.minimum, kCount.maximum, true,
                                         "must be automatic or a whole number from 1 to 10000000"};
  value.number.reset();
  if (!isAutomatic(node)) {
    readValue(node, value.number, kCountOrAutomatic);
  }
}

void readValue(const YamlNode& node, SampleCount& value) {
  constexpr NumberRule kCountOrAutomatic{kSampleCount.minimum, kSampleCount.maximum, true,
                                         "must be automatic or a whole number from 1 to 1000000"};
  value.automatic = isAutomatic(node);
  if (!value.automatic) {
    readValue(node, value.number, kCountOrAutomatic);
  }
}

void readValue(const YamlNode& node, Tolerance& value, const NumberRule& rule) {
  value.automatic = isAutomatic(node);
  value.where = node.where;
  if (!value.automatic) {
    readValue(node, value.value, rule);
  }
}

void readValue(const YamlNode& node, NoiseStddev& value, const NumberRule& rule) {
  value.unknown = node.kind == YamlNode::Kind::kScalar && !node.quoted && node.scalar == "unknown";
  value.where = node.where;
  if (value.unknown) {
    value.value = 1.0;
  } else {
    const NumberRule or_unknown{rule.minimum, rule.maximum, rule.minimum_allowed,
                                "must be a number, 0 or above, or unknown"};
    readValue(node, value.value, or_unknown);
  }
}

void readValue(const YamlNode& node, ParameterWeights& value) {
  requireKind(node, YamlNode::Kind::kMap, "a map from parameters to weights");
  value.values.clear();
  for (const YamlEntry& entry : node.entries) {
    ParameterWeight one{{entry.key, entry.key_where}, 0.0};
    readValue(entry.value, one.weight, kPositive);
    value.values.push_back(one);
  }
  if (value.values.empty()) {
    throw ExperimentError(node.where, "{}", "must name at least one parameter");
  }
}

void readValue(const YamlNode& node, FreeValues& value) {
  constexpr const char* kExpected = "[lower, upper], or {each: [lower, upper]}";
  requireKind(node, YamlNode::Kind::kMap, "a map from key paths below excitation to bounds");
  value.values.clear();
  for (const YamlEntry& entry : node.entries) {
    FreeValue one{{entry.key, entry.key_where}, entry.value.kind == YamlNode::Kind::kMap, {}};
    const YamlNode* bounds = one.each ? entry.value.find("each") : &entry.value;
    if (bounds == nullptr || (one.each && entry.value.entries.size() != 1)) {
      throw ExperimentError(entry.value.where, "", std::string("must be ") + kExpected);
    }
    readValue(*bounds, one.bounds);
    value.values.push_back(one);
  }
  if (value.values.empty()) {
    throw ExperimentError(node.where, "{}", "must name at least one value of the excitation");
  }
}

void FieldReader::setMap(const std::string& key, YamlNode value) {
  written_out_ = makeMap();
  written_out_.where = value.where = node_->where;
  written_out_.entries.push_back({key, node_->where, std::move(value)});
  node_ = &written_out_;
}

void FieldReader::scalarIsKey() {
  if (node_->kind == YamlNode::Kind::kScalar) {
    setMap(node_->scalar, makeMap());
  }
}

void FieldReader::scalarIsValueOf(const char* key) {
  if (node_->kind == YamlNode::Kind::kScalar) {
    setMap(key, *node_);
  }
}

const YamlNode* FieldReader::take(const char* key) {
  requireKind(*node_, YamlNode::Kind::kMap, "a map, such as {" + std::string(key) + ": ...}");
  known_.emplace_back(key);
  return node_->find(key);
}

const YamlNode* FieldReader::takeRequired(const char* key, const char* what) {
  const YamlNode* node = take(key);
  if (node == nullptr) {
    missing_.emplace_back(key, what);
  }
  return node;
}

void FieldReader::requireOne(int given, const char* text, std::initializer_list<const char*> keys) {
  if (given != 1) {
    rule(false, (text + (" " + listNames({keys.begin(), keys.end()}))).c_str());
  }
}

void FieldReader::rule(bool holds, const char* text) {
  if (!holds && broken_rule_.empty()) {
    broken_rule_ = text;
  }
}

void FieldReader::refuse(const YamlEntry& unknown) const {
  std::string suggestion = suggestName(unknown.key, known_);
  if (suggestion.empty() && missing_.size() == 1) {
    suggestion = "; did you mean '" + missing_.front().first + "', which is missing?";
  }
  throw ExperimentError(unknown.key_where, unknown.key,
                        "is not a key here" + suggestion + " (known: " + listNames(known_) + ")");
}

void FieldReader::finish() const {
  if (is_value_) {
    return;
  }
  requireKind(*node_, YamlNode::Kind::kMap, "a map");
  for (const YamlEntry& entry : node_->entries) {
    if (std::find(known_.begin(), known_.end(), entry.key) == known_.end()) {
      refuse(entry);
    }
  }
  if (!missing_.empty()) {
    const auto& [key, what] = missing_.front();
    throw ExperimentError(node_->where, "",
                          "needs the key '" + key + "'" + (what.empty() ? "" : " (" + what + ")"));
  }
  if (!broken_rule_.empty()) {
    throw ExperimentError(node_->where, "", broken_rule_);
  }
}

}  // namespace twinmap
