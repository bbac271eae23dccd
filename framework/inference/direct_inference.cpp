#include "framework/inference/direct_inference.hpp"

#include "framework/base/text/source_location.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

std::unique_ptr<const RefinementModel> makeModel(const MeasurementReader& reader, const FeatureNoise& noise) {
  try {
    return std::make_unique<const RefinementModel>(collectUnknown(reader.getExperiment().model),
                                                   reader.getExtractor(), noise);
  } catch (const std::invalid_argument& error) {
    throw ExperimentError(
        std::string(error.what()) +
        ": a measurement says nothing about parameters unless its noise is known; give every "
        "output that features read a 'noise.stddev'");
  }
}

bool isUninformative(const SimulatorPosterior& posterior, const std::vector<ParameterSpec>& parameters) {
  constexpr double kShare = 0.9;  // as trained estimators judge it
  const VectorXd prior = Prior(parameters, {}).calcStddevs();
  return (posterior.stddev.head(prior.size()).array() > kShare * prior.array()).any();
}

}  // namespace

std::vector<std::string> listStatuses(const DirectInference& inferred,
                                      const std::vector<ParameterSpec>& parameters) {
  const SimulatorPosterior& posterior = inferred.posterior;
  if (!(posterior.degrees > 0.0)) {
    return {"not_simulated"};
  }
  std::vector<std::string> statuses;
  if (inferred.test.calcPValue() < kMismatchLevel) {
    statuses.emplace_back("model_mismatch");
  }
  if (!posterior.isReliable()) {
    statuses.emplace_back("unreliable");
  } else {
    if (posterior.modes.size() > 1) {
      statuses.emplace_back("multimodal");
    }
    if (isUninformative(posterior, parameters)) {
      statuses.emplace_back("uninformative");
    }
  }
  return statuses.empty() ? std::vector<std::string>{"ok"} : statuses;
}

DirectInferrer::DirectInferrer(ExperimentSpec experiment, int draws)
    : reader_(std::move(experiment)),
      prototype_(
          makeSimulator(reader_.getExperiment().model, reader_.getLayout().times, reader_.getLayout().modes)),
      simulator_(prototype_->clone()),
      noise_(reader_.getExtractor(), ResponseNoise(reader_.getExperiment().noise, reader_.getLayout()),
             reader_.getExperiment().seed),
      model_(makeModel(reader_, noise_)) {
  options_.draws = draws;
  options_.seed = reader_.getExperiment().seed;
}

MeasuredTrial DirectInferrer::prepare(const AvailableFeatures& found, const VectorXd& known) const {
  const std::vector<ParameterSpec>& unknown = model_->getUnknown();
  VectorXd held(static_cast<Index>(unknown.size()) + known.size());
  held << calcBoxCenter(unknown), known;
  MeasuredTrial trial{simulator_.get(), model_.get(), found.features, held, {}};
  if (static_cast<Index>(found.available.size()) < found.features.size()) {
    trial.own_model =
        std::make_shared<const RefinementModel>(unknown, reader_.getExtractor(), noise_, found.available);
    trial.model = trial.own_model.get();
  }
  return trial;
}

MeasuredTrial DirectInferrer::prepare(const Table& table, std::optional<double> start,
                                      const VectorXd& known) {
  return prepare(reader_.readAvailableFeatures(table, start), known);
}

DirectInference DirectInferrer::infer(const Table& table, std::optional<double> start,
                                      const VectorXd& known) {
  const AvailableFeatures found = reader_.readAvailableFeatures(table, start);
  const MeasuredTrial trial = prepare(found, known);
  DirectInference inferred;
  inferred.remarks = found.remarks;
  inferred.left_out = found.features.size() - static_cast<Index>(found.available.size());
  inferred.source = table.source;
  inferred.start = reader_.getStart(start);
  inferred.posterior =
      samplePosterior(*simulator_, *trial.model, reader_.getExperiment().model.priors, trial.features,
                      trial.held, MatrixXd(static_cast<Index>(getUnknown().size()), 0), options_);
  if (inferred.posterior.degrees > 0.0) {
    std::vector<FeatureInfo> infos;
    for (const Index i : found.available) {
      infos.push_back(reader_.getExtractor().getInfos()[static_cast<std::size_t>(i)]);
    }
    inferred.test = testResidual(inferred.posterior.residual, inferred.posterior.degrees, infos);
    if (inferred.test.largest >= 0) {
      inferred.largest = infos[static_cast<std::size_t>(inferred.test.largest)].name;
    }
  }
  return inferred;
}

}  // namespace twinmap
