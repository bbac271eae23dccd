#include "framework/sampling/stored_local_models.hpp"

#include <fmt/format.h>

#include "framework/experiment/simulated_sets.hpp"
#include "framework/monitoring/interrupted.hpp"
#include "framework/monitoring/stage_timer.hpp"
#include "framework/sampling/needed_neighbourhoods.hpp"
#include "framework/sampling/simulate_missing.hpp"
#include "framework/sampling/store_content.hpp"
#include "framework/sensitivity/neighbourhood_simulator.hpp"
#include "framework/spec/parameter_box.hpp"
#include "framework/spec/yaml/number_text.hpp"

namespace twinmap {
namespace {

/// The bounds too decide where the neighbours of a point lie.
std::string writeBounds(const std::vector<ParameterSpec>& parameters) {
  std::string text = "neighbourhoods:\n";
  for (const ParameterSpec& parameter : parameters) {
    text += "  - [" + toText(parameter.bounds.lower) + ", " + toText(parameter.bounds.upper) + "]\n";
  }
  return text;
}

}  // namespace

std::unique_ptr<TrajectoryStore> openNeighbourhoodStore(const ModelSpec& model, const ResponseLayout& layout,
                                                        const std::filesystem::path& root,
                                                        StoreAccess access) {
  const std::vector<ParameterSpec> unknown = collectUnknown(model);
  auto store = std::make_unique<TrajectoryStore>(
      root, writeStoreContent(model, layout) + writeBounds(unknown), countSampled(model),
      countNeighbours(unknown.size()) * layout.getRowCount(), access);
  if (access == StoreAccess::kReadWrite) {
    logSetAside(*store);
  }
  return store;
}

void simulateNeighbourhoods(const ExperimentSpec& experiment, const SampleSource& source,
                            const RunOptions& options, RunSummary& run) {
  if (source.neighbourhoods == nullptr) {
    return;
  }
  const Eigen::MatrixXd points = dropFailed(listNeededNeighbourhoods(experiment), source.store);
  if (source.neighbourhoods->findMissing(points).empty()) {
    return;
  }
  const std::vector<ParameterSpec> unknown = collectUnknown(experiment.model);
  const NeighbourhoodSimulator simulator(source.simulator, unknown);
  const MissingOptions missing =
      makeMissingOptions(kNeighbourhoodStage, countNeighbours(unknown.size()), options);
  const SimulationProgress counts =
      timeStage(fmt::format("neighbourhoods of {} points", points.cols()), run.times,
                [&] { return storeMissing(*source.neighbourhoods, simulator, points, missing); });
  if (counts.simulated < counts.total) {
    throw Interrupted(fmt::format("interrupted: {} of {} neighbourhoods are simulated and kept",
                                  counts.reused + counts.simulated, points.cols()));
  }
}

std::vector<LocalModel> calcStoredLocalModels(const SampleSource& source, const ResponseLayout& layout,
                                              const FeatureExtractor& extractor,
                                              const std::vector<ParameterSpec>& parameters,
                                              const Eigen::MatrixXd& points, int threads) {
  MissingOptions options;
  options.threads = threads;
  const Trajectories neighbourhoods =
      simulateMissing(*source.neighbourhoods, NeighbourhoodSimulator(source.simulator, parameters), points,
                      options)
          .trajectories;
  const ResponseLayout& stored = source.simulator.getLayout();
  std::vector<LocalModel> models;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::MatrixXd responses = selectRows(
        neighbourhoods.responses.col(i).reshaped(stored.getRowCount(), Eigen::AutoSize), stored, layout);
    models.push_back(makeLocalModel(extractor, parameters, points.col(i), responses.reshaped(),
                                    neighbourhoods.statuses[i]));
  }
  return models;
}

}  // namespace twinmap
