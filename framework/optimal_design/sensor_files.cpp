#include "framework/optimal_design/sensor_files.hpp"

#include <fmt/core.h>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/experiment/tree/overrides.hpp"

namespace twinmap::experiment_design {
namespace {

using Eigen::Index;

void addColumns(const SensorDesign& design, CsvRow& header) {
  for (const ParameterSpec& parameter : design.parameters) {
    header.push_back("sd_" + parameter.name.text);
  }
}

void addNumbers(const JudgedSubset& judged, CsvRow& row) {
  row.push_back(toText(judged.cost));
  for (const auto& stddev : judged.stddev.rowwise()) {
    row.push_back(toText(stddev.mean()));
  }
}

std::string makeSensorsCsv(const SensorDesign& design) {
  std::vector<CsvRow> rows{{"count", "outputs", "criterion"}};
  addColumns(design, rows[0]);
  for (const JudgedSubset& judged : design.by_outputs) {
    rows.push_back({std::to_string(judged.subset.size()), nameOutputs(design, judged.subset)});
    addNumbers(judged, rows.back());
  }
  return makeCsv(rows);
}

std::string makeTimesCsv(const SensorDesign& design) {
  std::vector<CsvRow> rows{{"count", "criterion"}};
  addColumns(design, rows[0]);
  for (const JudgedSubset& judged : design.by_times) {
    rows.push_back({std::to_string(judged.subset.size())});
    addNumbers(judged, rows.back());
  }
  return makeCsv(rows);
}

void addEntry(YamlNode& map, const std::string& key, YamlNode value) {
  map.entries.push_back({key, {}, std::move(value)});
}

/// Times first to last of the grid, each `interval` after the one before.
YamlNode makeSamples(const SensorDesign& design, Index first, Index last) {
  const double interval = design.times.size() > 1 ? design.times[1] - design.times[0] : 1.0;
  YamlNode outputs = makeSequence();
  for (const Index output : design.chosen_outputs.subset) {
    outputs.items.push_back(makeScalar(design.outputs[static_cast<std::size_t>(output)]));
  }
  YamlNode samples = makeMap();
  addEntry(samples, "outputs", std::move(outputs));
  addEntry(samples, "start", makeScalar(fmt::format("{:.12g}", design.times[first])));
  addEntry(samples, "interval", makeScalar(fmt::format("{:.12g}", interval)));
  addEntry(samples, "count", makeScalar(std::to_string(last - first + 1)));
  YamlNode feature = makeMap();
  addEntry(feature, "samples", std::move(samples));
  return feature;
}

}  // namespace

std::string nameOutputs(const SensorDesign& design, const Subset& outputs) {
  std::string names;
  for (const Index output : outputs) {
    names += (names.empty() ? "" : " ") + design.outputs[static_cast<std::size_t>(output)];
  }
  return names;
}

YamlNode makeDesignedTree(const YamlNode& tree, const SensorDesign& design) {
  YamlNode features = makeSequence();
  for (std::size_t i = 0; i < design.chosen_times.size();) {
    std::size_t last = i;
    while (last + 1 < design.chosen_times.size() &&
           design.chosen_times[last + 1] == design.chosen_times[last] + 1) {
      ++last;
    }
    features.items.push_back(makeSamples(design, design.chosen_times[i], design.chosen_times[last]));
    i = last + 1;
  }
  YamlNode designed = tree;
  setValue(designed, {"features", {}}, features);
  if (YamlNode* name = designed.find("name")) {
    name->scalar += "_designed";
  }
  return designed;
}

void writeSensorDesign(const std::filesystem::path& folder, const YamlNode& tree,
                       const SensorDesign& design) {
  writeTextFile(folder / "designed.yaml", writeYaml(makeDesignedTree(tree, design)));
  writeTextFile(folder / "sensors.csv", makeSensorsCsv(design));
  if (!design.by_times.empty()) {
    writeTextFile(folder / "times.csv", makeTimesCsv(design));
  }
}

std::string describeSensors(const SensorDesign& design) {
  std::string text = fmt::format("{:>7} {:>10}", "outputs", "criterion");
  for (const ParameterSpec& parameter : design.parameters) {
    text += fmt::format(" {:>12}", "sd " + parameter.name.text);
  }
  text += "\n";
  const auto add = [&](const JudgedSubset& judged, const std::string& what) {
    text += fmt::format("{:>7} {:>10.4f}", judged.subset.size(), judged.cost);
    for (const auto& stddev : judged.stddev.rowwise()) {
      text += fmt::format(" {:>12.4g}", stddev.mean());
    }
    text += "  " + what + "\n";
  };
  for (const JudgedSubset& judged : design.by_outputs) {
    const bool chosen = judged.subset.size() == design.chosen_outputs.subset.size();
    add(judged, nameOutputs(design, judged.subset) + (chosen ? "  <- chosen" : ""));
  }
  if (!design.by_times.empty()) {
    text += fmt::format("\n{:>7}\n", "times");
  }
  for (const JudgedSubset& judged : design.by_times) {
    add(judged, "");
  }
  return text;
}

}  // namespace twinmap::experiment_design
