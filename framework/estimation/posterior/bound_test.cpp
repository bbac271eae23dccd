#include "framework/estimation/posterior/bound_test.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/complement.hpp>
#include <cmath>

#include "framework/estimation/levels.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;

namespace {

/// Coordinates at a bound that lead further out.
std::vector<Index> findHeld(const LocalSurface& minimum) {
  std::vector<Index> held;
  for (Index j = 0; j < minimum.at.size(); ++j) {
    if (std::abs(minimum.at[j]) > kAtBound && minimum.at[j] * minimum.descent[j] > 0.0) {
      held.push_back(j);
    }
  }
  return held;
}

bool isNoise(double gain, std::size_t freedoms) {
  const boost::math::chi_squared distribution(static_cast<double>(freedoms));
  return boost::math::cdf(boost::math::complement(distribution, gain)) > kMismatchLevel;
}

/// Those of the held coordinates that alone gain more than the noisiest of them would: seen so little within
/// narrow bounds that the box, which keeps ridges, would hide it.
std::vector<Index> findPushed(const LocalSurface& minimum, const std::vector<Index>& held) {
  std::vector<Index> pushed;
  for (const Index j : held) {
    const double information = minimum.information(j, j), descent = minimum.descent[j];
    const double p = information > 0.0 ? std::erfc(std::abs(descent) / std::sqrt(2.0 * information)) : 1.0;
    if (p * static_cast<double>(held.size()) < kMismatchLevel) {
      pushed.push_back(j);
    }
  }
  return pushed;
}

}  // namespace

std::vector<Index> findBeyondBounds(const LocalSurface& minimum) {
  // a ridge that is not seen at all leads nowhere
  constexpr double kOfBox = 0.01 * kHalfWidthInformation;
  const Index u = minimum.at.size();
  const Eigen::VectorXd step = linalg::solvePositiveDefinite(
      minimum.information + kOfBox * Eigen::MatrixXd::Identity(u, u), minimum.descent);
  const std::vector<Index> held = findHeld(minimum), pushed = findPushed(minimum, held);
  const bool is_noise = held.empty() || isNoise(minimum.descent.dot(step), held.size());
  std::vector<Index> beyond;
  for (Index j = 0; j < u; ++j) {
    if ((!is_noise && std::abs(minimum.at[j] + step[j]) > 1.0) ||
        std::find(pushed.begin(), pushed.end(), j) != pushed.end()) {
      beyond.push_back(j);
    }
  }
  return beyond;
}

}  // namespace twinmap
