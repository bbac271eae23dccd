#include "framework/analysis/least_squares.hpp"

#include <cmath>

#include "framework/data/sensitivity/feature_sensitivities.hpp"
#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/optimization/levenberg_marquardt.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Parameters as functions of unbounded variables x.
class BoundedVariables {
 public:
  explicit BoundedVariables(const std::vector<ParameterSpec>& parameters)
      : center_(calcBoxCenter(parameters)), half_width_(0.5 * calcWidths(parameters)) {}

  VectorXd toParameters(const VectorXd& x) const {
    return center_.array() + half_width_.array() * x.array().sin();
  }
  /// A start on a bound moves 0.1 % of the width inwards, because the slope there is 0.
  VectorXd toVariables(const VectorXd& parameters) const {
    constexpr double kInside = 0.998;
    return ((parameters - center_).array() / half_width_.array()).max(-kInside).min(kInside).asin();
  }
  /// Change of parameters in widths per change of x.
  VectorXd calcSlopes(const VectorXd& x) const { return 0.5 * x.array().cos(); }

 private:
  VectorXd center_, half_width_;
};

/// Residuals and their derivatives; false of either ends the search.
class Residuals {
 public:
  Residuals(Simulator& simulator, const LeastSquaresProblem& problem, int max_simulations)
      : simulator_(simulator),
        problem_(problem),
        variables_(problem.parameters),
        max_simulations_(max_simulations) {}

  bool calc(const VectorXd& x, VectorXd& residual) {
    constexpr double kRefused = 1e100;  // a failed simulation is no better than any other point
    MatrixXd response(simulator_.getLayout().getRowCount(), 1);
    SampleStatus status;
    simulator_.simulate(problem_.makePoint(variables_.toParameters(x)), response, &status);
    ++simulations_;
    residual = calcResidual(problem_.extractor.extract(response).col(0));
    if (!status.ok || !residual.allFinite()) {
      failure_ = status.ok ? "a feature is missing in the response" : status.reason;
      residual.setConstant(kRefused / std::sqrt(static_cast<double>(residual.size())));
    }
    return simulations_ <= max_simulations_;
  }

  bool derive(const VectorXd& x, MatrixXd& jacobian) {
    const LocalModel local = calcLocal(x);
    if (!local.status.ok) {
      failure_ = local.status.reason;
      return false;
    }
    jacobian = problem_.noise.apply(local.sensitivities) * variables_.calcSlopes(x).asDiagonal();
    return true;
  }

  LocalModel calcLocal(const VectorXd& x) {
    simulations_ += 2 * static_cast<int>(problem_.parameters.size()) + 1;
    return calcLocalModel(simulator_, problem_.extractor, problem_.parameters,
                          problem_.makePoint(variables_.toParameters(x)));
  }
  VectorXd calcResidual(const VectorXd& features) const {
    return problem_.noise.apply(features - problem_.measured);
  }
  const BoundedVariables& getVariables() const { return variables_; }
  int getSimulationCount() const { return simulations_; }
  const std::string& getFailure() const { return failure_; }

 private:
  Simulator& simulator_;
  const LeastSquaresProblem& problem_;
  BoundedVariables variables_;
  int max_simulations_;
  int simulations_ = 0;
  std::string failure_;
};

void describeEnd(bool converged, const Residuals& residuals, int max_simulations, LeastSquaresFit& fit) {
  fit.converged = converged && fit.chi_square < 1e99;
  if (fit.converged) {
    fit.message = "converged";
  } else if (residuals.getSimulationCount() > max_simulations) {
    fit.message = "stopped after " + std::to_string(residuals.getSimulationCount()) + " simulations";
  } else {
    fit.message = residuals.getFailure().empty() ? "no convergence" : residuals.getFailure();
  }
}

}  // namespace

VectorXd LeastSquaresProblem::makePoint(const VectorXd& unknown) const {
  VectorXd point(unknown.size() + inputs.size());
  point << unknown, inputs;
  return point;
}

LeastSquaresFit fitLeastSquares(Simulator& simulator, const LeastSquaresProblem& problem,
                                const VectorXd& start, int max_simulations) {
  Residuals residuals(simulator, problem, max_simulations);
  const linalg::ResidualFunction function{
      problem.noise.countDirections(), [&](const VectorXd& x, VectorXd& r) { return residuals.calc(x, r); },
      [&](const VectorXd& x, MatrixXd& j) { return residuals.derive(x, j); }};
  VectorXd x = residuals.getVariables().toVariables(start);
  const bool converged = linalg::minimizeSquares(function, {}, x);

  LeastSquaresFit fit;
  fit.parameters = residuals.getVariables().toParameters(x);
  const LocalModel local = residuals.calcLocal(x);
  fit.chi_square = residuals.calcResidual(local.features).squaredNorm();
  fit.information = calcFisherInformation(problem.noise, local.sensitivities);
  fit.simulations = residuals.getSimulationCount();
  describeEnd(converged, residuals, max_simulations, fit);
  fit.converged = fit.converged && local.status.ok;
  return fit;
}

}  // namespace twinmap
