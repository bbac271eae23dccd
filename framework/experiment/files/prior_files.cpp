#include "framework/experiment/files/prior_files.hpp"

#include <filesystem>
#include <fstream>
#include <vector>

#include "framework/base/json/json.hpp"
#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

struct StatedEstimate {
  std::vector<std::string> names;
  std::vector<double> means;
  std::vector<std::size_t> rows;  ///< of the file's covariance
  Json covariance;
};

[[noreturn]] void refuse(const YamlNode& file, const std::string& rule) {
  throw ExperimentError(file.where, file.scalar, rule);
}

/// The first line of the file as JSON.
Json readFirstEstimate(const YamlNode& file, const std::filesystem::path& folder) {
  std::ifstream stream(folder / file.scalar);
  std::string line;
  if (!stream || !std::getline(stream, line)) {
    refuse(file, "cannot be read as a prior: give a file that 'twinmap infer ... --json' wrote");
  }
  Json json = tryParseJson(line);
  if (json.is_discarded() || !json.is_object() || !json.contains("parameters") ||
      !json.contains("covariance") || !json["covariance"].is_array() ||
      json["covariance"].size() < json["parameters"].size()) {
    refuse(file,
           "has no estimate with a covariance in its first line: give a file that 'twinmap infer ... "
           "--json' wrote, of a measurement whose estimate is stated");
  }
  return json;
}

StatedEstimate selectKnown(const Json& json, const YamlNode& root) {
  const YamlNode* parameters = root.find("parameters");
  StatedEstimate estimate;
  estimate.covariance = json["covariance"];
  std::size_t row = 0;
  for (const auto& [name, values] : json["parameters"].items()) {
    if (parameters != nullptr && parameters->find(name) != nullptr && values.contains("mean")) {
      estimate.names.push_back(name);
      estimate.means.push_back(values["mean"].get<double>());
      estimate.rows.push_back(row);
    }
    ++row;
  }
  return estimate;
}

YamlNode makeJointNormal(const StatedEstimate& estimate) {
  YamlNode names = makeSequence(), means = makeSequence(), covariance = makeSequence();
  for (std::size_t i = 0; i < estimate.names.size(); ++i) {
    names.items.push_back(makeScalar(estimate.names[i]));
    means.items.push_back(makeScalar(toText(estimate.means[i])));
    for (const std::size_t column : estimate.rows) {
      covariance.items.push_back(
          makeScalar(toText(estimate.covariance.at(estimate.rows[i]).at(column).get<double>())));
    }
  }
  YamlNode joint = makeMap(), group = makeMap();
  joint.entries = {{"names", {}, names}, {"mean", {}, means}, {"covariance", {}, covariance}};
  group.entries = {{"joint_normal", {}, joint}};
  return group;
}

void setPlaces(YamlNode& node, const SourceLocation& where) {
  node.where = where;
  for (YamlEntry& entry : node.entries) {
    entry.key_where = where;
    setPlaces(entry.value, where);
  }
  for (YamlNode& item : node.items) {
    setPlaces(item, where);
  }
}

}  // namespace

void resolvePriorFiles(YamlNode& root, const std::string& path) {
  YamlNode* groups = root.find("priors");
  if (groups == nullptr) {
    return;
  }
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  for (YamlNode& group : groups->items) {
    if (group.find("from") == nullptr) {
      continue;
    }
    const YamlNode file = *group.find("from");
    const SourceLocation where = group.where;
    const Json json = readFirstEstimate(file, folder);
    StatedEstimate estimate;
    try {
      estimate = selectKnown(json, root);
      group = makeJointNormal(estimate);
    } catch (const Json::exception&) {
      refuse(file, "has an estimate whose mean or covariance is not a number");
    }
    if (estimate.names.empty()) {
      refuse(file, "states none of this experiment's parameters");
    }
    setPlaces(group, where);
  }
}

}  // namespace twinmap
