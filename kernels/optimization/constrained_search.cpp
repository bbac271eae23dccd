#include "kernels/optimization/constrained_search.hpp"

#include <nlopt.h>

#include <cmath>
#include <exception>
#include <memory>
#include <vector>

namespace twinmap::optimization {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// NLopt asks for f and for g at the same point: both are computed once.
struct Search {
  const ConstrainedProblem& problem;
  const ConstrainedLimits& limits;
  nlopt_opt optimizer = nullptr;
  VectorXd point{}, constraints{}, gradient{};
  double value = 0.0;
  MatrixXd jacobian{};
  bool has_gradient = false;
  int evaluations = 0;
  std::exception_ptr error = nullptr;
};

double calc(Search& search, const VectorXd& x, VectorXd& constraints) {
  constraints.setZero(search.problem.constraints);
  if (search.error || search.evaluations >= search.limits.max_evaluations) {
    nlopt_force_stop(search.optimizer);
    return search.value;
  }
  ++search.evaluations;
  try {
    const double value = search.problem.calc(x, constraints);
    if (std::isnan(value)) {
      nlopt_force_stop(search.optimizer);
    }
    return value;
  } catch (...) {
    search.error = std::current_exception();
    nlopt_force_stop(search.optimizer);
    return search.value;
  }
}

void moveTo(Search& search, const double* x) {
  const VectorXd point = Eigen::Map<const VectorXd>(x, search.problem.variables);
  if (search.point.size() == 0 || search.point != point) {
    search.value = calc(search, point, search.constraints);
    search.point = point;
    search.has_gradient = false;
  }
}

/// Forward differences, backward ones at the upper bound.
void differentiate(Search& search) {
  constexpr double kStep = 1e-4;
  search.gradient.resize(search.problem.variables);
  search.jacobian.resize(search.problem.constraints, search.problem.variables);
  for (Index k = 0; k < search.problem.variables; ++k) {
    VectorXd moved = search.point, constraints;
    const double step = moved[k] + kStep > 1.0 ? -kStep : kStep;
    moved[k] += step;
    const double value = calc(search, moved, constraints);
    search.gradient[k] = (value - search.value) / step;
    search.jacobian.col(k) = (constraints - search.constraints) / step;
  }
  search.has_gradient = true;
}

double evaluateObjective(unsigned /*n*/, const double* x, double* gradient, void* data) {
  Search& search = *static_cast<Search*>(data);
  moveTo(search, x);
  if (gradient != nullptr) {
    if (!search.has_gradient) {
      differentiate(search);
    }
    Eigen::Map<VectorXd>(gradient, search.gradient.size()) = search.gradient;
  }
  return search.value;
}

void evaluateConstraints(unsigned m, double* result, unsigned n, const double* x, double* gradient,
                         void* data) {
  Search& search = *static_cast<Search*>(data);
  moveTo(search, x);
  Eigen::Map<VectorXd>(result, m) = search.constraints;
  if (gradient != nullptr) {
    if (!search.has_gradient) {
      differentiate(search);
    }
    Eigen::Map<MatrixXd>(gradient, n, m) = search.jacobian.transpose();
  }
}

nlopt_algorithm getAlgorithm(ConstrainedMethod method) {
  return method == ConstrainedMethod::kLinear      ? NLOPT_LN_COBYLA
         : method == ConstrainedMethod::kQuadratic ? NLOPT_LD_SLSQP
                                                   : NLOPT_GN_ISRES;
}

}  // namespace

VectorXd searchConstrained(const ConstrainedProblem& problem, ConstrainedMethod method, const VectorXd& start,
                           const ConstrainedLimits& limits) {
  constexpr double kConstraintTolerance = 1e-8;
  const auto n = static_cast<unsigned>(problem.variables), m = static_cast<unsigned>(problem.constraints);
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> optimizer(
      nlopt_create(getAlgorithm(method), n), &nlopt_destroy);
  Search search{problem, limits, optimizer.get()};
  const std::vector<double> tolerances(m, kConstraintTolerance);
  nlopt_set_min_objective(optimizer.get(), &evaluateObjective, &search);
  if (m > 0) {
    nlopt_add_inequality_mconstraint(optimizer.get(), m, &evaluateConstraints, &search, tolerances.data());
  }
  nlopt_set_lower_bounds1(optimizer.get(), 0.0);
  nlopt_set_upper_bounds1(optimizer.get(), 1.0);
  nlopt_set_initial_step1(optimizer.get(), limits.first_step);
  nlopt_set_xtol_abs1(optimizer.get(), limits.tolerance);
  nlopt_set_ftol_abs(optimizer.get(), method == ConstrainedMethod::kGlobal ? 0.0 : 0.1 * limits.tolerance);
  nlopt_set_maxeval(optimizer.get(), limits.max_evaluations);
  nlopt_srand(static_cast<unsigned long>(limits.seed));
  VectorXd x = start.cwiseMax(0.0).cwiseMin(1.0);
  double value = 0.0;
  nlopt_optimize(optimizer.get(), x.data(), &value);
  if (search.error) {
    std::rethrow_exception(search.error);
  }
  return x;
}

}  // namespace twinmap::optimization
