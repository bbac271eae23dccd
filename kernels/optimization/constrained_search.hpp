#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>

namespace twinmap::optimization {

/// min f(x) subject to g(x) <= 0 and 0 <= x <= 1.
struct ConstrainedProblem {
  Eigen::Index variables = 0, constraints = 0;
  /// f(x), and g(x) into `constraints`. Returning NaN, or throwing, ends the search; what was thrown is
  /// thrown again.
  std::function<double(const Eigen::VectorXd& x, Eigen::VectorXd& constraints)> calc;
};

/// kLinear: linear models of f and g in a trust region, without derivatives (COBYLA, Powell 1994).
/// kQuadratic: sequential quadratic programming (Kraft 1988) on forward differences.
/// kGlobal: an evolution strategy with ranked constraints (ISRES, Runarsson and Yao 2005).
enum class ConstrainedMethod { kLinear, kQuadratic, kGlobal };

struct ConstrainedLimits {
  int max_evaluations = 100;  ///< of calc(), those for differences included
  double first_step = 0.2;    ///< of kLinear
  double tolerance = 1e-4;    ///< of x and of f
  std::uint64_t seed = 1;     ///< of kGlobal
};

/// Where a search ended; the caller keeps the best of what calc() saw, which need not be the end.
Eigen::VectorXd searchConstrained(const ConstrainedProblem& problem, ConstrainedMethod method,
                                  const Eigen::VectorXd& start, const ConstrainedLimits& limits);

}  // namespace twinmap::optimization
