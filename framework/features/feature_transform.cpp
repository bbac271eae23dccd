#include "framework/features/feature_transform.hpp"

#include <cmath>
#include <stdexcept>

#include "framework/features/principal_components.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

AffineStep fitZScore(const MatrixXd& features) {
  const VectorXd mean = features.rowwise().mean();
  const MatrixXd centered = features.colwise() - mean;
  const VectorXd stddev =
      (centered.rowwise().squaredNorm() / (static_cast<double>(features.cols()) - 1.0)).cwiseSqrt();
  constexpr double kRounding = 1e-14;  // a feature that varies by less relative to its mean is constant
  const Eigen::ArrayXd smallest = kRounding * mean.array().abs();
  return {mean, (stddev.array() > smallest).select(stddev, 1.0), {}};
}

AffineStep fitWhiten(const VectorXd& noise_stddev) {
  if (!(noise_stddev.minCoeff() > 0.0)) {
    throw std::invalid_argument("whiten: the noise of a feature is 0");
  }
  return {VectorXd::Zero(noise_stddev.size()), noise_stddev, {}};
}

Eigen::Index chooseRank(const PrincipalComponentsSpec& spec, const PrincipalComponents& components,
                        Eigen::Index samples) {
  const Eigen::Index most = components.variances.size();
  if (spec.components) {
    if (*spec.components > most) {
      throw std::invalid_argument("principal_components: asked for " + std::to_string(*spec.components) +
                                  " of " + std::to_string(most));
    }
    return *spec.components;
  }
  const double edge = calcMarchenkoPasturEdge(components.directions.rows(), samples);
  const double total = components.variances.sum();
  double explained = 0.0;
  Eigen::Index rank = 0;
  while (rank < most && (spec.explained_variance ? explained < *spec.explained_variance * total
                                                 : components.variances[rank] > edge)) {
    explained += components.variances[rank];
    ++rank;
  }
  return std::max<Eigen::Index>(rank, 1);
}

AffineStep fitPrincipalComponents(const PrincipalComponentsSpec& spec, const MatrixXd& features) {
  const VectorXd mean = features.rowwise().mean();
  const PrincipalComponents components = calcPrincipalComponents(features.colwise() - mean);
  const Eigen::Index rank = chooseRank(spec, components, features.cols());
  return {mean, VectorXd::Ones(mean.size()), components.directions.leftCols(rank).transpose()};
}

AffineStep fitStep(const TransformStepSpec& step, const LabelledFeatures& samples) {
  if (step.z_score) {
    return fitZScore(samples.features);
  }
  if (step.whiten) {
    return fitWhiten(samples.noise_covariance.diagonal().cwiseSqrt());
  }
  return fitPrincipalComponents(*step.principal_components, samples.features);
}

void applyStep(const AffineStep& step, LabelledFeatures& samples) {
  samples.features = step.apply(samples.features);
  samples.noise_covariance = step.applyToCovariance(samples.noise_covariance);
  for (MatrixXd& sensitivity : samples.sensitivities) {
    sensitivity = step.applyLinear(sensitivity);
  }
}

}  // namespace

MatrixXd AffineStep::apply(const MatrixXd& features) const {
  return applyLinear(features.colwise() - offset);
}

MatrixXd AffineStep::applyLinear(const MatrixXd& differences) const {
  const MatrixXd scaled = differences.array().colwise() / scale.array();
  if (projection.size() == 0) {
    return scaled;
  }
  return projection * scaled;
}

MatrixXd AffineStep::applyToCovariance(const MatrixXd& covariance) const {
  return applyLinear(applyLinear(covariance).transpose());
}

MatrixXd FeatureTransform::apply(const MatrixXd& features) const {
  MatrixXd inputs = features;
  for (const AffineStep& step : steps) {
    inputs = step.apply(inputs);
  }
  return inputs;
}

FeatureTransform fitTransform(const std::vector<TransformStepSpec>& steps, const LabelledFeatures& samples) {
  FeatureTransform transform;
  LabelledFeatures inputs = samples;
  for (const TransformStepSpec& step : steps) {
    transform.steps.push_back(fitStep(step, inputs));
    applyStep(transform.steps.back(), inputs);
  }
  return transform;
}

}  // namespace twinmap
