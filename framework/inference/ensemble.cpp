#include "framework/inference/ensemble.hpp"

#include <algorithm>
#include <cmath>

#include "framework/spec/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

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

MatrixXd drawNormal(const VectorXd& mean, const VectorXd& stddev, const MatrixXd& correlation, int draws,
                    const RandomStream& random) {
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(correlation);
  const VectorXd scale = eigen.values.cwiseMax(0.0).cwiseSqrt();
  const MatrixXd factor = stddev.asDiagonal() * eigen.vectors * scale.asDiagonal();
  const MatrixXd normal = MatrixXd::NullaryExpr(mean.size(), draws, [&](Index p, Index j) {
    return random.calcNormal(static_cast<std::uint64_t>(j), static_cast<std::uint64_t>(p));
  });
  return (factor * normal).colwise() + mean;
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
