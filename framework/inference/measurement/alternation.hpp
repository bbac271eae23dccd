#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// What every other sample of outputs is off by, as marks of a wheel are that are not evenly spaced.
struct Alternation {
  Eigen::VectorXd shift;  ///< rows of the layout: what takes it off, half of it of each sample; 0 elsewhere
  std::vector<std::string> said;  ///< a phrase for each output
};

/// Of outputs of at least 20 samples, each second one of which is off the cubic through the four nearest of
/// the others by the same, in mean more than three standard deviations of one. A response that two samples in
/// a row follow is not. O(samples).
Alternation findAlternation(const Eigen::VectorXd& measured, const ResponseLayout& layout);

}  // namespace twinmap
