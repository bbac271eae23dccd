#include "framework/inference/ensemble.hpp"

#include <algorithm>
#include <cmath>

#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd clipToBounds(const MatrixXd& points, const std::vector<ParameterSpec>& parameters) {
  const VectorXd lower = calcLowerBounds(parameters);
  const VectorXd upper = lower + calcWidths(parameters);
  MatrixXd clipped = points;
  for (Index j = 0; j < points.cols(); ++j) {
    clipped.col(j) = points.col(j).cwiseMax(lower).cwiseMin(upper);
  }
  return clipped;
}

VectorXd calcRowQuantiles(const MatrixXd& values, double probability) {
  const double position = probability * static_cast<double>(values.cols() - 1);
  const auto below = static_cast<Index>(std::floor(position));
  const Index above = std::min(below + 1, values.cols() - 1);
  VectorXd quantiles(values.rows());
  for (Index row = 0; row < values.rows(); ++row) {
    VectorXd sorted = values.row(row);
    std::sort(sorted.begin(), sorted.end());
    quantiles[row] =
        sorted[below] + (position - static_cast<double>(below)) * (sorted[above] - sorted[below]);
  }
  return quantiles;
}

}  // namespace twinmap
