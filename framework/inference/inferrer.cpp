#include "framework/inference/inferrer.hpp"

#include <stdexcept>

#include "framework/data/features/experiment_features.hpp"
#include "framework/experiment/check/unused_parameters.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/inference/derived_values.hpp"
#include "framework/store/reduction_group.hpp"

namespace twinmap {

namespace fs = std::filesystem;

fs::path findMaps(const fs::path& run_or_maps) {
  const fs::path file = fs::is_directory(run_or_maps) ? run_or_maps / "maps.h5" : run_or_maps;
  if (!fs::exists(file)) {
    throw std::runtime_error(
        file.string() +
        ": does not exist; give the folder of a finished run, or its maps.h5 (a run with "
        "'inverse_map: none' has none: only `twinmap infer` works from it)");
  }
  return file;
}

bool isCalibrated(const Estimator& map, const TrustModel* trust) {
  return map.isCalibrated() && (trust == nullptr || !trust->coverage.isShort());
}

OnlineWorkspace::OnlineWorkspace(const OnlineModel& model) : map(model.map->makeWorkspace()) {
  if (model.trust) {
    trust.emplace(*model.trust);
  }
}

InferredMeasurement inferOnline(const OnlineModel& model, const Eigen::VectorXd& features,
                                const Eigen::VectorXd& known, OnlineWorkspace& workspace) {
  const TrustModel* trust = model.trust ? &*model.trust : nullptr;
  InferredMeasurement inferred;
  inferred.by_estimator = model.map->infer(features, known, *workspace.map);
  inferred.estimator_is_calibrated = isCalibrated(*model.map, trust);
  inferred.estimator_coverage_is_short = trust != nullptr && trust->coverage.isShort();
  inferred.basins = model.map->listBasins(*workspace.map);
  if (trust != nullptr) {
    inferred.trust = judge(*trust, features, known, inferred.by_estimator, workspace.map->findExplanation(),
                           *workspace.trust);
    inferred.explanation = trust->makeSampledPoint(workspace.trust->explanation->point);
    inferred.covariance = workspace.trust->explanation->calcCovariance();
  }
  return inferred;
}

Inferrer::Inferrer(const fs::path& run_or_maps) : Inferrer(readTrainedFile(findMaps(run_or_maps))) {}

namespace {

MeasurementReader makeReader(const TrainedFile& loaded) {
  ExperimentSpec experiment = readResolved(loaded.experiment);
  if (!loaded.reduction) {
    return MeasurementReader(std::move(experiment));
  }
  auto reduction = std::make_shared<ResponseReduction>(*loaded.reduction);
  placeRows(experiment, makeLayout(experiment), *reduction);
  return {std::move(experiment), std::move(reduction)};
}

}  // namespace

Inferrer::Inferrer(TrainedFile loaded)
    : reader_(makeReader(loaded)),
      online_(std::move(loaded.model)),
      quantities_(makeDerivedQuantities(reader_.getExperiment())),
      prior_(findStatedPrior(reader_.getExperiment().model)),
      unused_(listUnused(reader_.getExperiment(), "parameters")) {}

InferredMeasurement Inferrer::infer(const Eigen::VectorXd& features, const Eigen::VectorXd& known,
                                    OnlineWorkspace& workspace) const {
  InferredMeasurement inferred = inferOnline(online_, features, known, workspace);
  inferred.quantities = quantities_;
  inferred.prior = prior_;
  inferred.unused = unused_;
  return inferred;
}

}  // namespace twinmap
