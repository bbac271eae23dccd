#include "framework/measurement/lagrange.hpp"

namespace twinmap {

Stencil makeLagrange(const Eigen::VectorXd& times, Eigen::Index first, int count, double t) {
  Stencil stencil;
  stencil.first = first;
  stencil.count = count;
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      if (i != j) {
        stencil.weights[i] *= (t - times[first + j]) / (times[first + i] - times[first + j]);
      }
    }
  }
  return stencil;
}

double apply(const Stencil& stencil, const Eigen::Ref<const Eigen::VectorXd>& values) {
  if (stencil.count == 1) {
    return values[stencil.first];
  }
  double sum = 0.0;
  for (int k = 0; k < stencil.count; ++k) {
    sum += stencil.weights[k] * values[stencil.first + k];
  }
  return sum;
}

}  // namespace twinmap
