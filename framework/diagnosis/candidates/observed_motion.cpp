#include "framework/diagnosis/candidates/observed_motion.hpp"

#include <stdexcept>

#include "framework/experiment/model/joint_type.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<ForcedCoordinate> listForcedCoordinates(const SystemSpec& system) {
  std::vector<ForcedCoordinate> coordinates;
  for (const BodySpec& body : system.bodies) {
    const JointCoordinates& joint = getJointCoordinates(body.joint.type);
    for (std::size_t i = 0; i < joint.size(); ++i) {
      if (joint[i].takes_forces) {
        coordinates.push_back({body.joint.coordinates[i].text, joint[i].kind == CoordinateKind::kRotation});
      }
    }
  }
  return coordinates;
}

void observeMotion(const ForcedCoordinate& coordinate, std::vector<OutputSpec>& outputs) {
  OutputSpec output;
  output.name = {"coordinate of " + coordinate.name, {}};
  output.coordinate = Name{coordinate.name, {}};
  outputs.push_back(output);
  output.name = {"speed of " + coordinate.name, {}};
  output.speed = output.coordinate;
  output.coordinate.reset();
  outputs.push_back(output);
}

void observeForce(const std::string& name, const Expression& force, std::vector<OutputSpec>& outputs) {
  OutputSpec output;
  output.name = {"force of " + name, {}};
  output.expression = force;
  output.unit = "N";
  outputs.push_back(output);
}

MatrixXd simulateOutputs(const ModelSpec& model, const VectorXd& times, const VectorXd& point) {
  const std::unique_ptr<Simulator> simulator = makeTrustedSimulator(model, times);
  MatrixXd response(simulator->getLayout().getRowCount(), 1);
  SampleStatus status;
  simulator->simulate(point, response, &status);
  if (!status.ok) {
    throw std::runtime_error("the best fit cannot be simulated again: " + status.reason);
  }
  return response.reshaped(times.size(), static_cast<Index>(model.outputs.size()));
}

}  // namespace twinmap
