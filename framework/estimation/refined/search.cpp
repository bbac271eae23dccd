#include "framework/estimation/refined/search.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "framework/estimation/refined/damped_steps.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kBeyondLimit = 1.0;  // as kConverged, where the limits of the box stop it
constexpr double kHidden = 0.3;       // the same where the misfit is too rough to go on: adds 4 %

/// One iteration: true if it moves to a better point, with derivatives at all that are tried, or, where that
/// costs more, at the best alone.
bool improve(Misfit& misfit, LocalMisfit& local, DampedSteps& steps) {
  const MatrixXd hessian = local.calcHessian();
  const LinearModel model{local.at, local.misfit, hessian, local.descent};
  const MatrixXd tried = steps.propose(model);
  std::vector<LocalMisfit> all;
  VectorXd misfits;
  if (misfit.linearizesTogether()) {
    all = misfit.linearizeAll(tried);
    misfits = VectorXd::NullaryExpr(tried.cols(), [&](Index i) {
      const LocalMisfit& one = all[static_cast<std::size_t>(i)];
      return one.status.ok ? one.misfit : std::numeric_limits<double>::infinity();
    });
  } else {
    misfits = misfit.evaluate(tried);
  }
  const std::optional<Index> best = steps.choose(model, tried, misfits);
  if (!best) {
    return false;
  }
  LocalMisfit reached =
      all.empty() ? misfit.linearize(tried.col(*best)) : all[static_cast<std::size_t>(*best)];
  const bool moves = reached.status.ok;
  if (moves) {
    local = std::move(reached);
  }
  return moves;
}

StepBounds getLimits(const SearchBox& box) {
  return {box.getLower(), box.getUpper()};
}

/// How far the step goes where the limits do not stop it, in standard deviations.
double calcFreeLength(const LocalMisfit& local) {
  const MatrixXd covariance = local.calcCovariance();
  return (covariance * local.descent).cwiseQuotient(covariance.diagonal().cwiseSqrt()).cwiseAbs().maxCoeff();
}

}  // namespace

NewtonStep calcNewtonStep(const LocalMisfit& local, const SearchBox& box) {
  const VectorXd stddev = local.calcCovariance().diagonal().cwiseSqrt();
  const MatrixXd hessian = local.calcHessian();
  const VectorXd step =
      DampedSteps(getLimits(box)).calcNewtonStep({local.at, local.misfit, hessian, local.descent});
  return {step, step.cwiseQuotient(stddev).cwiseAbs().maxCoeff()};
}

SearchEnd search(Misfit& misfit, const VectorXd& start, int max_iterations) {
  SearchEnd end;
  end.local = misfit.linearize(start);
  if (!end.local.status.ok) {
    end.message = end.local.status.reason;
    return end;
  }
  DampedSteps steps(getLimits(misfit.getBox()));
  NewtonStep newton = calcNewtonStep(end.local, misfit.getBox());
  while (!(newton.length < kConverged) && end.iterations < max_iterations && !steps.areExhausted()) {
    ++end.iterations;
    if (improve(misfit, end.local, steps)) {
      newton = calcNewtonStep(end.local, misfit.getBox());
    }
  }
  const bool at_rest = newton.length < kHidden;
  end.converged = at_rest && calcFreeLength(end.local) < kBeyondLimit;
  if (end.converged) {
    end.rest = newton.step;
  } else if (at_rest) {
    end.message = "the search ended at the bounds, and the minimum lies beyond";
  } else {
    end.message = steps.areExhausted()
                      ? "no step improves the misfit"
                      : fmt::format("the search did not converge in {} iterations", max_iterations);
  }
  return end;
}

}  // namespace twinmap
