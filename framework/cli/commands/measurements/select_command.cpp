#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "framework/base/json/json.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/text_tables.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/diagnosis/structures.hpp"
#include "framework/inference/inference_source.hpp"

namespace twinmap::cli {
namespace {

struct Structure {
  std::string file;
  std::size_t parameters = 0;
  Eigen::Index features = 0;
  StructureFit fit;
};

bool isExperiment(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  return extension == ".yaml" || extension == ".yml";
}

Structure fitStructure(const std::string& file, const std::vector<std::string>& measurements,
                       const SelectArguments& arguments) {
  const InferenceSource source(file);
  const MeasurementReader& reader = source.getReader();
  const ExperimentSpec& experiment = reader.getExperiment();
  const RecordedFeatures recordings =
      readRecordings(reader, measurements, arguments.starts, parseKnownValues(arguments.known));
  return {file, experiment.model.parameters.size(), reader.getExtractor().getFeatureCount(),
          calcStructureFit(experiment, recordings,
                           makePosteriorOptions(experiment, SimulatorPosteriorOptions{}.draws))};
}

/// Evidence compares structures for the same data alone.
void requireSameFeatures(const std::vector<Structure>& all) {
  for (const Structure& one : all) {
    if (one.features != all.front().features) {
      throw ExperimentError(fmt::format(
          "{} has {} features, but {} has {}: structures are compared by the same features of the same "
          "recordings; give them the same 'features'",
          one.file, one.features, all.front().file, all.front().features));
    }
  }
}

std::string makeStructureTable(const std::vector<Structure>& all, double best) {
  std::vector<std::vector<std::string>> rows{
      {"structure", "parameters", "chi-square", "degrees", "log evidence", "held out: rms (noise sd)", "p"}};
  for (const Structure& one : all) {
    const StructureFit& fit = one.fit;
    rows.push_back({one.file, std::to_string(one.parameters), toShortText(fit.chi_square, 4),
                    fmt::format("{:.0f}", fit.degrees), fmt::format("{:.1f}", fit.log_evidence - best),
                    toShortText(fit.held_out_rms, 3),
                    fit.held_out_p < 1e-4 ? "< 0.0001" : toShortText(fit.held_out_p, 2)});
  }
  return alignRows(rows, 1);
}

std::string makeStructureJson(const std::vector<Structure>& all, double best) {
  Json json{{"structures", Json::array()}};
  for (const Structure& one : all) {
    const StructureFit& fit = one.fit;
    json["structures"].push_back({{"file", one.file},
                                  {"parameters", one.parameters},
                                  {"chi_square", fit.chi_square},
                                  {"degrees", fit.degrees},
                                  {"log_evidence", fit.log_evidence - best},
                                  {"held_out_rms", fit.held_out_rms},
                                  {"held_out_p_value", fit.held_out_p}});
  }
  return formatJson(json);
}

}  // namespace

void select(const SelectArguments& arguments) {
  std::vector<std::string> experiments, measurements;
  for (const std::string& file : arguments.files) {
    (isExperiment(file) ? experiments : measurements).push_back(file);
  }
  if (experiments.size() < 2 || measurements.empty()) {
    throw ExperimentError("give two or more experiment files (YAML), then files of measurements");
  }
  std::vector<Structure> all;
  for (const std::string& file : experiments) {
    all.push_back(fitStructure(file, measurements, arguments));
  }
  requireSameFeatures(all);
  std::stable_sort(all.begin(), all.end(), [](const Structure& a, const Structure& b) {
    return a.fit.log_evidence > b.fit.log_evidence;
  });
  const double best = all.front().fit.log_evidence;
  std::cout << (arguments.json ? makeStructureJson(all, best) + "\n" : makeStructureTable(all, best));
}

}  // namespace twinmap::cli
