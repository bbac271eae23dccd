#include "framework/estimation/box_prior.hpp"

#include <algorithm>

#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd BoxPrior::calcInformation() const {
  return kHalfWidthInformation * relative;
}

BoxPrior makeUniformPrior(Index unknown) {
  return {VectorXd::Zero(unknown), MatrixXd::Identity(unknown, unknown), MatrixXd::Zero(unknown, unknown),
          VectorXd::Zero(unknown), VectorXd::Constant(unknown, 2.0 * kUniformStddev)};
}

BoxPrior makeBoxPrior(const ModelSpec& model) {
  const std::vector<ParameterSpec> unknown = collectUnknown(model);
  BoxPrior made = makeUniformPrior(static_cast<Index>(unknown.size()));
  const std::shared_ptr<const Prior> prior = findPrior(model);
  if (!prior) {
    return made;
  }
  const NormalForm normal = prior->calcNormalForm();
  const std::vector<Index>& stated = normal.parameters;
  const VectorXd half_width = 0.5 * calcWidths(unknown), center = calcBoxCenter(unknown);
  const VectorXd scale = normal.stddev.cwiseQuotient(half_width(stated));
  const MatrixXd information =
      linalg::invertPositiveDefinite(scale.asDiagonal() * normal.correlation * scale.asDiagonal());
  made.mean(stated) = (normal.mean - center(stated)).cwiseQuotient(half_width(stated));
  made.relative(stated, stated) = information / kHalfWidthInformation;
  made.within(stated, stated) = information;
  made.shift = made.within * made.mean;
  made.stddev = prior->calcStddevs().cwiseQuotient(half_width);
  for (const Index j : stated) {
    if (!prior->hasRange(j)) {  // the bounds are part of the distribution, and of its information
      made.within(j, j) = std::max(0.0, made.within(j, j) - kHalfWidthInformation);
    }
  }
  return made;
}

std::shared_ptr<const Prior> findPrior(const ModelSpec& model) {
  auto prior = std::make_shared<const Prior>(collectUnknown(model), model.priors);
  return prior->isUniform() ? nullptr : prior;
}

PriorMoments calcPriorMoments(const ModelSpec& model) {
  if (const std::shared_ptr<const Prior> prior = findPrior(model)) {
    return {prior->calcMeans(), prior->calcStddevs()};
  }
  const std::vector<ParameterSpec> unknown = collectUnknown(model);
  return {calcBoxCenter(unknown), kUniformStddev * calcWidths(unknown)};
}

VectorXd calcPriorCenter(const ModelSpec& model) {
  VectorXd center = calcBoxCenter(collectSampled(model));
  if (const std::shared_ptr<const Prior> prior = findPrior(model)) {
    const auto u = static_cast<Index>(collectUnknown(model).size());
    center.head(u) = prior->calcPoint(VectorXd::Constant(u, 0.5));
  }
  return center;
}

}  // namespace twinmap
