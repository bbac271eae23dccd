#include "framework/inference/derived_values.hpp"

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

std::vector<DerivedValue> deriveFrom(const DerivedQuantities* quantities, const Estimate& estimate) {
  if (quantities == nullptr || !estimate.isGiven()) {
    return {};
  }
  if (estimate.draws.isGiven()) {
    return listValues(*quantities,
                      quantities->propagateDraws(estimate.draws.points.topRows(quantities->countParameters()),
                                                 estimate.draws.weights),
                      kNormal95);
  }
  return listValues(*quantities, quantities->propagate(estimate), findLargestFactor(estimate).of95);
}

std::shared_ptr<const DerivedQuantities> makeDerivedQuantities(const ExperimentSpec& experiment) {
  return experiment.derived.empty() ? nullptr : std::make_shared<const DerivedQuantities>(experiment);
}

}  // namespace twinmap
