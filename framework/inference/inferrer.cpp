#include "framework/inference/inferrer.hpp"

#include <cmath>
#include <stdexcept>

#include "framework/data/features/experiment_features.hpp"
#include "framework/data/measurement/trained_excitation.hpp"
#include "framework/experiment/experiment_file.hpp"
#include "framework/store/estimators/maps_file.hpp"

namespace twinmap {

namespace fs = std::filesystem;

fs::path findMaps(const fs::path& run_or_maps) {
  const fs::path file = fs::is_directory(run_or_maps) ? run_or_maps / "maps.h5" : run_or_maps;
  if (!fs::exists(file)) {
    throw std::runtime_error(file.string() +
                             ": does not exist; give the folder of a finished run, or its maps.h5");
  }
  return file;
}

struct Inferrer::Loaded {
  StoredOnlineModel stored;
  ExperimentSpec experiment;
  ResponseLayout layout;
};

Inferrer::Inferrer(const fs::path& run_or_maps)
    : Inferrer([&] {
        Loaded loaded{readOnlineModel(findMaps(run_or_maps)), {}, {}};
        loaded.experiment = readResolved(loaded.stored.experiment);
        loaded.layout = makeLayout(loaded.experiment);
        return loaded;
      }()) {}

Inferrer::Inferrer(Loaded loaded)
    : experiment_(std::move(loaded.experiment)),
      layout_(std::move(loaded.layout)),
      sample_interval_(findSampleInterval(experiment_.features)),
      extractor_(makeExtractor(experiment_, layout_)),
      map_(std::move(loaded.stored.model.map)),
      trust_(std::move(loaded.stored.model.trust)) {}

std::vector<std::string> Inferrer::listColumns() const {
  std::vector<std::string> names = twinmap::listColumns(experiment_.measurement, layout_.output_names);
  const std::vector<std::string> excitation = listExcitationColumns(experiment_);
  names.insert(names.end(), excitation.begin(), excitation.end());
  return names;
}

void Inferrer::requireExcitation(const Table& table, std::optional<double> start) const {
  requireTrainedExcitation(experiment_, table, start.value_or(experiment_.measurement.start));
}

Eigen::VectorXd Inferrer::readResponse(const Table& table, std::optional<double> start) const {
  MeasurementSpec spec = experiment_.measurement;
  spec.start = start.value_or(spec.start);
  return resample(readMeasurement(table, spec, layout_), layout_, sample_interval_);
}

Eigen::VectorXd Inferrer::extractFeatures(const Eigen::VectorXd& response, const std::string& source) const {
  return twinmap::extractFeatures(extractor_, response, source);
}

Eigen::VectorXd extractFeatures(const FeatureExtractor& extractor, const Eigen::VectorXd& response,
                                const std::string& source) {
  Eigen::VectorXd features = extractor.extract(response);
  for (Eigen::Index i = 0; i < features.size(); ++i) {
    if (!std::isfinite(features[i])) {
      throw MeasurementError(source + ": the response has no feature '" + extractor.getInfos()[i].name + "'");
    }
  }
  return features;
}

Inferrer::Workspace::Workspace(const Inferrer& inferrer) : map(inferrer.getMap()) {
  if (inferrer.getTrustModel()) {
    trust.emplace(*inferrer.getTrustModel());
  }
}

InferredMeasurement Inferrer::infer(const Eigen::VectorXd& features, const Eigen::VectorXd& known,
                                    Workspace& workspace) const {
  InferredMeasurement inferred;
  inferred.by_estimator = map_.infer(features, known, workspace.map);
  inferred.estimator_is_calibrated = map_.isCalibrated();
  if (trust_) {
    inferred.trust = judge(*trust_, features, known, inferred.by_estimator, workspace.map.findExplanation(),
                           *workspace.trust);
    inferred.explanation = trust_->makeSampledPoint(workspace.trust->explanation->point);
    inferred.covariance = workspace.trust->explanation->calcCovariance();
  }
  return inferred;
}

}  // namespace twinmap
