#include "kernels/optimization/box_quadratic.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap::optimization {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

struct Box {
  const VectorXd &lower, &upper;
};

/// Those that the slope does not press against a bound.
std::vector<Index> findFree(const VectorXd& at, const VectorXd& slope, const Box& box) {
  std::vector<Index> free;
  for (Index i = 0; i < at.size(); ++i) {
    const bool at_lower = at[i] <= box.lower[i] && slope[i] > 0.0;
    const bool at_upper = at[i] >= box.upper[i] && slope[i] < 0.0;
    if (!at_lower && !at_upper) {
      free.push_back(i);
    }
  }
  return free;
}

/// Moves `at` along `step` as far as the box allows: the coordinate that ends at its bound first, -1 if none
/// does.
Index moveWithin(const Box& box, const VectorXd& step, const std::vector<Index>& free, VectorXd& at) {
  Index blocked = -1;
  double share = 1.0;
  for (const Index i : free) {
    const double room = (step[i] > 0.0 ? box.upper[i] : box.lower[i]) - at[i];
    if (std::abs(room) < share * std::abs(step[i])) {
      blocked = i;
      share = room / step[i];
    }
  }
  at += share * step;
  if (blocked >= 0) {
    at[blocked] = step[blocked] > 0.0 ? box.upper[blocked] : box.lower[blocked];
  }
  return blocked;
}

}  // namespace

VectorXd minimizeQuadratic(const MatrixXd& curvature, const VectorXd& gradient, const VectorXd& lower,
                           const VectorXd& upper) {
  const Box box{lower, upper};
  const Index n = gradient.size();
  VectorXd at = VectorXd::Zero(n);
  std::vector<Index> free = findFree(at, gradient, box);
  // More changes than a few n come of rounding alone, which could hold and release a coordinate without end.
  for (Index change = 0; change < 10 * n && !free.empty(); ++change) {
    VectorXd step = VectorXd::Zero(n);
    step(free) =
        linalg::solvePositiveDefinite(curvature(free, free), VectorXd(-(gradient + curvature * at)(free)));
    const Index blocked = moveWithin(box, step, free, at);
    if (blocked >= 0) {
      free.erase(std::find(free.begin(), free.end(), blocked));
      if (!free.empty()) {
        continue;
      }
    }
    std::vector<Index> next = findFree(at, gradient + curvature * at, box);
    if (std::includes(free.begin(), free.end(), next.begin(), next.end())) {
      break;
    }
    free = std::move(next);
  }
  return at;
}

}  // namespace twinmap::optimization
