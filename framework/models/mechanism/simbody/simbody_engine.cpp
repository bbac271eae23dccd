#include "framework/models/mechanism/simbody/simbody_engine.hpp"

#include <limits>

#include "framework/models/mechanism/modes.hpp"
#include "framework/models/mechanism/simbody/linearization.hpp"
#include "framework/models/mechanism/simbody/run_sample.hpp"

namespace twinmap {

SampleStatus SimbodyEngine::simulate(const Eigen::Ref<const Eigen::VectorXd>& parameters,
                                     Eigen::Ref<Eigen::VectorXd> response, StepSequence& sequence) {
  SampleStatus status;
  try {
    status.reason = run(parameters, response, sequence);
    if (status.reason.empty() && !response.allFinite()) {
      status.reason = "an output became non-finite";
    }
  } catch (const WallTimeReached& failure) {
    status.reason = failure.what();
    status.machine_dependent = true;
  } catch (const SimulationFailure& failure) {
    status.reason = failure.what();
  } catch (const SimTK::Exception::Base& error) {
    status.reason = std::string("Simbody: ") + error.getMessage();
  }
  status.ok = status.reason.empty();
  if (!status.ok) {
    response.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return status;
}

std::string SimbodyEngine::run(const Eigen::Ref<const Eigen::VectorXd>& parameters,
                               Eigen::Ref<Eigen::VectorXd> response, StepSequence& sequence) {
  const SimulationSpec& simulation = context_.model.simulation;
  const bool own = !context_.loops;  // whose steps know no constraints: Simbody's project
  context_.numbers.update(parameters);
  LoadedSystem system(context_, !own);
  fillModes(system, response);  // before the integration, which switches the excitation on
  if (task_.layout.times.size() == 0) {
    return "";
  }
  const Outputs outputs(context_.model.outputs, context_.names, context_.numbers);
  const InitialState initial = calcInitialState(context_, system, task_.box_center);
  const SampleRun sample{system,     context_.excitation, outputs,        initial,
                         simulation, task_.layout.times,  response.data()};
  return own ? runDopri5(sample, sequence) : runSimbody(sample);
}

void SimbodyEngine::fillModes(LoadedSystem& system, Eigen::Ref<Eigen::VectorXd> response) {
  if (task_.layout.modes == 0) {
    return;
  }
  const Eigen::VectorXd start = task_.box_center.size() > 0
                                    ? task_.box_center
                                    : assemble(context_, calcInitialValues(context_)).getEquilibrium();
  const Eigen::VectorXd equilibrium = solveEquilibrium(system, start);
  Eigen::MatrixXd matrix = calcStateMatrix(system, equilibrium);
  if (context_.assembly) {
    const Eigen::VectorXd parameters = getParameters(context_);
    const Eigen::VectorXd coordinates = equilibrium.head(context_.loops->coordinates);
    matrix = reduceToFreedoms(matrix, context_.assembly->calcSlopes(parameters, coordinates));
  }
  response.tail(2 * task_.layout.modes) = collectLowestModes(matrix, task_.layout.modes);
}

}  // namespace twinmap
