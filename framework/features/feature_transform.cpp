#include "framework/features/feature_transform.hpp"

#include <cmath>

namespace twinmap {
namespace {

FeatureTransform fitZScore(const Eigen::MatrixXd& features) {
  FeatureTransform transform;
  transform.offset = features.rowwise().mean();
  const Eigen::MatrixXd centered = features.colwise() - transform.offset;
  transform.scale = (centered.rowwise().squaredNorm() / (features.cols() - 1.0)).cwiseSqrt();
  constexpr double kRounding = 1e-14;  // a feature that varies by less relative to its mean is constant
  const Eigen::ArrayXd smallest = kRounding * transform.offset.array().abs();
  transform.scale = (transform.scale.array() > smallest).select(transform.scale, 1.0);
  return transform;
}

/// `first`, then `second`.
FeatureTransform compose(const FeatureTransform& first, const FeatureTransform& second) {
  return {first.offset + first.scale.cwiseProduct(second.offset), first.scale.cwiseProduct(second.scale)};
}

}  // namespace

Eigen::MatrixXd FeatureTransform::apply(const Eigen::MatrixXd& features) const {
  return (features.colwise() - offset).array().colwise() / scale.array();
}

FeatureTransform fitTransform(const std::vector<TransformStep>& steps, const Eigen::MatrixXd& features) {
  FeatureTransform transform{Eigen::VectorXd::Zero(features.rows()), Eigen::VectorXd::Ones(features.rows())};
  for (const TransformStep step : steps) {
    switch (step) {
      case TransformStep::kZScore:
        transform = compose(transform, fitZScore(transform.apply(features)));
        break;
    }
  }
  return transform;
}

}  // namespace twinmap
