#include "framework/estimation/trained/refinement_starts.hpp"

#include <algorithm>

#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// More than four similar simulations have rescued no measurement that these had not.
constexpr std::size_t kTrainingStarts = 4;

}  // namespace

VectorXd makePoint(const ModelSpec& model, const VectorXd& parameters, const VectorXd& explanation,
                   const VectorXd& known) {
  VectorXd point = explanation.size() > 0 ? explanation : calcPriorCenter(model);
  point.head(parameters.size()) = parameters;
  point.tail(known.size()) = known;
  return point;
}

RefinementTask makeRefinementTask(const ModelSpec& model, const TrustModel* trust, const VectorXd& features,
                                  const InitialEstimate& initial) {
  RefinementTask task;
  task.features = features;
  task.searched = {0, static_cast<Index>(collectUnknown(model).size())};
  task.prior = findPrior(model);
  task.starts.push_back({"inverse_map", makePoint(model, initial.mean, initial.explanation, initial.known)});
  if (trust == nullptr) {
    task.starts.push_back({"box_center", makePoint(model, {}, {}, initial.known)});
    return task;
  }
  task.covariance = initial.covariance;
  if (initial.explanation.size() > 0) {
    task.starts.push_back({"explanation", initial.explanation});
  }
  const ForwardSurrogate& forward = *trust->forward;
  const std::vector<Index> similar = rankSimulations(forward, forward.calcScores(features));
  for (std::size_t rank = 0; rank < std::min(kTrainingStarts, similar.size()); ++rank) {
    task.starts.push_back(
        {"training " + std::to_string(rank + 1), trust->makeSampledPoint(forward.points.col(similar[rank]))});
  }
  return task;
}

bool shouldRefine(RefineMode mode, const Simulator& simulator, const FeatureNoise& noise) {
  if (mode != RefineMode::kAutomatic) {
    return mode == RefineMode::kAlways;
  }
  const FeatureNoise& fitted = noise.getLinearForm();
  return simulator.hasDerivatives() && fitted.isConstant() &&
         fitted.calcCovariance({}).diagonal().minCoeff() > 0.0;
}

}  // namespace twinmap
