#include "framework/inference/derived_values.hpp"

#include <cmath>
#include <limits>

namespace twinmap {

using Eigen::Index;

namespace {

std::vector<DerivedValue> listValues(const DerivedQuantities& quantities,
                                     const std::vector<ValueDistribution>& distributions, double factor) {
  const DerivedEstimate estimate = summarize(distributions, factor);
  std::vector<DerivedValue> values;
  for (Index k = 0; k < quantities.count(); ++k) {
    const ParameterSpec& spec = quantities.getSpecs()[static_cast<std::size_t>(k)];
    values.push_back({spec.name.text, spec.unit, estimate.mean[k], estimate.stddev[k], estimate.lower95[k],
                      estimate.upper95[k]});
  }
  return values;
}

}  // namespace

bool DerivedValue::isStated() const {
  return !std::isnan(mean);
}

DerivedValue describeDrawn(const std::string& name, const std::string& unit, const Eigen::VectorXd& values,
                           const Eigen::VectorXd& weights, const FloorDraws* floor) {
  if (floor != nullptr && !floor->determine(values)) {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    return {name, unit, unknown, unknown, unknown, unknown};
  }
  const DerivedEstimate one = summarize({ValueDistribution(values, weights)});
  return {name, unit, one.mean[0], one.stddev[0], one.lower95[0], one.upper95[0]};
}

std::vector<DerivedValue> deriveFrom(const DerivedQuantities* quantities, const Estimate& estimate,
                                     const FloorDraws* floor) {
  if (quantities == nullptr || !estimate.isGiven()) {
    return {};
  }
  if (estimate.draws.isGiven()) {
    const Eigen::MatrixXd drawn =
        quantities->calcAll(estimate.draws.points.topRows(quantities->countParameters()));
    std::vector<DerivedValue> values;
    for (Index k = 0; k < quantities->count(); ++k) {
      const ParameterSpec& spec = quantities->getSpecs()[static_cast<std::size_t>(k)];
      values.push_back(describeDrawn(spec.name.text, spec.unit, drawn.row(k), estimate.draws.weights, floor));
    }
    return values;
  }
  return listValues(*quantities, quantities->propagate(estimate), findLargestFactor(estimate).of95);
}

std::shared_ptr<const DerivedQuantities> makeDerivedQuantities(const ExperimentSpec& experiment) {
  return experiment.derived.empty() ? nullptr : std::make_shared<const DerivedQuantities>(experiment);
}

std::vector<DerivedValue> listNuisance(const std::optional<PosteriorEstimate>& posterior) {
  if (!posterior || !posterior->fit || !posterior->isReliable()) {
    return {};
  }
  const BoundedDraws& draws = posterior->estimate.draws;
  const Index p = posterior->estimate.mean.size();
  if (draws.points.rows() < p + static_cast<Index>(posterior->nuisance.size())) {
    return {};  // of many unknown parameters the shared ones alone are drawn
  }
  std::vector<DerivedValue> estimates;
  for (std::size_t n = 0; n < posterior->nuisance.size(); ++n) {
    const Index i = p + static_cast<Index>(n);
    estimates.push_back(describeDrawn(posterior->nuisance[n].name.text, posterior->nuisance[n].unit,
                                      draws.points.row(i), draws.weights, nullptr));
  }
  return estimates;
}

}  // namespace twinmap
