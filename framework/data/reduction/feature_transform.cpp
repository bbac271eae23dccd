#include "framework/data/reduction/feature_transform.hpp"

#include <algorithm>

#include "framework/data/reduction/partial_least_squares.hpp"
#include "framework/data/reduction/principal_components.hpp"
#include "framework/data/reduction/selections.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

AffineStep fit(const ZScoreSpec&, const LabelledFeatures& samples) {
  return fitZScore(samples.features);
}
AffineStep fit(const WhitenSpec& whiten, const LabelledFeatures& samples) {
  return fitWhiten(whiten, samples.noise_covariance);
}
AffineStep fit(const PrincipalComponentsSpec& components, const LabelledFeatures& samples) {
  return fitPrincipalComponents(components, samples.features);
}
AffineStep fit(const PartialLeastSquaresSpec& components, const LabelledFeatures& samples) {
  return fitPartialLeastSquares(components, samples);
}
AffineStep fit(const SelectSpec& select, const LabelledFeatures& samples) {
  return fitSelect(select, samples);
}

AffineStep fitStep(const TransformStepSpec& step, const LabelledFeatures& samples) {
  return std::visit([&samples](const auto& kind) { return fit(kind, samples); }, step.kind);
}

/// The features that a selection keeps.
std::vector<FeatureInfo> selectInfos(const MatrixXd& selection, const std::vector<FeatureInfo>& infos) {
  std::vector<FeatureInfo> selected(selection.rows());
  for (Eigen::Index row = 0; row < selection.rows(); ++row) {
    Eigen::Index feature = 0;
    selection.row(row).maxCoeff(&feature);
    selected[row] = infos[feature];
  }
  return selected;
}

void applyStep(const AffineStep& step, LabelledFeatures& samples) {
  samples.features = step.apply(samples.features);
  samples.noise_covariance = step.applyToCovariance(samples.noise_covariance);
  for (MatrixXd& sensitivity : samples.sensitivities) {
    sensitivity = step.applyLinear(sensitivity);
  }
}

}  // namespace

MatrixXd FeatureTransform::apply(const MatrixXd& features) const {
  constexpr Index kChunk = 64;  // columns: what steps pass on stays in a cache
  const Index count = features.cols();
  MatrixXd inputs(steps.empty() ? features.rows() : steps.back().countInputs(), count);
  for (Index first = 0; first < count; first += kChunk) {
    const Index size = std::min(kChunk, count - first);
    MatrixXd chunk = features.middleCols(first, size);
    for (const AffineStep& step : steps) {
      chunk = step.apply(chunk);
    }
    inputs.middleCols(first, size) = chunk;
  }
  return inputs;
}

bool FeatureTransform::isDiagonal() const {
  return std::all_of(steps.begin(), steps.end(),
                     [](const AffineStep& step) { return step.projection.size() == 0; });
}

Eigen::VectorXd FeatureTransform::calcScale() const {
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(steps.back().countInputs());
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    scale = scale.cwiseQuotient(step->scale);
  }
  return scale;
}

MatrixXd FeatureTransform::calcMatrix() const {
  if (isDiagonal()) {
    return calcScale().asDiagonal();
  }
  MatrixXd matrix;  // of the steps behind; none yet
  Eigen::VectorXd scale =
      Eigen::VectorXd::Ones(steps.back().countInputs());  // from its left, while there is none
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    if (step->projection.size() > 0) {
      matrix =
          matrix.size() == 0 ? MatrixXd(scale.asDiagonal() * step->projection) : matrix * step->projection;
    }
    if (matrix.size() == 0) {
      scale = scale.cwiseQuotient(step->scale);
    } else {
      matrix = matrix * step->scale.cwiseInverse().asDiagonal();
    }
  }
  return matrix;
}

NoiseCovariance FeatureTransform::applyToCovariance(const NoiseCovariance& covariance) const {
  NoiseCovariance of_inputs = covariance;
  for (const AffineStep& step : steps) {
    of_inputs = step.applyToCovariance(of_inputs);
  }
  return of_inputs;
}

FeatureTransform fitTransform(const std::vector<TransformStepSpec>& steps, const LabelledFeatures& samples) {
  FeatureTransform transform;
  LabelledFeatures inputs = samples;
  for (const TransformStepSpec& step : steps) {
    transform.steps.push_back(fitStep(step, inputs));
    if (std::holds_alternative<SelectSpec>(step.kind) && !inputs.infos.empty()) {
      inputs.infos = selectInfos(transform.steps.back().projection, inputs.infos);
    }
    applyStep(transform.steps.back(), inputs);
  }
  return transform;
}

}  // namespace twinmap
