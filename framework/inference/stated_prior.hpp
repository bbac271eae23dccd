#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// What an experiment states of its unknown parameters before any measurement.
struct StatedPrior {
  std::string text;        ///< describePriors()
  Eigen::VectorXd stddev;  ///< u, within the bounds, in the parameters' units
};

/// Null where all parameters are uniform within their bounds.
std::shared_ptr<const StatedPrior> findStatedPrior(const ModelSpec& model);

}  // namespace twinmap
