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

MeasuredTrial DirectInferrer::prepare(const Table& table, std::optional<double> start,
                                      const VectorXd& known) {
  const std::vector<ParameterSpec>& unknown = model_->getUnknown();
  VectorXd held(static_cast<Index>(unknown.size()) + known.size());
  held << calcBoxCenter(unknown), known;
  return {simulator_.get(), model_.get(), reader_.readFeatures(table, start), held, {}};
}

DirectInference DirectInferrer::infer(const Table& table, std::optional<double> start,
                                      const VectorXd& known) {
  const MeasuredTrial trial = prepare(table, start, known);
  DirectInference inferred;
  inferred.source = table.source;
  inferred.start = reader_.getStart(start);
  inferred.posterior =
      samplePosterior(*simulator_, *model_, reader_.getExperiment().model.priors, trial.features, trial.held,
                      MatrixXd(static_cast<Index>(getUnknown().size()), 0), options_);
  if (inferred.posterior.degrees > 0.0) {
    inferred.test = testResidual(inferred.posterior.residual, inferred.posterior.degrees,
                                 reader_.getExtractor().getInfos());
  }
  return inferred;
}

}  // namespace twinmap
