#include "kernels/gp/sparse/inducing_points.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/gp/cross_covariance.hpp"
#include "kernels/gp/training_set.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Enough to choose among; time and memory grow in proportion.
constexpr Index kCandidatesPerPoint = 8;
constexpr double kDetermined = 1e-10;  // of the prior variance: below, a point adds nothing but rounding

MatrixXd select(const Eigen::Ref<const MatrixXd>& inputs, const std::vector<Index>& indices) {
  MatrixXd selected(inputs.rows(), static_cast<Index>(indices.size()));
  for (Index i = 0; i < selected.cols(); ++i) {
    selected.col(i) = inputs.col(indices[i]);
  }
  return selected;
}

}  // namespace

std::vector<Index> spreadIndices(Index size, Index count) {
  std::vector<Index> indices(std::min(size, count));
  for (Index i = 0; i < static_cast<Index>(indices.size()); ++i) {
    indices[i] = i * size / static_cast<Index>(indices.size());
  }
  return indices;
}

MatrixXd chooseInducingPoints(const Eigen::Ref<const MatrixXd>& inputs, const ModelStructure& structure,
                              const Hyperparameters& hyperparameters, Index count, double tolerance) {
  const MatrixXd candidates = select(inputs, spreadIndices(inputs.cols(), kCandidatesPerPoint * count));
  const VectorXd scales = lengthScaleOfFeatures(structure, hyperparameters, inputs.rows());
  const MatrixXd scaled = scales.cwiseInverse().asDiagonal() * (candidates.colwise() - calcCenter(inputs));
  VectorXd variance = calcPriorVariance(structure, hyperparameters, scaled);
  const double least = std::max(kDetermined, tolerance) * variance.maxCoeff();
  MatrixXd factor(candidates.cols(), std::min(count, candidates.cols()));
  std::vector<Index> pivots;
  for (Index k = 0; k < factor.cols(); ++k) {
    Index pivot = 0;
    if (variance.maxCoeff(&pivot) <= least) {
      break;
    }
    auto column = factor.col(k);
    column = calcCrossCovariance(structure, hyperparameters, scaled, scaled.col(pivot));
    for (Index j = 0; j < k; ++j) {
      column -= factor(pivot, j) * factor.col(j);
    }
    column /= std::sqrt(variance(pivot));
    variance = (variance - column.cwiseAbs2()).cwiseMax(0.0);
    variance(pivot) = 0.0;
    pivots.push_back(pivot);
  }
  return select(candidates, pivots);
}

}  // namespace twinmap::gp
