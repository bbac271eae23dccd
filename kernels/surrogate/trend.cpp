#include "kernels/surrogate/trend.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;

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
