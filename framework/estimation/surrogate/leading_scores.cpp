#include "framework/estimation/surrogate/leading_scores.hpp"

#include <algorithm>
#include <functional>

#include "framework/estimation/levels.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::VectorXd;

ArrayXd calcRoughWeights(const ForwardSurrogate& surrogate) {
  return (1.0 + surrogate.error_variance.array()).rsqrt();
}

std::vector<Index> rankSimulations(const ForwardSurrogate& surrogate,
                                   const Eigen::Ref<const VectorXd>& scores) {
  const ArrayXd weights = calcRoughWeights(surrogate);
  const VectorXd misfit =
      ((surrogate.scores.colwise() - scores).array().colwise() * weights).matrix().colwise().squaredNorm();
  return sortIndices(misfit.size(), [&](Index a, Index b) { return misfit[a] < misfit[b]; });
}

LeadingScores findLeadingScores(const ForwardSurrogate& surrogate, Index unknown) {
  const ArrayXd weights = calcRoughWeights(surrogate);
  const ArrayXd said = surrogate.scores.rowwise().squaredNorm().array() * weights.square();
  std::vector<double> order(said.data(), said.data() + said.size());
  const Index kept = std::min<Index>(said.size(), kPerUnknown * unknown);
  std::nth_element(order.begin(), order.begin() + (kept - 1), order.end(), std::greater<>());
  const double least = order[static_cast<std::size_t>(kept - 1)];
  LeadingScores leading{VectorXd::Zero(said.size()), {}};
  Index first = 0;
  for (const gp::SharedProcess& process : surrogate.windows) {
    const Index count = process.getFunctionCount();
    Index taken = count;
    while (taken > 0 && said(first + taken - 1) < least) {
      --taken;
    }
    leading.weights.segment(first, taken) = weights.segment(first, taken).matrix();
    leading.windows.push_back({static_cast<int>(first), static_cast<int>(count), static_cast<int>(taken)});
    first += count;
  }
  return leading;
}

}  // namespace twinmap
