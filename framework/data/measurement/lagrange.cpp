#include "framework/data/measurement/lagrange.hpp"

namespace twinmap {

InterpolationWeights makeLagrange(const Eigen::VectorXd& times, Eigen::Index first, int count, double t) {
  InterpolationWeights weights_at;
  weights_at.first = first;
  weights_at.count = count;
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      if (i != j) {
        weights_at.weights[i] *= (t - times[first + j]) / (times[first + i] - times[first + j]);
      }
    }
  }
  return weights_at;
}

double apply(const InterpolationWeights& weights_at, const Eigen::Ref<const Eigen::VectorXd>& values) {
  if (weights_at.count == 1) {
    return values[weights_at.first];
  }
  double sum = 0.0;
  for (int k = 0; k < weights_at.count; ++k) {
    sum += weights_at.weights[k] * values[weights_at.first + k];
  }
  return sum;
}

}  // namespace twinmap
