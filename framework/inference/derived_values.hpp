#pragma once

#include <string>
#include <vector>

#include "framework/estimation/derived/derived_quantities.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// What is said of a derived quantity.
struct DerivedValue {
  std::string name, unit;
  double mean, stddev, lower95, upper95;
};

/// Of all quantities that an experiment derives, from the draws of an estimate where it has some; none where
/// `quantities` is null or nothing is believed.
std::vector<DerivedValue> deriveFrom(const DerivedQuantities* quantities, const Estimate& estimate);

/// Those of an experiment; null where it derives none.
std::shared_ptr<const DerivedQuantities> makeDerivedQuantities(const ExperimentSpec& experiment);

}  // namespace twinmap
