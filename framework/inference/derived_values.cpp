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

std::vector<NuisanceEstimate> listNuisance(const std::optional<PosteriorEstimate>& posterior) {
  if (!posterior || !posterior->fit || !posterior->isReliable()) {
    return {};
  }
  const BoundedDraws& draws = posterior->estimate.draws;
  const Index p = posterior->estimate.mean.size();
  if (draws.points.rows() < p + static_cast<Index>(posterior->nuisance.size())) {
    return {};  // of many unknown parameters the shared ones alone are drawn
  }
  std::vector<NuisanceEstimate> estimates;
  for (std::size_t n = 0; n < posterior->nuisance.size(); ++n) {
    const Index i = p + static_cast<Index>(n);
    const double mean = draws.points.row(i).dot(draws.weights);
    const double variance = (draws.points.row(i).array() - mean).square().matrix().dot(draws.weights);
    const Eigen::VectorXd ends = draws.calcQuantiles(i, Eigen::Vector2d(0.025, 0.975));
    estimates.push_back({posterior->nuisance[n].name.text, posterior->nuisance[n].unit, mean,
                         std::sqrt(variance), ends[0], ends[1]});
  }
  return estimates;
}

}  // namespace twinmap
