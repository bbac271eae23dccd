#include "framework/estimation/ridges/local_sums.hpp"

#include <cmath>

#include "framework/estimation/ridges/candidates.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Eigen::VectorXi;

namespace {

/// The directions at one point, in widths (g x k), that are neither flat nor of the combinations.
MatrixXd findUnnamed(const FlatDirections& flat, const std::vector<Combination>& combinations,
                     const VectorXd& widths) {
  MatrixXd taken = flat.changes.front() * flat.changes.front().transpose();
  for (const Combination& combination : combinations) {
    VectorXd gradient =
        calcGradient(combination, flat.points.col(0)).cwiseProduct(widths)(flat.parameters).normalized();
    gradient -= taken * gradient;
    gradient.normalize();
    taken += gradient * gradient.transpose();
  }
  const auto named = static_cast<Index>(combinations.size());
  return linalg::calcSymmetricEigen(taken).vectors.leftCols(taken.rows() - flat.dimension - named);
}

/// Subtracts columns of each other until each has a row of its own where it is 1 and all others are 0. So
/// sums are short; the largest entries come first.
void reduceColumns(MatrixXd& columns) {
  for (Index k = 0; k < columns.cols(); ++k) {
    Index row = 0, column = 0;
    columns.rightCols(columns.cols() - k).cwiseAbs().maxCoeff(&row, &column);
    columns.col(k).swap(columns.col(k + column));
    columns.col(k) /= columns(row, k);
    for (Index other = 0; other < columns.cols(); ++other) {
      if (other != k) {
        columns.col(other) -= columns(row, other) * columns.col(k);
      }
    }
  }
}

/// A column as a sum of the parameters, without what hardly matters.
Combination makeSum(const VectorXd& column, const FlatDirections& flat, const VectorXd& widths) {
  Combination sum;
  for (Index k = 0; k < column.size(); ++k) {
    const Index j = flat.parameters[static_cast<std::size_t>(k)];
    if (std::abs(column[k]) > kMattersInSum * column.cwiseAbs().maxCoeff()) {
      sum.terms.emplace_back(VectorXi::Unit(widths.size(), j));
      sum.coefficients.push_back(column[k] / widths[j]);
    }
  }
  divideByFirst(sum);
  for (double& coefficient : sum.coefficients) {
    coefficient = roundToThreeDigits(coefficient);
  }
  return sum;
}

}  // namespace

std::vector<Combination> findLocalSums(const FlatDirections& flat,
                                       const std::vector<Combination>& combinations,
                                       const std::vector<ParameterSpec>& parameters) {
  const VectorXd widths = calcWidths(parameters);
  MatrixXd columns = findUnnamed(flat, combinations, widths);
  reduceColumns(columns);
  std::vector<Combination> sums;
  for (const auto& column : columns.colwise()) {
    sums.push_back(makeSum(column, flat, widths));
  }
  return sums;
}

}  // namespace twinmap
