#pragma once

#include <string>
#include <vector>

#include "framework/estimation/posterior/simulator_posterior.hpp"
#include "framework/inference/inferrer.hpp"

namespace twinmap {

/// What is said of a derived quantity.
struct DerivedValue {
  std::string name, unit;
  double mean, stddev, lower95, upper95;
};

/// Of all quantities that an experiment derives; none where `quantities` is null.
std::vector<DerivedValue> deriveFrom(const DerivedQuantities* quantities, const Estimate& estimate);
/// Where the posterior is reliable; else none.
std::vector<DerivedValue> deriveFrom(const DerivedQuantities* quantities,
                                     const SurrogatePosterior& posterior);
std::vector<DerivedValue> deriveFrom(const DerivedQuantities* quantities,
                                     const SimulatorPosterior& posterior);

/// Those of an experiment; null where it derives none.
std::shared_ptr<const DerivedQuantities> makeDerivedQuantities(const ExperimentSpec& experiment);

}  // namespace twinmap
