#include "framework/inference/tolerances/integration_errors.hpp"

#include "framework/data/features/experiment_features.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/data/sensitivity/feature_sensitivities.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/point_set.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/simulation/sample_generator.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

constexpr std::uint64_t kSeed = 1;

MatrixXd sampleBox(const ModelSpec& model) {
  PointSetSpec sobol;
  sobol.method = DesignMethod::kSobol;
  sobol.samples = 16;  // as many as lanes take side by side
  return samplePoints(sobol, collectSampled(model), kSeed, RandomPurpose::kTestDesign);
}

}  // namespace

IntegrationErrors::IntegrationErrors(const ExperimentSpec& experiment)
    : experiment_(experiment),
      layout_(makeLayout(experiment)),
      extractor_(makeExtractor(experiment, layout_)),
      noise_(extractor_, ResponseNoise(experiment.noise, layout_), kSeed),
      points_(sampleBox(experiment.model)) {}

/// Leaves out points where a feature is missing or has no noise.
void IntegrationErrors::whiten(const MatrixXd& responses) {
  const MatrixXd features = getExtractor().extract(responses);
  whiteners_.resize(getNoise().isConstant() ? 1 : static_cast<std::size_t>(responses.cols()));
  for (std::size_t i = 0; i < whiteners_.size(); ++i) {
    const auto column = static_cast<Index>(i);
    if (getNoise().isConstant() || features.col(column).allFinite()) {
      const NoiseCovariance covariance = getNoise().calcCovariance(responses.col(column));
      if (covariance.diagonal().minCoeff() > 0.0) {
        whiteners_[i].emplace(covariance);
      }
    }
  }
}

const NoiseWhitener* IntegrationErrors::findWhitener(std::size_t point) const {
  const std::optional<NoiseWhitener>& own = whiteners_[getNoise().isConstant() ? 0 : point];
  return own ? &*own : nullptr;
}

void IntegrationErrors::linearize(const Simulator& simulator) {
  const std::vector<LocalModel> models =
      calcLocalModels(simulator, getExtractor(), collectUnknown(experiment_.model), points_, 0);
  for (std::size_t i = 0; i < models.size(); ++i) {
    const NoiseWhitener* whitener = findWhitener(i);
    sensitivities_.push_back(
        whitener != nullptr && models[i].status.ok ? whitener->apply(models[i].sensitivities) : MatrixXd());
  }
}

std::optional<IntegrationError> IntegrationErrors::calc(const SimulationSpec& simulation) {
  ModelSpec model = experiment_.model;
  model.simulation = simulation;
  const std::unique_ptr<Simulator> simulator = makeTrustedSimulator(model, layout_.times, layout_.modes);
  const std::unique_ptr<Simulator> precise = simulator->clonePrecisely();
  return precise ? compare(*simulator, *precise) : std::nullopt;
}

std::optional<IntegrationError> IntegrationErrors::calcChange(const SimulationSpec& simulation,
                                                              ModelSpec other) {
  ModelSpec model = experiment_.model;
  model.simulation = other.simulation = simulation;
  return compare(*makeTrustedSimulator(model, layout_.times, layout_.modes),
                 *makeTrustedSimulator(other, layout_.times, layout_.modes));
}

std::optional<IntegrationError> IntegrationErrors::compare(const Simulator& simulator,
                                                           const Simulator& other) {
  constexpr Index kFirst = 4;  // where none succeeds, as with a force that chatters, all would take minutes
  if (!generateSamples(simulator, points_.leftCols(kFirst)).responses.array().isFinite().any()) {
    return std::nullopt;
  }
  const MatrixXd responses = generateSamples(other, points_).responses;
  const MatrixXd errors = getExtractor().extract(generateSamples(simulator, points_).responses) -
                          getExtractor().extract(responses);
  if (whiteners_.empty()) {
    whiten(responses);
  }
  std::vector<FeatureError> found;
  std::vector<std::size_t> simulated;
  for (Index i = 0; i < errors.cols(); ++i) {
    const NoiseWhitener* whitener = findWhitener(static_cast<std::size_t>(i));
    if (whitener != nullptr && errors.col(i).allFinite()) {
      simulated.push_back(static_cast<std::size_t>(i));
      found.push_back({whitener->apply(errors.col(i)), {}});
    }
  }
  if (2 * found.size() < static_cast<std::size_t>(errors.cols())) {
    return std::nullopt;
  }
  const IntegrationError bound = boundIntegrationError(found);
  if (bound.isNegligible()) {
    return bound;
  }
  if (sensitivities_.empty()) {
    linearize(simulator);
  }
  std::vector<FeatureError> linearized;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (const MatrixXd& own = sensitivities_[simulated[i]]; own.size() > 0) {
      linearized.push_back({std::move(found[i].error), own});
    }
  }
  return calcIntegrationError(linearized, static_cast<Index>(experiment_.model.parameters.size()));
}

}  // namespace twinmap
