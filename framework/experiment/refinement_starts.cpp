#include "framework/experiment/refinement_starts.hpp"

#include <algorithm>
#include <numeric>

#include "framework/spec/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// More than four similar simulations have rescued no measurement that these had not.
constexpr std::size_t kTrainingStarts = 4;

/// The training simulations by how similar their features are.
std::vector<Index> rankTraining(const ForwardModel& forward, const VectorXd& features) {
  VectorXd whitened;
  forward.whiten(features, whitened);
  const VectorXd scores = forward.components.transpose() * whitened;
  const VectorXd distances = (forward.scores.colwise() - scores).colwise().squaredNorm();
  std::vector<Index> order(static_cast<std::size_t>(distances.size()));
  std::iota(order.begin(), order.end(), 0);
  const std::size_t count = std::min(kTrainingStarts, order.size());
  std::partial_sort(
      order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
      [&](Index a, Index b) { return std::make_pair(distances[a], a) < std::make_pair(distances[b], b); });
  order.resize(count);
  return order;
}

}  // namespace

VectorXd makePoint(const ModelSpec& model, const VectorXd& parameters, const VectorXd& explanation,
                   const VectorXd& known) {
  VectorXd point = explanation.size() > 0 ? explanation : calcBoxCenter(collectSampled(model));
  point.head(parameters.size()) = parameters;
  point.tail(known.size()) = known;
  return point;
}

RefinementTask makeRefinementTask(const ModelSpec& model, const TrustModel* trust, const VectorXd& features,
                                  const MapAnswer& answer) {
  RefinementTask task;
  task.features = features;
  task.searched = {0, static_cast<Index>(collectUnknown(model).size())};
  task.starts.push_back({"inverse_map", makePoint(model, answer.mean, answer.explanation, answer.known)});
  if (trust == nullptr) {
    task.starts.push_back({"box_center", makePoint(model, {}, {}, answer.known)});
    return task;
  }
  if (answer.explanation.size() > 0) {
    task.starts.push_back({"explanation", answer.explanation});
  }
  const Eigen::MatrixXd& points = trust->forward.score_map.getParts().points;
  int rank = 0;
  for (const Index sample : rankTraining(trust->forward, features)) {
    task.starts.push_back(
        {"training " + std::to_string(++rank), trust->makeSampledPoint(points.col(sample))});
  }
  return task;
}

bool shouldRefine(RefineMode mode, const Simulator& simulator, const FeatureExtractor& extractor,
                  const FeatureNoise& noise) {
  if (mode != RefineMode::kAutomatic) {
    return mode == RefineMode::kAlways;
  }
  return simulator.hasDerivatives() && extractor.isLinear() &&
         noise.calcCovariance({}).diagonal().minCoeff() > 0.0;
}

}  // namespace twinmap
