#include "framework/data/reduction/partial_least_squares.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "framework/data/reduction/principal_components.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The direction w (d) with the largest |w' cross|, not normalised: the better, the longer.
VectorXd calcDominantDirection(const MatrixXd& cross) {
  return cross * linalg::calcSymmetricEigen(cross.transpose() * cross).vectors.rightCols(1);
}

MatrixXd subtractMean(const MatrixXd& rows, const VectorXd& mean) {
  return rows.colwise() - mean;
}

/// The columns of the simulations [first, last) in every draw, or those of all others.
std::vector<Index> collectColumns(Index simulations, int replicates, Index first, Index last, bool inside) {
  std::vector<Index> columns;
  for (Index column = 0; column < simulations * replicates; ++column) {
    const Index simulation = column % simulations;
    if ((simulation >= first && simulation < last) == inside) {
      columns.push_back(column);
    }
  }
  return columns;
}

/// Mean squared error of held-out samples with 1, 2 ... `most` components. Fewer components than that are all
/// there are: more change nothing.
VectorXd calcHeldOutErrors(const MatrixXd& features, const MatrixXd& targets, const std::vector<Index>& kept,
                           const std::vector<Index>& held_out, Index most) {
  const MatrixXd x = features(Eigen::all, kept), y = targets(Eigen::all, kept);
  const VectorXd x_mean = x.rowwise().mean(), y_mean = y.rowwise().mean();
  const PartialLeastSquares model =
      calcPartialLeastSquares(subtractMean(x, x_mean), subtractMean(y, y_mean), most);
  const MatrixXd scores = model.rotations.transpose() * subtractMean(features(Eigen::all, held_out), x_mean);
  MatrixXd residual = subtractMean(targets(Eigen::all, held_out), y_mean);
  VectorXd errors(most);
  for (Index k = 0; k < most; ++k) {
    if (k < scores.rows()) {
      residual -= model.loadings.col(k) * scores.row(k);
    }
    errors[k] = residual.squaredNorm() / static_cast<double>(held_out.size());
  }
  return errors;
}

Index chooseRankByFolds(const LabelledFeatures& samples) {
  constexpr Index kFolds = 10, kMax = 30;
  const Index simulations = samples.features.cols() / samples.replicates;
  const Index folds = std::min(kFolds, simulations);
  const Index largest_fold = (simulations + folds - 1) / folds;
  const Index most = std::min({kMax, samples.features.rows(), simulations - largest_fold - 1});
  if (most <= 1) {
    return 1;
  }
  const MatrixXd errors = calcCrossValidationErrors(samples, most, folds);
  const Eigen::RowVectorXd mean = errors.colwise().mean();
  Index best = 0;
  const double smallest = mean.minCoeff(&best);
  const double variance = (errors.col(best).array() - smallest).square().sum() / (folds - 1.0);
  const double limit = smallest + std::sqrt(variance / static_cast<double>(folds));
  Index rank = 0;
  while (mean[rank] > limit) {
    ++rank;
  }
  return rank + 1;
}

}  // namespace

PartialLeastSquares calcPartialLeastSquares(const MatrixXd& features, const MatrixXd& targets,
                                            Index components) {
  MatrixXd residual = features;
  MatrixXd weights(features.rows(), components), feature_loadings(features.rows(), components);
  PartialLeastSquares model{{}, MatrixXd(targets.rows(), components)};
  double first_length = 0.0;
  Index k = 0;
  for (; k < components; ++k) {
    constexpr double kRounding = 1e-12;
    const VectorXd direction = calcDominantDirection(residual * targets.transpose());
    first_length = k == 0 ? direction.norm() : first_length;
    if (!(direction.norm() > kRounding * first_length)) {
      break;
    }
    weights.col(k) = direction.normalized();
    const VectorXd scores = residual.transpose() * weights.col(k);
    feature_loadings.col(k) = residual * scores / scores.squaredNorm();
    model.loadings.col(k) = targets * scores / scores.squaredNorm();
    residual -= feature_loadings.col(k) * scores.transpose();
  }
  const MatrixXd products = feature_loadings.leftCols(k).transpose() * weights.leftCols(k);
  model.rotations = products.triangularView<Eigen::UnitUpper>().solve<Eigen::OnTheRight>(weights.leftCols(k));
  model.loadings.conservativeResize(Eigen::NoChange, k);
  return model;
}

MatrixXd calcCrossValidationErrors(const LabelledFeatures& samples, Index most, Index folds) {
  const MatrixXd targets = fitZScore(samples.parameters).apply(samples.parameters);
  const Index simulations = samples.features.cols() / samples.replicates;
  MatrixXd errors(folds, most);
  for (Index fold = 0; fold < folds; ++fold) {
    const Index first = fold * simulations / folds, last = (fold + 1) * simulations / folds;
    errors.row(fold) = calcHeldOutErrors(
        samples.features, targets, collectColumns(simulations, samples.replicates, first, last, false),
        collectColumns(simulations, samples.replicates, first, last, true), most);
  }
  return errors;
}

AffineStep fitPartialLeastSquares(const PartialLeastSquaresSpec& spec, const LabelledFeatures& samples) {
  const Index rank = spec.components.number ? *spec.components.number : chooseRankByFolds(samples);
  const VectorXd mean = samples.features.rowwise().mean();
  const MatrixXd targets = fitZScore(samples.parameters).apply(samples.parameters);
  const Index most = std::min(samples.features.rows(), samples.features.cols() - 1);
  PartialLeastSquares model =
      calcPartialLeastSquares(subtractMean(samples.features, mean), targets, std::min(rank, most));
  if (model.rotations.cols() == 0) {
    throw std::invalid_argument("partial_least_squares: the features have no covariance with the parameters");
  }
  if (spec.components.number && model.rotations.cols() < rank) {
    throw std::invalid_argument(
        fmt::format("partial_least_squares: asked for {} of {} components", rank, model.rotations.cols()));
  }
  fixSigns(model.rotations);
  return makeProjection(mean, model.rotations.transpose());
}

}  // namespace twinmap
