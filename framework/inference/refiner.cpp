#include "framework/inference/refiner.hpp"

#include "framework/data/features/experiment_features.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/estimation/trained/refinement_starts.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

SimulatorRefiner::SimulatorRefiner(const ExperimentSpec& experiment, const ResponseLayout& layout)
    : model_(experiment.model),
      extractor_(makeExtractor(experiment, layout)),
      simulator_(makeTrustedSimulator(experiment.model, layout.times, layout.modes)),
      noise_(extractor_, ResponseNoise(experiment.noise, layout), experiment.seed),
      wanted_(shouldRefine(experiment.refine, *simulator_, extractor_, noise_)),
      own_(simulator_->clone()) {}

const RefinementModel& SimulatorRefiner::getModel() const {
  if (!shared_) {
    shared_.emplace(collectUnknown(model_), extractor_, noise_);
  }
  return *shared_;
}

Refined SimulatorRefiner::refine(const InferredMeasurement& inferred, const VectorXd& features,
                                 const VectorXd& known, const TrustModel* trust) const {
  const RefinementTask task = makeRefinementTask(
      model_, trust, features,
      {inferred.by_estimator.takeLikeliest().mean, inferred.explanation, known, inferred.covariance});
  Refined refined = twinmap::refine(*own_, getModel(), task);
  if (isMultimodal(inferred.by_estimator.mixture)) {
    rejectAsMultimodal(refined);
  }
  if (refined.isAccepted()) {
    const Index p = inferred.by_estimator.mean.size();
    refined.stddev.conservativeResize(p);
    refined.covariance.conservativeResize(p, p);
  }
  return refined;
}

void SimulatorRefiner::refineAndJudge(const VectorXd& features, const VectorXd& known,
                                      const TrustModel* trust, InferredMeasurement& inferred) const {
  inferred.refined = refine(inferred, features, known, trust);
  const Refined& refined = *inferred.refined;
  if (trust != nullptr) {
    SimulatorResidual found{
        refined.residual, refined.calcReducedChiSquare(), refined.degrees, refined.explained, {}, {}};
    if (refined.isAccepted()) {
      found.mean = refined.point.head(refined.stddev.size());
      found.stddev = refined.stddev;
    }
    inferred.trust = judgeAnew(*trust, *inferred.trust, found);
  }
}

Refined SimulatorRefiner::fitNuisance(const VectorXd& point, const VectorXd& features) const {
  const SearchedParameters nuisance{static_cast<Index>(model_.parameters.size()),
                                    static_cast<Index>(model_.nuisance.size())};
  if (nuisance.count == 0) {
    Refined held;
    held.status = RefinementStatus::kAccepted;
    held.point = point;
    return held;
  }
  return twinmap::refine(*own_, getModel(), {features, {{"given", point}}, nuisance, false});
}

}  // namespace twinmap
