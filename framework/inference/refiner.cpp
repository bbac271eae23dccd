#include "framework/inference/refiner.hpp"

#include "framework/experiment/prepare_data.hpp"
#include "framework/features/noise.hpp"
#include "framework/spec/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

SimulatorRefiner::SimulatorRefiner(const ExperimentSpec& experiment, const ResponseLayout& layout)
    : model_(experiment.model),
      extractor_(makeExtractor(experiment, layout)),
      simulator_(experiment.model, layout.times, layout.modes),
      noise_(extractor_, ResponseNoise(experiment.noise, layout), experiment.seed) {}

Refined SimulatorRefiner::refine(const InferredMeasurement& inferred, const VectorXd& features,
                                 const VectorXd& known) const {
  const VectorXd start = makePoint(model_, inferred.inference.mean, inferred.explanation, known);
  const SearchedParameters all{0, static_cast<Index>(collectUnknown(model_).size())};
  Refined refined = twinmap::refine(model_, simulator_, extractor_, noise_, features, start, all);
  refined.stddev.conservativeResize(std::min<Index>(refined.stddev.size(), inferred.inference.mean.size()));
  return refined;
}

Refined SimulatorRefiner::fitNuisance(const VectorXd& point, const VectorXd& features) const {
  const SearchedParameters nuisance{static_cast<Index>(model_.parameters.size()),
                                    static_cast<Index>(model_.nuisance.size())};
  if (nuisance.count == 0) {
    Refined held;
    held.point = point;
    held.converged = true;
    return held;
  }
  return twinmap::refine(model_, simulator_, extractor_, noise_, features, point, nuisance);
}

VectorXd makePoint(const ModelSpec& model, const VectorXd& parameters, const VectorXd& explanation,
                   const VectorXd& known) {
  VectorXd point = explanation.size() > 0 ? explanation : calcBoxCenter(collectSampled(model));
  point.head(parameters.size()) = parameters;
  point.tail(known.size()) = known;
  return point;
}

}  // namespace twinmap
