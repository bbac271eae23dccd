#include "framework/inference/refiner.hpp"

#include "framework/features/noise.hpp"
#include "framework/spec/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

SimulatorRefiner::SimulatorRefiner(const Inferrer& inferrer)
    : inferrer_(inferrer),
      simulator_(inferrer.getExperiment().model, inferrer.getLayout().times, inferrer.getLayout().modes),
      noise_(inferrer.getExtractor(), ResponseNoise(inferrer.getExperiment().noise, inferrer.getLayout()),
             inferrer.getExperiment().seed) {}

Refined SimulatorRefiner::refine(const InferredMeasurement& inferred, const VectorXd& features,
                                 const VectorXd& known) const {
  const ModelSpec& model = inferrer_.getExperiment().model;
  const VectorXd start = makePoint(model, inferred.inference.mean, inferred.explanation, known);
  const SearchedParameters all{0, static_cast<Index>(collectUnknown(model).size())};
  Refined refined =
      twinmap::refine(model, simulator_, inferrer_.getExtractor(), noise_, features, start, all);
  refined.stddev.conservativeResize(std::min<Index>(refined.stddev.size(), inferred.inference.mean.size()));
  return refined;
}

Refined SimulatorRefiner::fitNuisance(const VectorXd& point, const VectorXd& features) const {
  const ModelSpec& model = inferrer_.getExperiment().model;
  const SearchedParameters nuisance{static_cast<Index>(model.parameters.size()),
                                    static_cast<Index>(model.nuisance.size())};
  if (nuisance.count == 0) {
    Refined held;
    held.point = point;
    held.converged = true;
    return held;
  }
  return twinmap::refine(model, simulator_, inferrer_.getExtractor(), noise_, features, point, nuisance);
}

VectorXd makePoint(const ModelSpec& model, const VectorXd& parameters, const VectorXd& explanation,
                   const VectorXd& known) {
  VectorXd point = explanation.size() > 0 ? explanation : calcBoxCenter(collectSampled(model));
  point.head(parameters.size()) = parameters;
  point.tail(known.size()) = known;
  return point;
}

}  // namespace twinmap
