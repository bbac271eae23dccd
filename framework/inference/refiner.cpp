#include "framework/inference/refiner.hpp"

#include "framework/estimation/trained/refinement_starts.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

RefinementTask makeTask(const ModelSpec& model, const TrustModel* trust, const InferredMeasurement& inferred,
                        const VectorXd& features, const VectorXd& known) {
  return makeRefinementTask(
      model, trust, features,
      {inferred.by_estimator.takeLikeliest().mean, inferred.explanation, known, inferred.covariance});
}

void takeRefined(Refined refined, const TrustModel* trust, InferredMeasurement& inferred) {
  if (isMultimodal(inferred.by_estimator.mixture)) {
    rejectAsMultimodal(refined);
  }
  if (refined.isAccepted()) {
    const Index p = inferred.by_estimator.mean.size();
    refined.mean.conservativeResize(p);
    refined.stddev.conservativeResize(p);
    refined.covariance.conservativeResize(p, p);
  }
  if (trust != nullptr) {
    SimulatorResidual found{
        refined.residual, refined.calcReducedChiSquare(), refined.degrees, refined.explained, {}, {}};
    if (refined.isAccepted()) {
      inferred.coverage_is_short = trust->refined_coverage.isShort();
      found.mean = refined.mean;
      found.stddev = refined.stddev;
    }
    inferred.trust = judgeAnew(*trust, *inferred.trust, found);
  }
  inferred.refined = std::move(refined);
}

void SimulatorRefiner::refineAndJudge(const VectorXd& features, const VectorXd& known,
                                      const TrustModel* trust, InferredMeasurement& inferred) const {
  const RefinementTask task = makeTask(getModelSpec(), trust, inferred, features, known);
  takeRefined(refine(updSimulator(), getModel(), task), trust, inferred);
}

MatrixXd SimulatorRefiner::listStarts(const InferredMeasurement& inferred, const VectorXd& features,
                                      const VectorXd& known, const TrustModel* trust) const {
  std::vector<VectorXd> points;
  for (Index k = 0; k < inferred.basins.cols(); ++k) {
    points.emplace_back(inferred.basins.col(k));
  }
  for (const RefinementStart& start : makeTask(getModelSpec(), trust, inferred, features, known).starts) {
    points.push_back(start.point);
  }
  for (Index c = 0; c < inferred.by_estimator.mixture.countComponents(); ++c) {
    points.push_back(
        makePoint(getModelSpec(), inferred.by_estimator.mixture.means.col(c), inferred.explanation, known));
  }
  if (inferred.refined) {
    points.push_back(inferred.refined->point);
  }
  const auto u = static_cast<Index>(getModel().getUnknown().size());
  MatrixXd starts(u, static_cast<Index>(points.size()));
  for (Index k = 0; k < starts.cols(); ++k) {
    starts.col(k) = points[static_cast<std::size_t>(k)].head(u);
  }
  return starts;
}

void SimulatorRefiner::sampleAndJudge(const VectorXd& features, const VectorXd& known,
                                      const TrustModel* trust, const SimulatorPosteriorOptions& options,
                                      InferredMeasurement& inferred) const {
  inferred.posterior = samplePosterior(features, known, describeNoise({}),
                                       listStarts(inferred, features, known, trust), options)
                           .estimate;
  const SimulatorFit& fit = *inferred.posterior->fit;
  if (trust != nullptr && !fit.isAsStated()) {
    inferred.trust.reset();
  } else if (trust != nullptr && fit.isSimulated()) {
    const Estimate& estimate = inferred.posterior->estimate;
    inferred.trust = judgeAnew(*trust, *inferred.trust,
                               {fit.residual, fit.chi_square / fit.degrees, fit.degrees, fit.explained,
                                estimate.mean, estimate.stddev});
  }
}

Refined SimulatorRefiner::fitNuisance(const VectorXd& point, const VectorXd& features) const {
  const SearchedParameters nuisance{static_cast<Index>(getModelSpec().parameters.size()),
                                    static_cast<Index>(getModelSpec().nuisance.size())};
  if (nuisance.count == 0) {
    Refined held;
    held.status = RefinementStatus::kAccepted;
    held.point = point;
    return held;
  }
  return refine(updSimulator(), getModel(),
                {features, {{"given", point}}, nuisance, false, {}, findPrior(getModelSpec())});
}

}  // namespace twinmap
