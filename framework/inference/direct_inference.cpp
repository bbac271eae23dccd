#include "framework/inference/direct_inference.hpp"

#include "framework/base/text/source_location.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/estimation/ridges/simulated_ridges.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/derived_values.hpp"
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

/// Draws that stand for the posterior, each once at most: where the sum of the weights passes equal steps.
std::vector<Index> chooseDraws(const VectorXd& weights) {
  constexpr double kDraws = 32.0;
  std::vector<Index> chosen;
  double passed = 0.0;
  for (Index i = 0; i < weights.size(); ++i) {
    const double before = passed;
    passed += weights[i];
    if (std::floor(passed * kDraws + 0.5) > std::floor(before * kDraws + 0.5)) {
      chosen.push_back(i);
    }
  }
  return chosen;
}

bool isUninformative(const SimulatorPosterior& posterior, const std::vector<ParameterSpec>& parameters) {
  constexpr double kShare = 0.9;  // as trained estimators judge it
  const VectorXd prior = calcWidths(parameters) / std::sqrt(12.0);
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
      model_(makeModel(reader_, noise_)),
      quantities_(makeDerivedQuantities(reader_.getExperiment())) {
  options_.draws = draws;
  options_.seed = reader_.getExperiment().seed;
}

DirectInference DirectInferrer::infer(const Table& table, std::optional<double> start,
                                      const VectorXd& known) {
  const VectorXd features = reader_.readFeatures(table, start);
  const std::vector<ParameterSpec>& unknown = model_->getUnknown();
  const auto u = static_cast<Index>(unknown.size());
  VectorXd held(u + known.size());
  held << calcBoxCenter(unknown), known;
  DirectInference inferred;
  inferred.source = table.source;
  inferred.start = reader_.getStart(start);
  inferred.posterior = samplePosterior(*simulator_, *model_, features, held, MatrixXd(u, 0), options_);
  if (inferred.posterior.degrees > 0.0) {
    inferred.test = testResidual(inferred.posterior.residual, inferred.posterior.degrees,
                                 reader_.getExtractor().getInfos());
  }
  inferred.ridges = findRidges(inferred.posterior, known);
  inferred.quantities = quantities_;
  return inferred;
}

std::vector<Ridge> DirectInferrer::findRidges(const SimulatorPosterior& posterior,
                                              const VectorXd& known) const {
  if (!posterior.isReliable() || !prototype_->hasDerivatives()) {
    return {};
  }
  const std::vector<Index> chosen = chooseDraws(posterior.weights);
  const Index u = posterior.draws.rows(), count = static_cast<Index>(chosen.size());
  MatrixXd points(u + known.size(), count);
  points << posterior.draws(Eigen::all, chosen), known.replicate(1, count);
  return simulateRidges(*prototype_, reader_.getExtractor(), noise_, reader_.getExperiment().model, points,
                        1);
}

}  // namespace twinmap
