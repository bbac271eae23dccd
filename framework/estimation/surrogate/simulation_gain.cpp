#include "framework/estimation/surrogate/simulation_gain.hpp"

#include <algorithm>
#include <cmath>

#include "framework/estimation/folds.hpp"
#include "framework/estimation/surrogate/cross_validation.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

VectorXd calcMeanErrors(const MatrixXd& mean, const MatrixXd& truth) {
  return (mean - truth).cwiseAbs().rowwise().mean();
}

}  // namespace

SimulationGain calcSimulationGain(const Surrogate& whole, const SurrogateSamples& samples,
                                  const ForwardSamples& forward, const ForwardChoices& choices,
                                  const HeldOut& held_out, const TrainingControl& control) {
  constexpr Index kMaxInferred = 200;
  const Index n = samples.points.cols(), half = n / 2, known = samples.points.rows() - whole.unknown;
  if (half < countLeastSimulations(samples.points.rows())) {
    return {};
  }
  const Surrogate fitted =
      fitSimilar(whole, selectSimulations(forward, listRange(0, half)), choices, control);
  const std::vector<Index> others = listRange(half, std::min(n - half, kMaxInferred));
  const MatrixXd inputs = samples.points(Eigen::all, others).bottomRows(known);
  const Estimates found = fitted.invert(samples.measured(Eigen::all, others), inputs, control.threads);
  gp::throwIfStopped(control.stop);
  const MatrixXd truth = held_out.truth(Eigen::all, others);
  const VectorXd of_half = calcMeanErrors(found.mean, truth);
  const VectorXd of_folds = calcMeanErrors(held_out.predictions.mean(Eigen::all, others), truth);
  const double doublings =
      std::log2((1.0 - 1.0 / kFolds) * static_cast<double>(n) / static_cast<double>(half));
  return {half, n, of_folds.cwiseQuotient(of_half).array().pow(1.0 / doublings)};
}

}  // namespace twinmap
