#include "framework/inference/stated_values.hpp"

#include <cmath>

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

std::vector<DerivedValue> identify(const std::vector<Ridge>& ridges,
                                   const std::vector<ParameterSpec>& parameters, const Estimate& estimate,
                                   const FloorDraws* floor) {
  std::vector<DerivedValue> values;
  if (!estimate.draws.isGiven()) {
    return values;
  }
  const MatrixXd points = estimate.draws.points.topRows(static_cast<Index>(parameters.size()));
  for (const Ridge& ridge : ridges) {
    for (const Combination& combination : ridge.combinations) {
      const VectorXd drawn = VectorXd::NullaryExpr(
          points.cols(), [&](Index i) { return calcValue(combination, points.col(i)); });
      values.push_back(describeDrawn(makeExpression(combination, parameters),
                                     findUnit(combination, parameters), drawn, estimate.draws.weights,
                                     floor));
    }
    MatrixXd base(static_cast<Index>(ridge.base.sums.size()), points.cols());
    for (Index i = 0; base.rows() > 0 && i < points.cols(); ++i) {
      base.col(i) = ridge.base.calc(points.col(i));
    }
    for (Index k = 0; k < base.rows(); ++k) {
      values.push_back(describeDrawn("base_" + std::to_string(1 + k),
                                     ridge.base.getUnit(static_cast<std::size_t>(k)), base.row(k),
                                     estimate.draws.weights, floor));
    }
  }
  return values;
}

}  // namespace

bool isStated(const Estimate& estimate, Index parameter) {
  return estimate.isGiven() && !std::isnan(estimate.mean[parameter]);
}

StatedValues stateValues(const InferredMeasurement& inferred, const Estimate& believed,
                         const std::vector<ParameterSpec>& parameters) {
  StatedValues stated;
  const bool is_believed = believed.isGiven() || !inferred.posterior;
  stated.estimate = is_believed ? believed : inferred.posterior->determined;
  const FloorDraws* floor = is_believed ? nullptr : &inferred.posterior->floor;
  stated.derived = deriveFrom(inferred.quantities.get(), stated.estimate, floor);
  stated.identified = identify(inferred.ridges, parameters, stated.estimate, floor);
  stated.nuisance = listNuisance(inferred.posterior);
  return stated;
}

}  // namespace twinmap
