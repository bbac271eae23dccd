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

std::vector<DerivedValue> deriveFromDraws(const DerivedQuantities* quantities, bool reliable,
                                          const Eigen::MatrixXd& draws, const Eigen::VectorXd& weights) {
  if (quantities == nullptr || !reliable) {
    return {};
  }
  return listValues(*quantities,
                    quantities->propagateDraws(draws.topRows(quantities->countParameters()), weights),
                    kNormal95);
}

}  // namespace

std::vector<DerivedValue> deriveFrom(const DerivedQuantities* quantities, const Estimate& estimate) {
  return quantities == nullptr
             ? std::vector<DerivedValue>{}
             : listValues(*quantities, quantities->propagate(estimate), findLargestFactor(estimate).of95);
}

std::vector<DerivedValue> deriveFrom(const DerivedQuantities* quantities,
                                     const SurrogatePosterior& posterior) {
  return deriveFromDraws(quantities, posterior.isReliable(), posterior.draws,
                         Eigen::VectorXd::Ones(posterior.draws.cols()));
}

std::vector<DerivedValue> deriveFrom(const DerivedQuantities* quantities,
                                     const SimulatorPosterior& posterior) {
  return deriveFromDraws(quantities, posterior.isReliable(), posterior.draws, posterior.weights);
}

std::shared_ptr<const DerivedQuantities> makeDerivedQuantities(const ExperimentSpec& experiment) {
  return experiment.derived.empty() ? nullptr : std::make_shared<const DerivedQuantities>(experiment);
}

}  // namespace twinmap
