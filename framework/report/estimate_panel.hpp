#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/experiment/model/parameter_spec.hpp"
#include "framework/report/figure.hpp"

namespace twinmap {

/// A parameter's estimate as the figure shows it, in the parameter's unit.
struct ShownEstimate {
  double mean = 0.0, stddev = 0.0;
  double lower95 = 0.0, upper95 = 0.0;
  std::optional<double> truth = {};  ///< of a test sample
};

/// Bounds, estimates and intervals of all parameters on one axis, from 0 at the lower bound to 1 at the
/// upper; adds its data to the page as the table `name`. One estimate a parameter. What lies beyond the
/// bounds is drawn at them.
Figure makeEstimateFigure(const std::string& name, const std::string& title,
                          const std::vector<ParameterSpec>& parameters,
                          const std::vector<ShownEstimate>& estimates, Page& page);

}  // namespace twinmap
