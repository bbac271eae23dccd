#include "framework/stored_local_models.hpp"

#include "framework/sensitivity/neighbourhood_simulator.hpp"
#include "framework/simulate_missing.hpp"
#include "framework/simulated_sets.hpp"
#include "framework/spec/number_text.hpp"
#include "framework/spec/parameter_box.hpp"
#include "framework/store_content.hpp"

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

std::unique_ptr<TrajectoryStore> openNeighbourhoodStore(const ModelSpec& model, const Simulator& simulator,
                                                        const std::filesystem::path& root,
                                                        StoreAccess access) {
  const std::vector<ParameterSpec> unknown = collectUnknown(model);
  const ResponseLayout layout = NeighbourhoodSimulator(simulator, unknown).getLayout();
  auto store = std::make_unique<TrajectoryStore>(
      root, writeStoreContent(model, simulator.getLayout()) + writeBounds(unknown), countSampled(model),
      layout.getRowCount(), access);
  logSetAside(*store);
  return store;
}

std::vector<LocalModel> calcStoredLocalModels(TrajectoryStore& store, const Simulator& simulator,
                                              const FeatureExtractor& extractor,
                                              const std::vector<ParameterSpec>& parameters,
                                              const Eigen::MatrixXd& points, int threads) {
  MissingOptions options;
  options.threads = threads;
  const Trajectories neighbourhoods =
      simulateMissing(store, NeighbourhoodSimulator(simulator, parameters), points, options).trajectories;
  std::vector<LocalModel> models;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    models.push_back(makeLocalModel(extractor, parameters, points.col(i), neighbourhoods.responses.col(i),
                                    neighbourhoods.statuses[i]));
  }
  return models;
}

}  // namespace twinmap
