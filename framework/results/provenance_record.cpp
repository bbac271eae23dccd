#include "framework/results/provenance_record.hpp"

#include <cmath>
#include <stdexcept>

#include "framework/base/json/json.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

Json parse(const std::filesystem::path& path) {
  const std::string text = readTextFile(path);
  if (text.empty()) {
    return nullptr;
  }
  try {
    return parseJson(text);
  } catch (const Json::parse_error& error) {
    throw std::runtime_error(path.string() + ": " + error.what());
  }
}

void appendEntries(const Json& record, const std::string& prefix, ProvenanceRecord& entries) {
  for (const auto& [key, value] : record.items()) {
    if (value.is_object()) {
      appendEntries(value, prefix + key + ": ", entries);
    } else if (!value.is_array()) {
      entries.entries.emplace_back(prefix + key,
                                   value.is_string() ? value.get<std::string>() : formatJson(value));
    }
  }
}

/// Takes what has a member of its own out of the JSON.
void takeLists(Json& json, ProvenanceRecord& record) {
  const Json seconds = json.value("seconds", Json::object());
  for (const auto& [stage, time] : seconds.items()) {
    record.seconds.emplace_back(stage, time.get<double>());
  }
  for (const auto& warning : json.value("warnings", Json::array())) {
    record.warnings.push_back(warning.get<std::string>());
  }
  json.erase("seconds");
  json.erase("warnings");
}

}  // namespace

const std::string* ProvenanceRecord::find(const std::string& key) const {
  for (const auto& [name, value] : entries) {
    if (name == key) {
      return &value;
    }
  }
  return nullptr;
}

double ProvenanceRecord::getNumber(const std::string& key) const {
  const std::string* text = find(key);
  double number = NAN;
  return text != nullptr && parseLiteral(*text, number) ? number : NAN;
}

ProvenanceRecord readProvenanceRecord(const std::filesystem::path& path) {
  Json json = parse(path);
  ProvenanceRecord record;
  if (json.is_object()) {
    takeLists(json, record);
    appendEntries(json, "", record);
  }
  return record;
}

}  // namespace twinmap
