#include "framework/simulation/stencil.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Two points beside the centre, in steps, and the weights of centre, first and second in the derivative.
struct DifferenceWeights {
  double first, second;
  double weight_of_center, weight_of_first, weight_of_second;
};

constexpr DifferenceWeights kCentral{-1.0, 1.0, 0.0, -0.5, 0.5};
constexpr DifferenceWeights kForward{1.0, 2.0, -1.5, 2.0, -0.5};
constexpr DifferenceWeights kBackward{-1.0, -2.0, 1.5, -2.0, 0.5};

double calcWidth(const Bounds& bounds) {
  return bounds.upper - bounds.lower;
}

const DifferenceWeights& chooseWeights(const Bounds& bounds, double value, double relative_step) {
  const double step = relative_step * calcWidth(bounds);
  if (value - step < bounds.lower) {
    return kForward;
  }
  return value + step > bounds.upper ? kBackward : kCentral;
}

}  // namespace

MatrixXd makeNeighbours(const std::vector<ParameterSpec>& parameters, const VectorXd& point, double step) {
  return makeNeighbours(parameters, point,
                        VectorXd(VectorXd::Constant(static_cast<Index>(parameters.size()), step)));
}

MatrixXd makeNeighbours(const std::vector<ParameterSpec>& parameters, const VectorXd& point,
                        const VectorXd& steps) {
  const auto count = static_cast<Index>(parameters.size());
  MatrixXd points = point.replicate(1, 2 * count + 1);
  for (Index j = 0; j < count; ++j) {
    const Bounds& bounds = parameters[j].bounds;
    const DifferenceWeights& weights = chooseWeights(bounds, point[j], steps[j]);
    points(j, 2 * j + 1) += weights.first * steps[j] * calcWidth(bounds);
    points(j, 2 * j + 2) += weights.second * steps[j] * calcWidth(bounds);
  }
  return points;
}

VectorXd calcDifference(const Eigen::Ref<const VectorXd>& center,
                        const Eigen::Ref<const MatrixXd>& neighbours, const Bounds& bounds, double at,
                        double step) {
  const DifferenceWeights& weights = chooseWeights(bounds, at, step);
  return (weights.weight_of_center * center + weights.weight_of_first * neighbours.col(0) +
          weights.weight_of_second * neighbours.col(1)) /
         step;
}

MatrixXd calcDifferences(const MatrixXd& features, const std::vector<ParameterSpec>& parameters,
                         const VectorXd& point, double step) {
  MatrixXd sensitivities(features.rows(), static_cast<Index>(parameters.size()));
  for (Index j = 0; j < sensitivities.cols(); ++j) {
    sensitivities.col(j) = calcDifference(features.col(0), features.middleCols(2 * j + 1, 2),
                                          parameters[j].bounds, point[j], step);
  }
  return sensitivities;
}

}  // namespace twinmap
