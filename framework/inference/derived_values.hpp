#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/estimation/derived/derived_quantities.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/inference/posterior_estimate.hpp"

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

/// What is known of a nuisance parameter.
struct NuisanceEstimate {
  std::string name, unit;
  double mean = 0.0, stddev = 0.0, lower95 = 0.0, upper95 = 0.0;
};

/// Of all nuisance parameters, from the draws of the simulator's posterior where that is reliable and has
/// them; else empty.
std::vector<NuisanceEstimate> listNuisance(const std::optional<PosteriorEstimate>& posterior);

}  // namespace twinmap
