#include "framework/multibody/second_try.hpp"

namespace twinmap {

using Eigen::VectorXd;

void SecondTry::simulate(const Eigen::Ref<const VectorXd>& parameters, Eigen::Ref<VectorXd> response,
                         SampleStatus& status) const {
  SimulationSpec simulation = model_.simulation;
  simulation.integrator = Integrator::kCpodes;
  StepSequence unused;
  SampleStatus again = simbody_.simulate(simulation, parameters, response, unused);
  again.second_try = true;
  if (!again.ok) {
    again.reason = status.reason + "; by CPodes: " + again.reason;
  }
  status = again;
}

}  // namespace twinmap
