#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <utility>

#include "framework/base/json/json.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/text_tables.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/waiting_line.hpp"
#include "framework/diagnosis/held_out.hpp"
#include "framework/diagnosis/remainder/residual_noise.hpp"
#include "framework/diagnosis/structures.hpp"
#include "framework/inference/measurement/inference_source.hpp"
#include "framework/simulation/simulator_team.hpp"

namespace twinmap::cli {
namespace {

struct Structure {
  std::string file;
  std::size_t parameters = 0;
  StructureFit fit;
};

bool isExperiment(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  return extension == ".yaml" || extension == ".yml";
}

/// What a file and the recordings give, before any fit.
struct Source {
  std::string file;
  InferenceSource source;
  RecordedFeatures recordings;
  ExperimentSpec experiment;

  SimulatorPosteriorOptions makeOptions() const {
    return makePosteriorOptions(experiment, SimulatorPosteriorOptions{}.draws);
  }
  Eigen::Index countFeatures() const { return source.getReader().getExtractor().getFeatureCount(); }
};

Source readSource(const std::string& file, const std::vector<std::string>& measurements,
                  const SelectArguments& arguments) {
  InferenceSource source(file);
  RecordedFeatures recordings =
      readRecordings(source.getReader(), measurements, arguments.starts, parseKnownValues(arguments.known));
  ExperimentSpec experiment = source.getExperiment();
  return {file, std::move(source), std::move(recordings), std::move(experiment)};
}

/// Of an experiment that reads its features between samples, another at the samples.
void requireSameSamples(const Source& one, const Source& first) {
  for (std::size_t k = 0; k < one.recordings.features.size(); ++k) {
    const auto own = one.recordings.features[k].array().isFinite().count(),
               others = first.recordings.features[k].array().isFinite().count();
    if (own != others) {
      throw ExperimentError(fmt::format(
          "{} is compared by {} features of recording {}, but {} by {}: structures are compared by the same "
          "data; give features the times of the recording's samples, which all models can read",
          one.file, own, k + 1, first.file, others));
    }
  }
}

/// Evidence compares structures for the same data and noise alone.
void requireComparable(const std::vector<Source>& all) {
  const Source& first = all.front();
  for (const Source& one : all) {
    if (one.countFeatures() != first.countFeatures()) {
      throw ExperimentError(
          fmt::format("{} has {} features, but {} has {}: structures are compared by the same features of "
                      "the same recordings; give them the same 'features'",
                      one.file, one.countFeatures(), first.file, first.countFeatures()));
    }
    requireSameSamples(one, first);
    if (listUnknownNoise(one.experiment.noise) != listUnknownNoise(first.experiment.noise)) {
      throw ExperimentError(
          fmt::format("{} and {} differ in the outputs whose noise is unknown: structures are compared by "
                      "the same noise; give them the same 'noise.stddev'",
                      one.file, first.file));
    }
  }
}

/// Noise whose size the files do not say.
struct SizedNoise {
  std::string file;  ///< whose fit leaves it; "" where the files say all
  NoiseSpec stated, sized;
};

/// For all structures what the fit of the one leaves that leaves least.
SizedNoise takeLeastNoise(std::vector<Source>& all) {
  const NoiseSpec stated = all.front().experiment.noise;
  if (!hasUnknownNoise(stated)) {
    return {"", stated, stated};
  }
  std::vector<NoiseSpec> sized;
  for (const Source& one : all) {
    sized.push_back(sizeNoiseByFit(one.experiment, one.recordings, one.makeOptions()).noise);
  }
  const std::size_t least = findLeastNoise(sized);
  for (Source& one : all) {
    one.experiment.noise = sized[least];
  }
  return {all[least].file, stated, sized[least]};
}

Structure fitStructure(const Source& one) {
  const SearchStage stage("fit " + one.file);
  return {one.file, one.experiment.model.parameters.size(),
          calcStructureFit(one.experiment, one.recordings, one.makeOptions())};
}

std::string makeStructureTable(const std::vector<Structure>& all, double best, const SizedNoise& noise) {
  std::vector<std::vector<std::string>> rows{
      {"structure", "parameters", "chi-square", "degrees", "log evidence", "held out: rms (noise sd)", "p"}};
  for (const Structure& one : all) {
    const StructureFit& fit = one.fit;
    rows.push_back({one.file, std::to_string(one.parameters), toShortText(fit.chi_square, 4),
                    fmt::format("{:.0f}", fit.degrees), fmt::format("{:.1f}", fit.log_evidence - best),
                    toShortText(fit.held_out_rms, 3),
                    fit.held_out_p < 1e-4 ? "< 0.0001" : toShortText(fit.held_out_p, 2)});
  }
  const std::string sizes = describeSizes(noise.stated, noise.sized);
  return (sizes.empty() ? "" : fmt::format("Noise as {} leaves it: sd {}\n", noise.file, sizes)) +
         alignRows(rows, 1);
}

std::string makeStructureJson(const std::vector<Structure>& all, double best, const SizedNoise& noise) {
  Json json{{"structures", Json::array()}};
  for (std::size_t i = 0; i < noise.stated.stddev.size(); ++i) {
    if (noise.stated.stddev[i].stddev.unknown) {
      json["noise"][noise.stated.stddev[i].name.text] = noise.sized.stddev[i].stddev.value;
    }
  }
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
  setThreads(arguments.threads);
  WaitingLine waiting(fmt::format("select by {}", fmt::join(measurements, ", ")));
  std::vector<Source> sources;
  for (const std::string& file : experiments) {
    sources.push_back(readSource(file, measurements, arguments));
  }
  requireComparable(sources);
  const SizedNoise noise = takeLeastNoise(sources);
  std::vector<Structure> all;
  std::transform(sources.begin(), sources.end(), std::back_inserter(all), fitStructure);
  std::stable_sort(all.begin(), all.end(), [](const Structure& a, const Structure& b) {
    return a.fit.log_evidence > b.fit.log_evidence;
  });
  const double best = all.front().fit.log_evidence;
  waiting.clear();
  std::cout << (arguments.json ? makeStructureJson(all, best, noise) + "\n"
                               : makeStructureTable(all, best, noise));
}

}  // namespace twinmap::cli
