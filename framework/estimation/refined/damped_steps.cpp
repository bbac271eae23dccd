#include "framework/estimation/refined/damped_steps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "framework/estimation/levels.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// From nearly a Gauss-Newton step to a short one: one of them fits wherever the linear model holds at all.
constexpr double kDampings[] = {0.01, 1.0, 30.0};
constexpr double kMinDamping = 1e-9, kMaxDamping = 1e8, kRaise = 100.0;
constexpr double kHeldLinear = 0.75;  // of the gain that the linear model says

/// The coordinates that a step may move: those at a bound whose descent points outwards are held.
std::vector<Index> findFree(const LinearModel& from, const StepBounds& bounds) {
  std::vector<Index> free;
  for (Index j = 0; j < from.at.size(); ++j) {
    if (!(from.at[j] <= bounds.lower[j] && from.descent[j] < 0.0) &&
        !(from.at[j] >= bounds.upper[j] && from.descent[j] > 0.0)) {
      free.push_back(j);
    }
  }
  return free;
}

/// What a step of the free coordinates may be made of (f x k): all of them, or what is at right angles to the
/// direction that is held.
MatrixXd makeBasis(const VectorXd& held, const std::vector<Index>& free) {
  const auto count = static_cast<Index>(free.size());
  Index largest = 0;
  if (held.size() == 0 || !(held(free).cwiseAbs().maxCoeff(&largest) > 0.0)) {
    return MatrixXd::Identity(count, count);
  }
  MatrixXd basis = MatrixXd::Zero(count, count - 1);
  for (Index i = 0, k = 0; i < count; ++i) {
    if (i != largest) {
      basis(i, k) = 1.0;
      basis(largest, k++) =
          -held[free[static_cast<std::size_t>(i)]] / held[free[static_cast<std::size_t>(largest)]];
    }
  }
  return basis;
}

/// (H + damping diag(H)) step = descent for the free coordinates, what has been stepped of the others given.
VectorXd solveFree(const LinearModel& from, const VectorXd& held, double damping,
                   const std::vector<Index>& free, const VectorXd& stepped) {
  VectorXd step = stepped;
  const MatrixXd basis = makeBasis(held, free);
  if (basis.cols() == 0) {
    return step;
  }
  const VectorXd descent = from.descent - from.hessian * stepped;
  MatrixXd damped = basis.transpose() * from.hessian(free, free) * basis;
  // what the response does not depend on stays
  const double floor = kRegular * damped.diagonal().maxCoeff() + std::numeric_limits<double>::min();
  damped.diagonal() = (1.0 + damping) * damped.diagonal().array() + floor;
  step(free) = basis * linalg::solvePositiveDefinite(damped, basis.transpose() * descent(free));
  return step;
}

}  // namespace

VectorXd DampedSteps::calcStep(const LinearModel& from, double damping) const {
  std::vector<Index> free = findFree(from, bounds_);
  VectorXd step = VectorXd::Zero(from.at.size());
  while (!free.empty()) {
    const VectorXd all = solveFree(from, bounds_.held, damping, free, step);
    const auto stays = [&](Index j) {
      const double end = from.at[j] + all[j];
      return !(end < bounds_.lower[j] || end > bounds_.upper[j]);
    };
    const auto left = std::stable_partition(free.begin(), free.end(), stays);
    if (left == free.end() || bounds_.held.size() > 0) {
      return all;
    }
    std::for_each(left, free.end(), [&](Index j) {
      step[j] = (all[j] > 0.0 ? bounds_.upper[j] : bounds_.lower[j]) - from.at[j];
    });
    free.erase(left, free.end());
  }
  return step;
}

VectorXd DampedSteps::take(const LinearModel& from, const VectorXd& step) const {
  const double length = step.cwiseAbs().maxCoeff();
  const double scale = length > bounds_.longest ? bounds_.longest / length : 1.0;
  return (from.at + scale * step).cwiseMax(bounds_.lower).cwiseMin(bounds_.upper);
}

MatrixXd DampedSteps::propose(const LinearModel& from) const {
  MatrixXd points(from.at.size(), linear_ ? 1 : static_cast<Index>(std::size(kDampings)));
  for (Index i = 0; i < points.cols(); ++i) {
    points.col(i) = take(from, calcStep(from, damping_ * kDampings[i]));
  }
  return points;
}

std::optional<Index> DampedSteps::choose(const LinearModel& from, const MatrixXd& tried,
                                         const VectorXd& misfits) {
  Index best = 0;
  const double least = misfits.minCoeff(&best);
  if (!(least < from.misfit)) {
    damping_ *= linear_ ? 1.0 : kRaise;
    linear_ = false;
    return {};
  }
  const double expected = from.calcGain(tried.col(best) - from.at);
  linear_ = best == 0 && from.misfit - least > kHeldLinear * expected;
  damping_ = std::max(damping_ * kDampings[best], kMinDamping);
  return best;
}

bool DampedSteps::areExhausted() const {
  return damping_ >= kMaxDamping;
}

}  // namespace twinmap
