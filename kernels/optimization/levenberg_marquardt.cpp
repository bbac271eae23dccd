#include "kernels/optimization/levenberg_marquardt.hpp"

#include <unsupported/Eigen/NonLinearOptimization>

namespace twinmap::linalg {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
namespace Space = Eigen::LevenbergMarquardtSpace;

/// A function in the form that Eigen asks for.
struct Functor {
  const ResidualFunction& function;

  int values() const { return static_cast<int>(function.residuals); }
  int operator()(const VectorXd& x, VectorXd& residual) const { return function.calc(x, residual) ? 0 : -1; }
  int df(const VectorXd& x, MatrixXd& jacobian) const { return function.derive(x, jacobian) ? 0 : -1; }
};

bool hasConverged(Space::Status status) {
  using namespace Space;
  return status == RelativeReductionTooSmall || status == RelativeErrorTooSmall ||
         status == RelativeErrorAndReductionTooSmall || status == CosinusTooSmall || status == FtolTooSmall ||
         status == XtolTooSmall || status == GtolTooSmall;
}

}  // namespace

bool minimizeSquares(const ResidualFunction& function, const LevenbergMarquardtOptions& options,
                     VectorXd& x) {
  Functor functor{function};
  Eigen::LevenbergMarquardt<Functor> search(functor);
  search.parameters.ftol = options.tolerance;
  search.parameters.xtol = options.tolerance;
  search.parameters.factor = options.first_step;
  return hasConverged(search.minimize(x));
}

}  // namespace twinmap::linalg
