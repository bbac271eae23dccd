#include "framework/inference/derived_values.hpp"

#include <cmath>

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

/// Row i of the draws of all unknown parameters.
DerivedValue summarizeDraws(const ParameterSpec& spec, const BoundedDraws& draws, Index i) {
  constexpr double k95 = 0.95;
  const auto values = draws.points.row(i).array();
  const double mean = (values * draws.weights.transpose().array()).sum();
  const double variance = ((values - mean).square() * draws.weights.transpose().array()).sum();
  const auto [lower, upper] = draws.findInterval(i, k95);
  return {spec.name.text, spec.unit, mean, std::sqrt(variance), lower, upper};
}

}  // namespace

std::vector<DerivedValue> listNuisance(const InferredMeasurement& inferred, const Estimate& estimate) {
  const std::vector<ParameterSpec>& specs = inferred.nuisance;
  const Index first = estimate.mean.size();
  const Index all = first + static_cast<Index>(specs.size());
  std::vector<DerivedValue> values;
  if (estimate.draws.isGiven() && estimate.draws.points.rows() == all) {
    for (Index i = first; i < all; ++i) {
      values.push_back(summarizeDraws(specs[static_cast<std::size_t>(i - first)], estimate.draws, i));
    }
  } else if (estimate.isRefined() && inferred.refined->mean.size() == all) {
    const Refined& refined = *inferred.refined;
    for (Index i = first; i < all; ++i) {
      const ParameterSpec& spec = specs[static_cast<std::size_t>(i - first)];
      const double mean = refined.mean[i], stddev = refined.stddev[i];
      values.push_back(
          {spec.name.text, spec.unit, mean, stddev, mean - kNormal95 * stddev, mean + kNormal95 * stddev});
    }
  }
  return values;
}

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
