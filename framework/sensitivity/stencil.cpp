#include "framework/sensitivity/stencil.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kStep = 1e-4;  // of the bounds' width

/// Two points beside the centre, in steps, and the weights of centre, first and second in the derivative.
struct Stencil {
  double first, second;
  double weight_of_center, weight_of_first, weight_of_second;
};

constexpr Stencil kCentral{-1.0, 1.0, 0.0, -0.5, 0.5};
constexpr Stencil kForward{1.0, 2.0, -1.5, 2.0, -0.5};
constexpr Stencil kBackward{-1.0, -2.0, 1.5, -2.0, 0.5};

double calcWidth(const Bounds& bounds) {
  return bounds.upper - bounds.lower;
}

const Stencil& chooseStencil(const Bounds& bounds, double value) {
  const double step = kStep * calcWidth(bounds);
  if (value - step < bounds.lower) {
    return kForward;
  }
  return value + step > bounds.upper ? kBackward : kCentral;
}

}  // namespace

MatrixXd makeNeighbours(const std::vector<ParameterSpec>& parameters, const VectorXd& point) {
  const auto count = static_cast<Index>(parameters.size());
  MatrixXd points = point.replicate(1, 2 * count + 1);
  for (Index j = 0; j < count; ++j) {
    const Bounds& bounds = parameters[j].bounds;
    const Stencil& stencil = chooseStencil(bounds, point[j]);
    points(j, 2 * j + 1) += stencil.first * kStep * calcWidth(bounds);
    points(j, 2 * j + 2) += stencil.second * kStep * calcWidth(bounds);
  }
  return points;
}

MatrixXd calcDifferences(const MatrixXd& features, const std::vector<ParameterSpec>& parameters,
                         const VectorXd& point) {
  MatrixXd sensitivities(features.rows(), static_cast<Index>(parameters.size()));
  for (Index j = 0; j < sensitivities.cols(); ++j) {
    const Stencil& stencil = chooseStencil(parameters[j].bounds, point[j]);
    sensitivities.col(j) =
        (stencil.weight_of_center * features.col(0) + stencil.weight_of_first * features.col(2 * j + 1) +
         stencil.weight_of_second * features.col(2 * j + 2)) /
        kStep;
  }
  return sensitivities;
}

}  // namespace twinmap
