#include "framework/inference/measurement/measurement_session.hpp"

#include <limits>

#include "framework/base/text/source_location.hpp"
#include "framework/estimation/trained/posterior_model.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/measurement/direct_inference.hpp"
#include "framework/inference/measurement/measurement_faults.hpp"
#include "framework/inference/measurement/posterior_need.hpp"

namespace twinmap {
namespace {

PosteriorSampler makeSampler(const Inferrer& inferrer, const SimulatorPosteriorOptions& options) {
  std::optional<PosteriorModel> model =
      findPosteriorModel(inferrer.getMap(), inferrer.getTrustModel(), inferrer.getExperiment().model);
  if (!model) {
    throw ExperimentError(
        "this run has no surrogate to compute posteriors from, for a feature has no noise or the simulations "
        "are too few: give every output noise and train with 'inverse_map: surrogate'");
  }
  return {std::move(*model), options.draws, options.seed};
}

}  // namespace

MeasurementSession::MeasurementSession(const Inferrer& inferrer, const SessionOptions& options)
    : inferrer_(inferrer),
      workspace_(inferrer.getModel()),
      posterior_options_(makePosteriorOptions(
          inferrer.getExperiment(),
          options.posterior_draws != 0 ? options.posterior_draws : SimulatorPosteriorOptions{}.draws)) {
  posterior_options_.profiles = options.profiles;
  const ExperimentSpec& experiment = inferrer.getExperiment();
  const bool may_refine = options.refine.value_or(experiment.refine != RefineMode::kNever);
  if (may_refine || options.posterior_draws != 0) {
    if (inferrer.getReader().findReduction() != nullptr) {
      simulator_.emplace(experiment, inferrer.getLayout(), inferrer.getReader().makeReducedSimulator());
    } else {
      simulator_.emplace(experiment, inferrer.getLayout());
    }
    refines_ = may_refine && (options.refine || simulator_->isWanted());
  }
  samples_where_needed_ =
      refines_ && simulator_->samplesFast() && options.posterior_from != PosteriorSource::kSurrogate;
  if (options.posterior_draws != 0) {
    choosePosterior(options);
  }
  if (!refines_ && !samples_always_) {
    simulator_.reset();
  }
}

MeasurementSession::~MeasurementSession() = default;

void MeasurementSession::choosePosterior(const SessionOptions& options) {
  samples_always_ = options.posterior_from ? *options.posterior_from == PosteriorSource::kSimulator
                                           : simulator_->samplesFast();
  if (samples_always_) {
    simulator_->requireNoise();
  } else {
    sampler_.emplace(makeSampler(inferrer_, posterior_options_));
    doubt_ = findPosteriorDoubt(inferrer_.getMap(), inferrer_.getTrustModel(),
                                inferrer_.getExperiment().model.parameters);
  }
}

InferredMeasurement MeasurementSession::infer(const Table& table, std::optional<double> start,
                                              const Eigen::VectorXd& known) {
  if (const ResponseReduction* reduction = getReader().findReduction()) {
    const AvailableFeatures found = getReader().readAvailableFeatures(table, start);
    getReader().warnOfInterpolation(table, start);
    InferredMeasurement inferred = inferResponse(table, start, found.response, found.features, known);
    inferred.remarks.push_back(reduction->describe(inferrer_.getExperiment().model.parameters));
    if (inferred.trust && inferred.trust->statuses.front() == TrustStatus::kModelMismatch) {
      inferred.remarks.emplace_back(
          "reduced samples do not show what misfits; inference from the experiment file does "
          "(twinmap infer FILE.yaml MEASUREMENT)");
    }
    return inferred;
  }
  if (!samplesByNeed()) {
    return MeasurementInference::infer(table, start, known);
  }
  if (getReader().followTimes(table, start)) {
    return getDirect().infer(table, start, known);
  }
  const AvailableFeatures found = getReader().readAvailableFeatures(table, start);
  if (!found.isComplete()) {
    return getDirect().infer(table, start, known);
  }
  InferredMeasurement inferred = inferResponse(table, start, found.response, found.features, known);
  getDirect().tryNuisance(found, known, inferred);
  return inferred;
}

DirectInference& MeasurementSession::getDirect() {
  if (!direct_) {
    direct_ =
        std::make_unique<DirectInference>(getReader(), posterior_options_.draws,
                                          SimulatorRefiner::Model::kTrusted, posterior_options_.profiles);
  }
  return *direct_;
}

InferredMeasurement MeasurementSession::infer(const Eigen::VectorXd& features, const Eigen::VectorXd& known) {
  InferredMeasurement inferred = inferrer_.infer(features, known, workspace_);
  const TrustModel* trust = inferrer_.getTrustModel() ? &*inferrer_.getTrustModel() : nullptr;
  if (refines_) {
    simulator_->refineAndJudge(features, known, trust, inferred);
  }
  if (samples_always_ ||
      (samples_where_needed_ && needsPosterior(inferred, inferrer_.getExperiment().model.parameters,
                                               inferrer_.getExtractor().getInfos()))) {
    simulator_->sampleAndJudge(features, known, trust, posterior_options_, inferred);
  }
  if (sampler_) {
    inferred.posterior = makePosteriorEstimate(sampler_->sampleFeatures(features, known),
                                               collectUnknown(inferrer_.getExperiment().model), doubt_);
  }
  return inferred;
}

std::string MeasurementSession::findFault(const Eigen::VectorXd& response, const Eigen::VectorXd& known,
                                          const InferredMeasurement& inferred) {
  const bool is_reduced = getReader().findReduction() != nullptr;  // scores are no outputs of a sensor
  if (is_reduced || !inferred.trust || inferred.trust->statuses.front() != TrustStatus::kModelMismatch) {
    return "";
  }
  // what the surrogate leaves, also where a refinement has judged the measurement anew; without some
  // samples only the simulator can say
  const auto calcMisfit = [&](const Eigen::VectorXd& corrected) {
    const Eigen::VectorXd features = inferrer_.getExtractor().extract(corrected);
    if (features.allFinite()) {
      return inferrer_.infer(features, known, workspace_).trust->chi_square;
    }
    return samplesByNeed() ? simulator_->findLeastChiSquare(features, known, features.size())
                           : std::numeric_limits<double>::infinity();
  };
  return explainByFault(response, inferrer_.getLayout(), calcMisfit(response), inferred.trust->residuals,
                        calcMisfit);
}

}  // namespace twinmap
