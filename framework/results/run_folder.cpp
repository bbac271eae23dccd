#include "framework/results/run_folder.hpp"

#include <cmath>
#include <stdexcept>

#include "framework/base/json/json.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/files/resolve_defaults.hpp"
#include "framework/store/predictions_file.hpp"
#include "framework/store/samples_file.hpp"
#include "framework/store/trained_file.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

std::string makeLabel(const fs::path& folder) {
  const fs::path whole = fs::absolute(folder).lexically_normal();
  return whole.has_filename() ? whole.filename().string() : whole.parent_path().filename().string();
}

/// Of the samples in predictions.csv.
std::vector<Mixture> readMixtures(const fs::path& path, const RunFolder& run) {
  const std::vector<std::string> names = collectNames(run.experiment.model.parameters);
  std::vector<int> samples;
  for (std::size_t row = 0; row < run.predictions.rows.size(); row += names.size()) {
    samples.push_back(static_cast<int>(run.predictions.getNumber(row, "sample")));
  }
  return readComponentsFile(path / "components.csv", names, samples);
}

/// Leaves the answers that tables are of: not those that others stand for, nor the refined ones beside them.
void dropUnsampled(RunFolder& run) {
  std::vector<CsvRow> rows;
  std::vector<Mixture> mixtures;
  const std::size_t parameters = run.experiment.model.parameters.size();
  for (std::size_t row = 0; row < run.predictions.rows.size(); ++row) {
    if (run.predictions.getNumber(row, "stands_for") <= 0.0) {
      continue;
    }
    rows.push_back(run.predictions.rows[row]);
    if (row % parameters == 0 && !run.mixtures.empty()) {
      mixtures.push_back(run.mixtures[row / parameters]);
    }
  }
  run.predictions.rows = std::move(rows);
  run.mixtures = std::move(mixtures);
}

void readTables(const fs::path& path, RunFolder& run) {
  run.metrics = readCsvFile(path / "metrics.csv");
  run.joint = readCsvFile(path / "joint.csv");
  run.methods = readCsvFile(path / "methods.csv");
  run.predictions = readCsvFile(path / "predictions.csv");
  run.mixtures = readMixtures(path, run);
  dropUnsampled(run);
  run.training = readCsvFile(path / "training.csv");
  run.chains = readCsvFile(path / "chains.csv");
  run.hyperparameters = readCsvFile(path / "hyperparameters.csv");
  run.failures = readCsvFile(path / "failures.csv");
  run.trust_power = readCsvFile(path / "trust_power.csv");
  run.features = readCsvFile(path / "features.csv");
  run.correlations = readCsvFile(path / "correlations.csv");
  run.identifiability = readCsvFile(path / "identifiability.csv");
  run.identified = readCsvFile(path / "identified.csv");
  run.curves = readCsvFile(path / "curves.csv");
  run.posterior = readCsvFile(path / "posterior.csv");
  run.sbc = readCsvFile(path / "sbc.csv");
  run.compared_maps = readCsvFile(path / "maps.csv");
  run.baselines = readCsvFile(path / "baselines.csv");
  run.responses = readCsvFile(path / "responses.csv");
}

}  // namespace

RunFolder readRunFolder(const fs::path& path) {
  if (!fs::exists(path / "resolved.yaml")) {
    throw std::runtime_error(path.string() + ": is not a folder of a run: it has no resolved.yaml");
  }
  RunFolder run;
  run.path = path;
  run.label = makeLabel(path);
  run.experiment = loadExperiment((path / "resolved.yaml").string());
  readTables(path, run);
  run.provenance = readProvenanceRecord(path / "provenance.json");
  if (fs::exists(path / "samples.h5")) {
    if (run.experiment.design.train.samples.automatic) {
      run.experiment =
          takeTrainingSamples(std::move(run.experiment), countTrainingSamples(path / "samples.h5"));
      run.experiment.design.train.samples.automatic = true;
    }
    run.test_responses = std::make_shared<StoredResponses>(readTestResponses(path / "samples.h5"));
  }
  if (fs::exists(path / "maps.h5")) {
    run.map = std::make_shared<TrainedFile>(readTrainedFile(path / "maps.h5"));
  }
  return run;
}

bool isSweepFolder(const fs::path& path) {
  return fs::exists(path / "sweep.csv");
}

SweepFolder readSweepFolder(const fs::path& path) {
  return {path, makeLabel(path), readCsvFile(path / "sweep.csv")};
}

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
