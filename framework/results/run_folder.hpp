#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "framework/base/text/csv.hpp"
#include "framework/estimation/mixture.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

struct TrainedFile;
struct StoredResponses;

/// What a run's provenance.json says (docs/reference/files.md), in its order.
struct ProvenanceRecord {
  /// Key and value of what is neither a list nor below; a key within another is "libraries: Eigen".
  std::vector<std::pair<std::string, std::string>> entries;
  std::vector<std::pair<std::string, double>> seconds;  ///< wall time of each stage
  std::vector<std::string> warnings;

  /// nullptr if there is none.
  const std::string* find(const std::string& key) const;
  /// NaN if there is none, or if it is not a number.
  double getNumber(const std::string& key) const;
};

/// Throws std::runtime_error naming a damaged file; a file that is not there leaves an empty record.
ProvenanceRecord readProvenanceRecord(const std::filesystem::path& path);

/// What a run left in its folder: all that the report knows. Files that are not there leave an empty table.
struct RunFolder {
  std::filesystem::path path;
  std::string label;  ///< the folder's name
  ExperimentSpec experiment;
  CsvTable metrics;
  CsvTable joint;
  CsvTable methods;
  CsvTable predictions;
  std::vector<Mixture> mixtures;  ///< of each test sample, where predictions are such; else empty
  CsvTable training;
  CsvTable hyperparameters;
  CsvTable chains;
  CsvTable failures;
  CsvTable trust_power;
  CsvTable features;
  CsvTable correlations;
  CsvTable identifiability;
  CsvTable identified;
  CsvTable curves;
  CsvTable posterior;
  CsvTable sbc;
  CsvTable baselines;
  CsvTable compared_maps;
  CsvTable responses;
  ProvenanceRecord provenance;
  std::shared_ptr<const StoredResponses> test_responses;  ///< nullptr if absent
  std::shared_ptr<const TrainedFile> map;                 ///< nullptr if absent
};

/// Reads a run's folder (docs/reference/files.md). Throws std::runtime_error naming a damaged file, or the
/// folder if it has no resolved.yaml.
RunFolder readRunFolder(const std::filesystem::path& path);

/// A sweep: its summary and one of its cases.
struct SweepFolder {
  std::filesystem::path path;
  std::string label;
  CsvTable table;  ///< sweep.csv: one row per case and parameter
};

bool isSweepFolder(const std::filesystem::path& path);
SweepFolder readSweepFolder(const std::filesystem::path& path);

}  // namespace twinmap
