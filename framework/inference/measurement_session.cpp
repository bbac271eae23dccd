#include "framework/inference/measurement_session.hpp"

#include <fmt/core.h>

#include <limits>

#include "framework/base/text/source_location.hpp"
#include "framework/estimation/trained/posterior_model.hpp"
#include "framework/inference/measurement_faults.hpp"

namespace twinmap {
namespace {

PosteriorSampler makeSampler(const Inferrer& inferrer, int draws) {
  if (draws < kMinPosteriorDraws) {
    throw ExperimentError(
        fmt::format("a posterior needs at least {} draws, not {}", kMinPosteriorDraws, draws));
  }
  std::optional<PosteriorModel> model = findPosteriorModel(inferrer.getMap(), inferrer.getTrustModel());
  if (!model) {
    throw ExperimentError(
        "this run has no surrogate to compute posteriors from, for a feature has no noise or the simulations "
        "are too few: give every output noise and train with 'inverse_map: surrogate'");
  }
  return {std::move(*model), draws, inferrer.getExperiment().seed};
}

}  // namespace

MeasurementSession::MeasurementSession(const Inferrer& inferrer, std::optional<bool> refine,
                                       int posterior_draws)
    : inferrer_(inferrer), workspace_(inferrer) {
  if (refine.value_or(inferrer.getExperiment().refine != RefineMode::kNever)) {
    refiner_.emplace(inferrer.getExperiment(), inferrer.getLayout());
    if (!refine && !refiner_->isWanted()) {
      refiner_.reset();
    }
  }
  if (posterior_draws != 0) {
    sampler_.emplace(makeSampler(inferrer, posterior_draws));
  }
}

double MeasurementSession::getStart(std::optional<double> start) const {
  return inferrer_.getReader().getStart(start);
}

InferredMeasurement MeasurementSession::infer(const Table& table, std::optional<double> start,
                                              const Eigen::VectorXd& known) {
  const MeasurementReader& reader = inferrer_.getReader();
  reader.requireExcitation(table, start);
  const Eigen::VectorXd response = reader.readResponse(table, start);
  InferredMeasurement inferred = infer(extractFeatures(reader.getExtractor(), response, table.source), known);
  inferred.fault = findFault(response, known, inferred);
  inferred.source = table.source;
  inferred.start = getStart(start);
  return inferred;
}

InferredMeasurement MeasurementSession::infer(const Eigen::VectorXd& features, const Eigen::VectorXd& known) {
  InferredMeasurement inferred = inferrer_.infer(features, known, workspace_);
  if (refiner_) {
    const std::optional<TrustModel>& trust = inferrer_.getTrustModel();
    refiner_->refineAndJudge(features, known, trust ? &*trust : nullptr, inferred);
  }
  if (sampler_) {
    inferred.posterior = sampler_->sampleFeatures(features, known);
  }
  return inferred;
}

std::string MeasurementSession::findFault(const Eigen::VectorXd& response, const Eigen::VectorXd& known,
                                          const InferredMeasurement& inferred) {
  if (!inferred.trust || inferred.trust->statuses.front() != TrustStatus::kModelMismatch) {
    return "";
  }
  // what the surrogate leaves, also where a refinement has judged the measurement anew
  const auto calcMisfit = [&](const Eigen::VectorXd& corrected) {
    const Eigen::VectorXd features = inferrer_.getExtractor().extract(corrected);
    return features.allFinite() ? inferrer_.infer(features, known, workspace_).trust->chi_square
                                : std::numeric_limits<double>::infinity();
  };
  return explainByFault(response, inferrer_.getLayout(), calcMisfit(response), inferred.trust->residuals,
                        calcMisfit);
}

}  // namespace twinmap
