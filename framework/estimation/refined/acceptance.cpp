#include "framework/estimation/refined/acceptance.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "framework/estimation/levels.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kMinRise = 0.25, kLargestRise = 3.0;  // of what the linear model says

/// Points beside a minimum and the minimum itself, last; and how far each is along its eigenvector, in
/// standard deviations.
struct Probes {
  MatrixXd points;
  VectorXd reach;
};

Probes makeProbes(const SearchBox& box, const LocalMisfit& minimum, bool along_ridge) {
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(minimum.calcCovariance());
  const Index count = minimum.at.size() - (along_ridge ? 1 : 0);
  Probes probes{MatrixXd(minimum.at.size(), 2 * count + 1), VectorXd(2 * count)};
  probes.points.col(2 * count) = minimum.at;
  for (Index i = 0; i < 2 * count; ++i) {
    const double side = i < count ? 1.0 : -1.0;
    const VectorXd way =
        side * std::sqrt(std::max(eigen.values[i % count], 0.0)) * eigen.vectors.col(i % count);
    probes.reach[i] = box.calcReach(minimum.at, way, kTestReach);
    probes.points.col(i) = box.clamp(minimum.at + probes.reach[i] * way);
  }
  return probes;
}

bool isExplained(const LocalMisfit& minimum) {
  return minimum.chi_square < calcChiSquareLimit(minimum);
}

Acceptance refuseMisfit(const LocalMisfit& minimum) {
  return {RefinementStatus::kMisfit, fmt::format("chi-square {:.4g} exceeds the 99.9 % limit of {:.4g}",
                                                 minimum.chi_square, calcChiSquareLimit(minimum))};
}

/// ways: s x n, from the minimum to where the misfits are; bottom: that of the minimum.
Acceptance testRises(const LocalMisfit& minimum, double bottom, const MatrixXd& ways,
                     const VectorXd& misfits) {
  const MatrixXd hessian = minimum.calcHessian();
  for (Index i = 0; i < ways.cols(); ++i) {
    const VectorXd way = ways.col(i);
    const double expected = way.dot(hessian * way), reach = std::sqrt(expected);
    const double rise = misfits[i] - bottom + 2.0 * minimum.descent.dot(way);
    if (reach > kMinTestReach && !(rise > kMinRise * expected && rise < kLargestRise * expected)) {
      return {RefinementStatus::kNonlinear,
              fmt::format(
                  "{:.2g} standard deviations beside the answer chi-square rises by {:.3g} instead of {:.3g}",
                  reach, rise, expected)};
    }
  }
  return {};
}

}  // namespace

double calcChiSquareLimit(double degrees) {
  return boost::math::quantile(boost::math::chi_squared(degrees), 1.0 - kRareLevel);
}

double calcChiSquareLimit(const LocalMisfit& minimum) {
  return calcChiSquareLimit(minimum.calcDegrees());
}

Acceptance testMinimum(Misfit& misfit, const LocalMisfit& minimum, bool along_ridge) {
  if (!isExplained(minimum)) {
    return refuseMisfit(minimum);
  }
  const Probes probes = makeProbes(misfit.getBox(), minimum, along_ridge);
  const VectorXd misfits = misfit.evaluate(probes.points);
  const Index last = probes.reach.size();
  // the bottom is simulated as the others: integration errors differ
  return testRises(minimum, misfits[last], probes.points.leftCols(last).colwise() - minimum.at,
                   misfits.head(last));
}

Acceptance testProbed(const ProbedMisfit& minimum) {
  if (!isExplained(minimum.local)) {
    return refuseMisfit(minimum.local);
  }
  MatrixXd ways(minimum.ways.rows(), 2 * minimum.ways.cols());
  ways << minimum.ways, -minimum.ways;
  return testRises(minimum.local, minimum.local.misfit, ways, minimum.misfits);
}

}  // namespace twinmap
