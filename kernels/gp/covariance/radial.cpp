#include "kernels/gp/covariance/radial.hpp"

namespace twinmap::gp {
namespace {

void evaluateSquaredExponential(ConstAlignedColumn q, AlignedColumn value, AlignedColumn weight) {
  value = (-0.5 * q).exp();
  weight = value;
}

void evaluateMatern32(ConstAlignedColumn q, AlignedColumn value, AlignedColumn weight) {
  weight = (-(3.0 * q).sqrt()).exp();
  value = (1.0 + (3.0 * q).sqrt()) * weight;
  weight *= 3.0;
}

void evaluateMatern52(ConstAlignedColumn q, AlignedColumn value, AlignedColumn weight) {
  weight = (-(5.0 * q).sqrt()).exp();
  value = 5.0 / 3.0 * q * weight;
  weight = (1.0 + (5.0 * q).sqrt()) * weight;
  value += weight;
  weight *= 5.0 / 3.0;
}

void evaluateRationalQuadratic(double shape, ConstAlignedColumn q, AlignedColumn value,
                               AlignedColumn weight) {
  weight = 1.0 + q / (2.0 * shape);
  value = (-shape * weight.log()).exp();
  weight = value / weight;
}

}  // namespace

const char* toString(CovarianceFunction covariance) {
  switch (covariance) {
    case CovarianceFunction::kSquaredExponential:
      return "squared_exponential";
    case CovarianceFunction::kMatern32:
      return "matern32";
    case CovarianceFunction::kMatern52:
      return "matern52";
    case CovarianceFunction::kRationalQuadratic:
      return "rational_quadratic";
  }
  return "unknown";
}

bool hasShape(CovarianceFunction covariance) {
  return covariance == CovarianceFunction::kRationalQuadratic;
}

void evaluateRadial(CovarianceFunction covariance, double shape, ConstAlignedColumn squared_distance,
                    AlignedColumn value, AlignedColumn weight) {
  switch (covariance) {
    case CovarianceFunction::kSquaredExponential:
      return evaluateSquaredExponential(squared_distance, value, weight);
    case CovarianceFunction::kMatern32:
      return evaluateMatern32(squared_distance, value, weight);
    case CovarianceFunction::kMatern52:
      return evaluateMatern52(squared_distance, value, weight);
    case CovarianceFunction::kRationalQuadratic:
      return evaluateRationalQuadratic(shape, squared_distance, value, weight);
  }
}

void evaluateShapeDerivative(double shape, ConstAlignedColumn squared_distance, AlignedColumn derivative) {
  const auto base = 1.0 + squared_distance / (2.0 * shape);
  derivative = (-shape * base.log()).exp() * (0.5 * squared_distance / base - shape * base.log());
}

}  // namespace twinmap::gp
