#include "framework/study/pipeline/compare_maps.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/base/log/notice.hpp"
#include "framework/base/log/run_control.hpp"
#include "framework/base/log/stage_timer.hpp"
#include "framework/study/pipeline/evaluate_estimates.hpp"
#include "framework/study/pipeline/online_timing.hpp"
#include "framework/study/pipeline/training/store_map.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

/// The kind of each, with a number behind those that are not the first of their kind: "network", "network_2".
std::vector<std::string> nameMaps(const std::vector<InverseMapSpec>& maps) {
  std::vector<std::string> kinds, names;
  for (const InverseMapSpec& map : maps) {
    kinds.emplace_back(getEstimatorKind(map));
    const auto same = std::count(kinds.begin(), kinds.end(), kinds.back());
    names.push_back(same > 1 ? fmt::format("{}_{}", kinds.back(), same) : kinds.back());
  }
  return names;
}

/// Writes the map; returns how many bytes that took.
std::uintmax_t store(const fs::path& file, const Study& study, const Evaluation& evaluation,
                     TrainedMap& map) {
  storeMap(file, study, evaluation, map);
  return fs::file_size(file);
}

MapComparison compare(const std::string& name, const Study& study, const PreparedData& data,
                      const Eigen::MatrixXd& limit_stddev) {
  const LabelledFeatures& test = data.labelled.test;
  StageNotes notes;
  TrainedMap map = timeStage("train " + name, notes, [&] { return trainChosenMap(study, data); });
  const Estimates predictions = map.predict(test.features, test.inputs);
  Evaluation evaluation =
      evaluateEstimates(study.experiment.model.parameters, test.parameters,
                        selectEstimates(predictions, map.residual_correlation, {}), limit_stddev);
  if (map.online.trust) {
    map.online.trust->coverage = recordCoverage(
        summarizeMap(map.name, study.experiment.model.parameters, test.parameters, predictions, {}));
  }
  return {name,
          evaluation.metrics,
          evaluation.joint,
          notes.times.back().seconds,
          timeOnlineUpdates(map.online, test),
          store(study.folder / "maps" / (name + ".h5"), study, evaluation, map)};
}

/// Compares a map, or tells why it cannot be had.
void tryMap(const std::string& name, const Study& study, const PreparedData& data,
            const Eigen::MatrixXd& limit_stddev, ComparedMaps& compared) {
  try {
    compared.maps.push_back(compare(name, study, data, limit_stddev));
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& error) {
    compared.notes.warn(makeWarning(Notice::kNotCompared, name, error.what()));
  }
}

}  // namespace

ComparedMaps compareMaps(const Study& study, const PreparedData& data, const Eigen::MatrixXd& limit_stddev) {
  ComparedMaps compared;
  const std::vector<InverseMapSpec>& maps = study.experiment.evaluation.maps;
  if (maps.empty()) {
    return compared;
  }
  const std::vector<std::string> names = nameMaps(maps);
  fs::create_directories(study.folder / "maps");
  compared.notes = timeStage(fmt::format("compare {} maps", maps.size()), compared.notes, [&] {
    ComparedMaps tried;
    for (std::size_t i = 0; i < maps.size(); ++i) {
      ExperimentSpec experiment = study.experiment;
      experiment.inverse_map = maps[i];
      tryMap(names[i], study.with(experiment), data, limit_stddev, tried);
    }
    compared.maps = std::move(tried.maps);
    return tried.notes;
  });
  return compared;
}

}  // namespace twinmap
