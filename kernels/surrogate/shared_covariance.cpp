#include "kernels/surrogate/shared_covariance.hpp"

namespace twinmap::gp {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;

void calcSmoothCovariance(SmoothCovariance covariance, Eigen::Ref<ArrayXd> squares_to_values,
                          Eigen::Ref<ArrayXd> slopes) {
  if (covariance == SmoothCovariance::kSquaredExponential) {
    slopes = (-0.5 * squares_to_values).exp();
    squares_to_values = slopes;
    return;
  }
  constexpr double kFiveThirds = 5.0 / 3.0;
  const ArrayXd distance = (5.0 * squares_to_values).sqrt();
  const ArrayXd decay = (-distance).exp();
  slopes = kFiveThirds * (1.0 + distance) * decay;
  squares_to_values = (1.0 + distance + kFiveThirds * squares_to_values) * decay;
}

void calcSmoothCovariance(SmoothCovariance covariance, Eigen::Ref<ArrayXd> squares_to_values,
                          Eigen::Ref<ArrayXd> slopes, Eigen::Ref<ArrayXd> curvatures) {
  if (covariance == SmoothCovariance::kSquaredExponential) {
    calcSmoothCovariance(covariance, squares_to_values, slopes);
    curvatures = slopes;
    return;
  }
  constexpr double kTwentyFiveThirds = 25.0 / 3.0;
  curvatures = kTwentyFiveThirds * (-(5.0 * squares_to_values).sqrt()).exp();
  calcSmoothCovariance(covariance, squares_to_values, slopes);
}

void calcSharedCovariance(const SharedStructure& structure, const SharedHyperparameters& hyperparameters,
                          const MatrixXd& points, MatrixXd& covariance, MatrixXd& slopes) {
  const Index n = points.cols();
  const MatrixXd scaled = points.transpose() * hyperparameters.length_scales.cwiseInverse().asDiagonal();
  covariance.setZero(n, n);
  slopes.resize(n, n);
  for (Index j = 0; j < n; ++j) {
    auto squares = covariance.col(j).tail(n - j).array();
    for (Index v = 0; v < scaled.cols(); ++v) {
      squares += (scaled.col(v).tail(n - j).array() - scaled(j, v)).square();
    }
    calcSmoothCovariance(structure.covariance, squares, slopes.col(j).tail(n - j).array());
    covariance.row(j).tail(n - j) = covariance.col(j).tail(n - j).transpose();
    slopes.row(j).tail(n - j) = slopes.col(j).tail(n - j).transpose();
    covariance(j, j) += hyperparameters.nugget;
  }
}

Index countTerms(Trend trend, Index variables) {
  return trend == Trend::kLinear ? variables + 1 : (variables + 1) * (variables + 2) / 2;
}

MatrixXd calcTerms(Trend trend, const MatrixXd& points) {
  const Index p = points.rows();
  MatrixXd terms(countTerms(trend, p), points.cols());
  terms.row(0).setOnes();
  terms.middleRows(1, p) = points;
  if (trend == Trend::kQuadratic) {
    Index row = p + 1;
    for (Index a = 0; a < p; ++a) {
      for (Index b = a; b < p; ++b) {
        terms.row(row++) = points.row(a).cwiseProduct(points.row(b));
      }
    }
  }
  return terms;
}

void calcTermDerivatives(Trend trend, const Eigen::Ref<const Eigen::VectorXd>& point, MatrixXd& derivatives) {
  const Index p = point.size();
  derivatives.setZero(countTerms(trend, p), p);
  derivatives.middleRows(1, p).diagonal().setOnes();
  if (trend == Trend::kQuadratic) {
    Index row = p + 1;
    for (Index a = 0; a < p; ++a) {
      for (Index b = a; b < p; ++b, ++row) {
        derivatives(row, a) += point(b);
        derivatives(row, b) += point(a);
      }
    }
  }
}

}  // namespace twinmap::gp
