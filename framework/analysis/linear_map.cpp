#include "framework/analysis/linear_map.hpp"

#include <algorithm>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Estimates LinearMap::predict(const MatrixXd& features, const MatrixXd& inputs) const {
  return {(slopes * stackRows(transform.apply(features), inputs)).colwise() + offset,
          stddev.replicate(1, features.cols())};
}

LinearMap trainLinearMap(const FeatureTransform& transform, const LabelledFeatures& samples) {
  const MatrixXd inputs = stackRows(transform.apply(samples.features), samples.inputs);
  const VectorXd input_mean = inputs.rowwise().mean(), mean = samples.parameters.rowwise().mean();
  const MatrixXd centered = (inputs.colwise() - input_mean).transpose();       // n x k
  const MatrixXd targets = (samples.parameters.colwise() - mean).transpose();  // n x p
  const linalg::LinearFit fit = linalg::fitLinear(centered, targets);
  LinearMap map;
  map.transform = transform;
  map.slopes = fit.coefficients.transpose();
  map.offset = mean - map.slopes * input_mean;
  const MatrixXd residuals = targets - centered * map.slopes.transpose();
  const auto degrees = static_cast<double>(inputs.cols() - fit.rank - 1);
  map.stddev = (residuals.colwise().squaredNorm() / std::max(degrees, 1.0)).cwiseSqrt().transpose();
  return map;
}

}  // namespace twinmap
