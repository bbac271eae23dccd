#include "framework/models/mechanism/simbody/stiff_retry.hpp"

#include <algorithm>
#include <limits>

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/simulation/stencil.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// CPodes has no steps that points could share. With a thousandth of the tolerance and differences over a
// thousandth of the bounds' width, derivatives on seven mechanisms (of a point and output, as a fraction of
// their largest) err by 4e-6 to 7e-3. Ten times the width errs by 3e-3 where responses bend (spatial arm), a
// tenth of it by 2e-2 where a parameter hardly moves them (two beams); ten times less tolerance is five times
// better and takes seconds a simulation with dry friction. A chaotic pendulum has no useful ones either way.
constexpr double kDifferencesTolerance = 1e-3, kDifferencesStep = 1e-3;
constexpr double kSmallestTolerance = 1e-12;  // relative; below it is rounding

SampleStatus makeSecondStatus(const SampleStatus& first, SampleStatus second) {
  second.stiff_retry = true;
  if (!second.ok) {
    second.reason = first.reason + "; by CPodes: " + second.reason;
  }
  return second;
}

}  // namespace

void StiffRetry::simulate(const Eigen::Ref<const VectorXd>& parameters, Eigen::Ref<VectorXd> response,
                          SampleStatus& status) const {
  status = makeSecondStatus(status, simulateImplicitly(1.0, parameters, response));
}

void StiffRetry::simulateWithDerivatives(const Eigen::Ref<const VectorXd>& parameters,
                                         Eigen::Ref<VectorXd> response, Eigen::Ref<MatrixXd> derivatives,
                                         SampleStatus& status) const {
  const std::vector<ParameterSpec> sampled = collectSampled(model_);
  const MatrixXd points = makeNeighbours(sampled, parameters, kDifferencesStep);
  MatrixXd responses(response.size(), points.cols());
  SampleStatus second;
  for (Index i = 0; i < points.cols() && second.ok; ++i) {
    second = simulateImplicitly(kDifferencesTolerance, points.col(i), responses.col(i));
  }
  if (second.ok) {
    response = responses.col(0);
    derivatives = calcDifferences(responses, sampled, parameters, kDifferencesStep) *
                  calcWidths(sampled).asDiagonal().inverse();
  } else {
    response.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  status = makeSecondStatus(status, std::move(second));
}

SampleStatus StiffRetry::simulateImplicitly(double tolerance_factor,
                                            const Eigen::Ref<const VectorXd>& parameters,
                                            Eigen::Ref<VectorXd> response) const {
  SimulationSpec simulation = model_.simulation;
  simulation.integrator = Integrator::kCpodes;
  simulation.relative_tolerance =
      std::min(simulation.relative_tolerance,
               std::max(tolerance_factor * simulation.relative_tolerance, kSmallestTolerance));
  StepSequence unused;
  return simbody_.simulate(simulation, parameters, response, unused);
}

}  // namespace twinmap
