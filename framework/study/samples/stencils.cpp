#include "framework/study/samples/stencils.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/base/text/number_text.hpp"
#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/data/sensitivity/stencil_simulator.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/experiment_points.hpp"
#include "framework/study/samples/model_store.hpp"
#include "framework/study/samples/simulate_missing.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// The bounds too decide where the neighbours of a point lie.
std::string writeBounds(const std::vector<ParameterSpec>& parameters) {
  std::string text = "stencils:\n";
  for (const ParameterSpec& parameter : parameters) {
    text += "  - [" + toText(parameter.bounds.lower) + ", " + toText(parameter.bounds.upper) + "]\n";
  }
  return text;
}

std::vector<LocalModel> calcStoredLocalModels(const SampleSource& source, const ResponseLayout& layout,
                                              const FeatureExtractor& extractor,
                                              const std::vector<ParameterSpec>& parameters,
                                              const MatrixXd& points, int threads) {
  MissingOptions options;
  options.threads = threads;
  const Trajectories stencils =
      simulateMissing(*source.stencils, StencilSimulator(source.simulator, parameters), points, options)
          .trajectories;
  const ResponseLayout& stored = source.simulator.getLayout();
  std::vector<LocalModel> models;
  for (Index i = 0; i < points.cols(); ++i) {
    const MatrixXd responses =
        selectRows(stencils.responses.col(i).reshaped(stored.getRowCount(), Eigen::AutoSize), stored, layout);
    models.push_back(
        makeLocalModel(extractor, parameters, points.col(i), responses.reshaped(), stencils.statuses[i]));
  }
  return models;
}

}  // namespace

bool selectsByFisherInformation(const ExperimentSpec& experiment) {
  return !experiment.inverse_map.isNone() &&
         std::any_of(experiment.transform.begin(), experiment.transform.end(),
                     [](const TransformStepSpec& step) {
                       const auto* select = std::get_if<SelectSpec>(&step.kind);
                       return select != nullptr && std::holds_alternative<FisherInformationSpec>(*select);
                     });
}

MatrixXd listDerivativePoints(const ExperimentSpec& experiment) {
  MatrixXd points(countSampled(experiment.model), 0);
  if (asksForInformationLimit(experiment)) {
    points = sampleTestPoints(experiment);
  }
  if (selectsByFisherInformation(experiment)) {
    const MatrixXd train = sampleTrainPoints(experiment);
    const Index first = points.cols(), count = std::min<Index>(train.cols(), kSensitivitySamples);
    points.conservativeResize(Eigen::NoChange, first + count);
    points.rightCols(count) = train.leftCols(count);
  }
  return points;
}

MatrixXd dropFailed(const MatrixXd& points, const TrajectoryStore& samples) {
  std::vector<Index> kept;
  for (Index i = 0; i < points.cols(); ++i) {
    if (!samples.hasFailed(points.col(i))) {
      kept.push_back(i);
    }
  }
  return points(Eigen::all, kept);
}

std::unique_ptr<TrajectoryStore> openStencilStore(const ModelSpec& model, const ResponseLayout& layout,
                                                  const std::filesystem::path& root, StoreAccess access) {
  const std::vector<ParameterSpec> unknown = collectUnknown(model);
  auto store = std::make_unique<TrajectoryStore>(
      root, writeStoreContent(model, layout) + writeBounds(unknown), countSampled(model),
      countNeighbours(unknown.size()) * layout.getRowCount(), access);
  if (access == StoreAccess::kReadWrite) {
    logSetAside(*store);
  }
  return store;
}

StageNotes simulateStencils(const ExperimentSpec& experiment, const SampleSource& source,
                            const RunControl& control) {
  if (source.stencils == nullptr) {
    return {};
  }
  const MatrixXd points = dropFailed(listDerivativePoints(experiment), source.store);
  if (source.stencils->findMissing(points).empty()) {
    return {};
  }
  const std::vector<ParameterSpec> unknown = collectUnknown(experiment.model);
  const StencilSimulator simulator(source.simulator, unknown);
  const MissingOptions missing = makeMissingOptions(kStencilStage, countNeighbours(unknown.size()), control);
  StageNotes notes;
  const SimulationProgress counts =
      timeStage(fmt::format("finite differences at {} points", points.cols()), notes,
                [&] { return storeMissing(*source.stencils, simulator, points, missing); });
  if (counts.simulated < counts.total) {
    throw Interrupted(fmt::format("interrupted: {} of {} stencils are simulated and kept",
                                  counts.reused + counts.simulated, points.cols()));
  }
  return notes;
}

std::vector<LocalModel> calcLocalModels(const ExperimentSpec& experiment, const SampleSource& source,
                                        const Simulator& simulator, const FeatureExtractor& extractor,
                                        const MatrixXd& points, int threads) {
  const std::vector<ParameterSpec> unknown = collectUnknown(experiment.model);
  return source.stencils == nullptr
             ? calcLocalModels(simulator, extractor, unknown, points, threads)
             : calcStoredLocalModels(source, simulator.getLayout(), extractor, unknown, points, threads);
}

}  // namespace twinmap
