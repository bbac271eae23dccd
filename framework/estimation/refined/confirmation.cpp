#include "framework/estimation/refined/confirmation.hpp"

#include <algorithm>
#include <cmath>

#include "framework/estimation/levels.hpp"
#include "framework/estimation/refined/acceptance.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Along the eigenvectors of a covariance, two standard deviations or as far as the limits allow on both
/// sides; nothing where that is too short.
std::optional<MatrixXd> makeWays(const SearchBox& box, const VectorXd& at, const MatrixXd& covariance) {
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(covariance);
  MatrixXd ways = eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  for (Index i = 0; i < ways.cols(); ++i) {
    const double reach =
        std::min(box.calcReach(at, ways.col(i), kTestReach), box.calcReach(at, -ways.col(i), kTestReach));
    if (reach < kMinTestReach) {
      return std::nullopt;
    }
    ways.col(i) *= reach;
  }
  return ways;
}

/// Whether differences were taken over about the distance that the linear model itself calls two standard
/// deviations.
bool isRightlyScaled(const ProbedMisfit& probed) {
  const MatrixXd hessian = probed.local.calcHessian();
  const Eigen::ArrayXd reach =
      (probed.ways.array() * (hessian * probed.ways).array()).colwise().sum().sqrt().transpose();
  return reach.minCoeff() >= kMinTestReach && reach.maxCoeff() <= kBasinReach;
}

}  // namespace

std::optional<SearchEnd> confirm(Misfit& misfit, const VectorXd& start, MatrixXd covariance) {
  SearchEnd end;
  VectorXd at = start;
  for (double misfit_before = std::numeric_limits<double>::infinity(); end.iterations < kFewIterations;) {
    ++end.iterations;
    const std::optional<MatrixXd> ways = makeWays(misfit.getBox(), at, covariance);
    if (!ways) {
      return std::nullopt;
    }
    const ProbedMisfit probed = misfit.probe(at, *ways);
    if (!probed.local.status.ok || !(probed.local.misfit <= misfit_before)) {
      return std::nullopt;
    }
    const NewtonStep newton = calcNewtonStep(probed.local, misfit.getBox());
    if (newton.length < kConverged && isRightlyScaled(probed)) {
      end.local = probed.local;
      end.rest = newton.step;
      end.converged = testProbed(probed).status == RefinementStatus::kAccepted;
      return end.converged ? std::optional(end) : std::nullopt;
    }
    misfit_before = probed.local.misfit;
    covariance = probed.local.calcCovariance();
    at = misfit.getBox().clamp(at + newton.step);
  }
  return std::nullopt;
}

}  // namespace twinmap
