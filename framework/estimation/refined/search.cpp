#include "framework/estimation/refined/search.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// From nearly a Gauss-Newton step to a short one along the steepest descent. One of them fits wherever the
/// linear model holds for some length, so that no iteration is lost on finding it.
constexpr std::array<double, 4> kDampings{0.01, 1.0, 30.0, 1000.0};
constexpr double kFirstDamping = 1e-3, kMinDamping = 1e-10, kMaxDamping = 1e7;
constexpr double kLongestStep = 0.3;  // half-widths
constexpr double kBeyondLimit = 1.0;  // as kConverged, where the limits of the box stop it
constexpr double kHidden = 0.3;       // the same where the misfit is too rough to go on: adds 4 %

/// The parameters that a step may move: those at a limit whose descent points outwards are held.
std::vector<Index> findFree(const LocalMisfit& local, const SearchBox& box) {
  std::vector<Index> free;
  for (Index j = 0; j < local.at.size(); ++j) {
    const bool held = (local.at[j] <= box.getLower()[j] && local.descent[j] < 0.0) ||
                      (local.at[j] >= box.getUpper()[j] && local.descent[j] > 0.0);
    if (!held) {
      free.push_back(j);
    }
  }
  return free;
}

/// (H + damping diag(H)) step = descent for the free parameters; the others stay.
VectorXd calcStep(const LocalMisfit& local, const SearchBox& box, double damping) {
  const std::vector<Index> free = findFree(local, box);
  VectorXd step = VectorXd::Zero(local.at.size());
  if (!free.empty()) {
    MatrixXd damped = local.calcHessian()(free, free);
    damped.diagonal() *= 1.0 + damping;
    step(free) = linalg::solvePositiveDefinite(damped, local.descent(free));
  }
  return step;
}

VectorXd take(const LocalMisfit& local, const SearchBox& box, const VectorXd& step) {
  const double length = step.cwiseAbs().maxCoeff();
  return box.clamp(local.at + std::min(1.0, kLongestStep / length) * step);
}

/// The points that the dampings lead to, a column each.
MatrixXd makeTrials(const LocalMisfit& local, const SearchBox& box, double damping) {
  MatrixXd trials(local.at.size(), kDampings.size());
  for (std::size_t i = 0; i < kDampings.size(); ++i) {
    trials.col(static_cast<Index>(i)) = take(local, box, calcStep(local, box, damping * kDampings[i]));
  }
  return trials;
}

/// The best of the trials and its index, where it is better than `local`: with derivatives at all of them,
/// or, where that costs more, at the best alone.
struct BestTrial {
  std::optional<LocalMisfit> local;
  Index index = 0;
};

BestTrial findBest(Misfit& misfit, const LocalMisfit& local, const MatrixXd& trials) {
  BestTrial best;
  if (!misfit.linearizesTogether()) {
    if (misfit.evaluate(trials).minCoeff(&best.index) < local.misfit) {
      best.local = misfit.linearize(trials.col(best.index));
    }
  } else {
    const std::vector<LocalMisfit> all = misfit.linearizeAll(trials);
    double least = local.misfit;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].status.ok && all[i].misfit < least) {
        least = all[i].misfit;
        best = {all[i], static_cast<Index>(i)};
      }
    }
  }
  if (best.local && !best.local->status.ok) {
    best.local.reset();
  }
  return best;
}

/// Tries all dampings from `local`. Moves to the best one if it improves the misfit, and centres the damping
/// on it. Otherwise raises the damping beyond all that were tried.
bool improve(Misfit& misfit, LocalMisfit& local, double& damping) {
  BestTrial best = findBest(misfit, local, makeTrials(local, misfit.getBox(), damping));
  if (!best.local) {
    damping *= 10.0 * kDampings.back();
    return false;
  }
  damping = std::max(damping * kDampings[static_cast<std::size_t>(best.index)], kMinDamping);
  local = std::move(*best.local);
  return true;
}

/// How far the step goes where the limits do not stop it, in standard deviations.
double calcFreeLength(const LocalMisfit& local) {
  const MatrixXd covariance = local.calcCovariance();
  return (covariance * local.descent).cwiseQuotient(covariance.diagonal().cwiseSqrt()).cwiseAbs().maxCoeff();
}

}  // namespace

NewtonStep calcNewtonStep(const LocalMisfit& local, const SearchBox& box) {
  const VectorXd stddev = local.calcCovariance().diagonal().cwiseSqrt();
  const VectorXd step = box.clamp(local.at + calcStep(local, box, 0.0)) - local.at;
  return {step, step.cwiseQuotient(stddev).cwiseAbs().maxCoeff()};
}

SearchEnd search(Misfit& misfit, const VectorXd& start, int max_iterations) {
  SearchEnd end;
  end.local = misfit.linearize(start);
  if (!end.local.status.ok) {
    end.message = end.local.status.reason;
    return end;
  }
  double damping = kFirstDamping;
  NewtonStep newton = calcNewtonStep(end.local, misfit.getBox());
  while (!(newton.length < kConverged) && end.iterations < max_iterations && damping < kMaxDamping) {
    ++end.iterations;
    if (improve(misfit, end.local, damping)) {
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
    end.message = damping < kMaxDamping
                      ? fmt::format("the search did not converge in {} iterations", max_iterations)
                      : "no step improves the misfit";
  }
  return end;
}

}  // namespace twinmap
