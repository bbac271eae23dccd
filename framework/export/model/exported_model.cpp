#include "framework/export/model/exported_model.hpp"

#include "framework/data/features/experiment_features.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/inferrer.hpp"
#include "framework/store/trained_file.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

const GpMap* ExportedModel::findProcesses() const {
  const auto* processes = dynamic_cast<const OnlineProcesses*>(online.map.get());
  return processes == nullptr ? nullptr : &processes->getMap();
}

const Surrogate* ExportedModel::findSurrogate() const {
  const auto* surrogate = dynamic_cast<const OnlineSurrogate*>(online.map.get());
  return surrogate == nullptr ? nullptr : &surrogate->getSurrogate();
}

const NetworkMap* ExportedModel::findNetwork() const {
  const auto* network = dynamic_cast<const OnlineNetwork*>(online.map.get());
  return network == nullptr ? nullptr : &network->getMap();
}

const ForwardSurrogate* ExportedModel::findForward() const {
  if (const auto forward = online.map->findForward()) {
    return forward.get();
  }
  return online.trust ? online.trust->forward.get() : nullptr;
}

const BoxPrior* ExportedModel::findPrior() const {
  if (const Surrogate* surrogate = findSurrogate()) {
    return &surrogate->prior;
  }
  return online.trust ? &online.trust->prior : nullptr;
}

Index ExportedModel::countParameters() const {
  return static_cast<Index>(experiment.model.parameters.size());
}

Index ExportedModel::countKnown() const {
  return static_cast<Index>(experiment.model.inputs.size());
}

Index ExportedModel::countUnknown() const {
  return static_cast<Index>(collectUnknown(experiment.model).size());
}

Eigen::MatrixXd ExportedModel::getCorrelation() const {
  return online.map->getResidualCorrelation();
}

VectorXd ExportedModel::getIntervalFactors() const {
  const IntervalFactors factors = online.map->getIntervalFactors();
  return factors.isGiven() ? VectorXd(factors.of95) : VectorXd::Constant(countParameters(), kNormal95);
}

VectorXd ExportedModel::getBoxCenter() const {
  return calcBoxCenter(collectSampled(experiment.model));
}

VectorXd ExportedModel::getBoxHalfWidth() const {
  return 0.5 * calcWidths(collectSampled(experiment.model));
}

ExportedModel loadExportedModel(const std::filesystem::path& run_or_maps) {
  TrainedFile stored = readTrainedFile(findMaps(run_or_maps));
  if (stored.reduction) {
    throw ExperimentError(
        "a map of reduced samples cannot be exported: it needs all samples of a recording: give them "
        "'reduce: none', or take fewer");
  }
  ExportedModel model;
  model.experiment = readResolved(stored.experiment);
  model.layout = makeLayout(model.experiment);
  model.sample_interval = findSampleInterval(model.experiment.features);
  model.features = makeExtractor(model.experiment, model.layout).getInfos();
  model.online = std::move(stored.model);
  const NetworkMap* network = model.findNetwork();
  if (network == nullptr && model.findProcesses() == nullptr && model.findSurrogate() == nullptr) {
    throw std::runtime_error(findMaps(run_or_maps).string() + ": an estimator of the kind " +
                             model.online.map->getKind() + " cannot be exported");
  }
  if (model.online.map->givesMixtures()) {
    throw std::runtime_error(
        findMaps(run_or_maps).string() +
        ": a network whose estimates are mixtures cannot be exported; train one with 'head: gaussian'");
  }
  if (network != nullptr && network->isBayesian()) {
    throw std::runtime_error(findMaps(run_or_maps).string() +
                             ": a Bayesian network cannot be exported; train one with 'bayesian: none'");
  }
  return model;
}

}  // namespace twinmap
