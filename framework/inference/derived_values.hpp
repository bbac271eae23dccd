#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/estimation/derived/derived_quantities.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/inference/posterior_estimate.hpp"

namespace twinmap {

/// What is said of a number that is not one of the parameters that are reported.
struct DerivedValue {
  std::string name, unit;
  double mean = 0.0, stddev = 0.0, lower95 = 0.0, upper95 = 0.0;  ///< NaN where it is not determined

  bool isStated() const;
};

/// From its values at draws. floor: of what these are, where they say something of what is determined alone;
/// else null.
DerivedValue describeDrawn(const std::string& name, const std::string& unit, const Eigen::VectorXd& values,
                           const Eigen::VectorXd& weights, const FloorDraws* floor);

/// Of all quantities that an experiment derives, from the draws of an estimate where it has some; none where
/// `quantities` is null or nothing is believed. floor: as above, of the estimate's draws.
std::vector<DerivedValue> deriveFrom(const DerivedQuantities* quantities, const Estimate& estimate,
                                     const FloorDraws* floor = nullptr);

/// Those of an experiment; null where it derives none.
std::shared_ptr<const DerivedQuantities> makeDerivedQuantities(const ExperimentSpec& experiment);

/// Of all nuisance parameters, from the draws of the simulator's posterior where that is reliable and has
/// them; else empty.
std::vector<DerivedValue> listNuisance(const std::optional<PosteriorEstimate>& posterior);

}  // namespace twinmap
