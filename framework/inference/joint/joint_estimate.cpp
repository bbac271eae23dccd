#include "framework/inference/joint/joint_estimate.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/estimation/posterior/agreement.hpp"
#include "framework/estimation/ridges/simulated_ridges.hpp"
#include "framework/inference/derived_values.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Points of all unknown parameters that fit, the best one first: some of the draws or, where these cannot be
/// believed, places on the floors of valleys. What is not drawn is as it fits best. None where the posterior
/// is too narrow for ridges.
MatrixXd listRidgePoints(const PosteriorProblem& problem, const PosteriorEstimate& posterior,
                         const SimulatorPosterior& joint, const std::vector<ParameterSpec>& parameters) {
  if (!joint.isReliable()) {
    return joint.places;
  }
  const bool may_have = !Prior(problem.unknown, problem.priors).isUniform() ||
                        mayHaveRidges(posterior.estimate.draws, parameters);
  if (!may_have) {
    return {};
  }
  MatrixXd points = joint.best.replicate(1, 1 + kStandingDraws);
  points.topRightCorner(joint.draws.rows(), kStandingDraws) =
      joint.resample(VectorXd::LinSpaced(kStandingDraws, 0.5 / kStandingDraws, 1.0 - 0.5 / kStandingDraws));
  return points;
}

/// Of all measurements together about all unknown parameters, in widths of their bounds; empty where one
/// cannot be simulated.
MatrixXd sumInformation(const PosteriorProblem& problem, const VectorXd& point) {
  const LogCoordinates coordinates(problem.unknown);
  MatrixXd sum = MatrixXd::Zero(point.size(), point.size());
  try {
    for (const PartInformation& part : linearizeParts(problem, point)) {
      sum(part.unknown, part.unknown) += part.information;
    }
  } catch (const std::runtime_error&) {
    return {};
  }
  const VectorXd per_width = 2.0 * coordinates.calcSlopes(coordinates.fromParameters(point)).cwiseInverse();
  return per_width.asDiagonal() * sum * per_width.asDiagonal();
}

std::vector<Ridge> findJointRidges(const PosteriorProblem& problem, const MatrixXd& points,
                                   const ModelSpec& model) {
  const auto has_derivatives = [](const MeasuredTrial& trial) { return trial.simulator->hasDerivatives(); };
  if (!std::all_of(problem.trials.begin(), problem.trials.end(), has_derivatives)) {
    return {};
  }
  const auto p = static_cast<Index>(model.parameters.size());
  std::vector<MatrixXd> information;
  for (const auto& point : points.colwise()) {
    const MatrixXd whole = sumInformation(problem, point);
    information.push_back(whole.size() > 0 ? calcMarginalInformation(whole, p) : whole);
    if (hasManyForNames(model) && whole.size() > 0) {
      break;  // one point names base parameters
    }
  }
  return findRidges(information, points.topRows(p), model, RidgePoints::kOfOneMeasurement);
}

}  // namespace

InferredMeasurement describeTogether(const ExperimentSpec& experiment, const PosteriorProblem& problem,
                                     const SimulatorPosterior& joint) {
  const std::vector<ParameterSpec>& parameters = experiment.model.parameters;
  InferredMeasurement inferred;
  inferred.source = "joint";
  inferred.start = std::numeric_limits<double>::quiet_NaN();
  inferred.posterior =
      makePosteriorEstimate(joint, problem.unknown, static_cast<Index>(parameters.size()), {});
  inferred.quantities = makeDerivedQuantities(experiment);
  inferred.prior = findStatedPrior(experiment.model);
  if (const MatrixXd points = listRidgePoints(problem, *inferred.posterior, joint, parameters);
      points.cols() > 0) {
    inferred.ridges = findJointRidges(problem, points, experiment.model);
  }
  return inferred;
}

}  // namespace twinmap
