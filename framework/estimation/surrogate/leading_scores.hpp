#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/surrogate/forward_surrogate.hpp"
#include "kernels/exact/exact.hpp"

namespace twinmap {

/// 1 / standard deviation of each score's noise and mean error (r).
Eigen::ArrayXd calcRoughWeights(const ForwardSurrogate& surrogate);

/// The training simulations in the order of how similar their scores are to those given (r): by the squares
/// of the differences over 1 + error variance.
std::vector<Eigen::Index> rankSimulations(const ForwardSurrogate& surrogate,
                                          const Eigen::Ref<const Eigen::VectorXd>& scores);

/// The scores that say most, some five for each unknown: a search with them comes near enough to a minimum,
/// at a fraction of the cost.
struct LeadingScores {
  Eigen::VectorXd weights;                   ///< r, 1 / stddev of noise and mean error; 0 of scores left out
  std::vector<exact::score_window> windows;  ///< all, each with how many of its first scores take part
};
LeadingScores findLeadingScores(const ForwardSurrogate& surrogate, Eigen::Index unknown);

}  // namespace twinmap
