#include "framework/estimation/posterior/bound_test.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/complement.hpp>
#include <cmath>

#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;

std::vector<Index> findBeyondBounds(const LocalSurface& minimum) {
  constexpr double kLevel = 0.01;     // that of the test for a mismatch
  constexpr double kAtBound = 0.999;  // searches end near the minimum
  // a ridge that is not seen at all leads nowhere
  constexpr double kOfBox = 0.01 * kHalfWidthInformation;
  const Index u = minimum.at.size();
  const Eigen::VectorXd step = linalg::solvePositiveDefinite(
      minimum.information + kOfBox * Eigen::MatrixXd::Identity(u, u), minimum.descent);
  int held = 0;
  std::vector<Index> beyond;
  for (Index j = 0; j < minimum.at.size(); ++j) {
    held += std::abs(minimum.at[j]) > kAtBound && minimum.at[j] * minimum.descent[j] > 0.0 ? 1 : 0;
    if (std::abs(minimum.at[j] + step[j]) > 1.0) {
      beyond.push_back(j);
    }
  }
  const double gain = minimum.descent.dot(step);
  const bool is_noise =
      held == 0 || boost::math::cdf(boost::math::complement(boost::math::chi_squared(held), gain)) > kLevel;
  return is_noise ? std::vector<Index>() : beyond;
}

}  // namespace twinmap
