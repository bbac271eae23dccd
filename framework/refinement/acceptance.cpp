#include "framework/refinement/acceptance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kChiSquareLevel = 0.999;
constexpr double kReach = 2.0, kLeastReach = 0.5;        // standard deviations
constexpr double kLeastRise = 0.25, kLargestRise = 3.0;  // of what the linear model says

/// How far one can go from `at` along `way` within the limits, in lengths of `way`, at most `most`.
double calcReach(const SearchBox& box, const VectorXd& at, const VectorXd& way, double most) {
  double reach = most;
  for (Index j = 0; j < at.size(); ++j) {
    const double room = way[j] > 0.0 ? box.getUpper()[j] - at[j] : at[j] - box.getLower()[j];
    if (way[j] != 0.0) {
      reach = std::min(reach, room / std::abs(way[j]));
    }
  }
  return std::max(reach, 0.0);
}

/// Points beside a minimum and the minimum itself, last; and how far each is along its eigenvector, in
/// standard deviations.
struct Probes {
  MatrixXd points;
  VectorXd reach;
};

Probes makeProbes(const SearchBox& box, const LocalMisfit& minimum) {
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(minimum.calcCovariance());
  const Index count = minimum.at.size();
  Probes probes{MatrixXd(count, 2 * count + 1), VectorXd(2 * count)};
  probes.points.col(2 * count) = minimum.at;
  for (Index i = 0; i < 2 * count; ++i) {
    const double side = i < count ? 1.0 : -1.0;
    const VectorXd way =
        side * std::sqrt(std::max(eigen.values[i % count], 0.0)) * eigen.vectors.col(i % count);
    probes.reach[i] = calcReach(box, minimum.at, way, kReach);
    probes.points.col(i) = box.clamp(minimum.at + probes.reach[i] * way);
  }
  return probes;
}

}  // namespace

double calcChiSquareLimit(double degrees) {
  return boost::math::quantile(boost::math::chi_squared(degrees), kChiSquareLevel);
}

double calcChiSquareLimit(const LocalMisfit& minimum) {
  return calcChiSquareLimit(minimum.calcDegrees());
}

Acceptance testMinimum(Misfit& misfit, const LocalMisfit& minimum) {
  const double limit = calcChiSquareLimit(minimum);
  if (!(minimum.chi_square < limit)) {
    return {RefinementStatus::kMisfit,
            fmt::format("chi-square is {:.4g}; at most {:.4g} can be noise", minimum.chi_square, limit)};
  }
  const Probes probes = makeProbes(misfit.getBox(), minimum);
  const VectorXd misfits = misfit.evaluate(probes.points);
  const double bottom = misfits[probes.reach.size()];  // simulated as the others: integration errors differ
  for (Index i = 0; i < probes.reach.size(); ++i) {
    const double reach = probes.reach[i];
    const double slope = -2.0 * minimum.descent.dot(probes.points.col(i) - minimum.at);
    const double rise = misfits[i] - bottom - slope, expected = reach * reach;
    if (reach > kLeastReach && !(rise > kLeastRise * expected && rise < kLargestRise * expected)) {
      return {RefinementStatus::kNonlinear,
              fmt::format(
                  "{:.2g} standard deviations beside the answer chi-square rises by {:.3g} instead of {:.3g}",
                  reach, rise, expected)};
    }
  }
  return {};
}

}  // namespace twinmap
