#include "framework/models/mechanism/simbody/outputs.hpp"

#include "framework/experiment/expression/output_units.hpp"
#include "framework/models/mechanism/simbody/mass_properties.hpp"

namespace twinmap {
namespace {

using SimTK::Stage;
using SimTK::Vec3;

const char* findUnit(const OutputSpec& output, const SystemNames& names) {
  const std::optional<Name>& coordinate = output.coordinate ? output.coordinate : output.speed;
  return getOutputUnit(output, coordinate
                                   ? names.getCoordinates()[names.findCoordinate(*coordinate)].traits.kind
                                   : CoordinateKind{});
}

void checkOne(const OutputSpec& output) {
  const int count = output.coordinate.has_value() + output.speed.has_value() + output.position.has_value() +
                    output.velocity.has_value() + output.acceleration.has_value();
  if (count != 1) {
    throw ExperimentError(output.name.where, output.name.text,
                          "must measure one of coordinate, speed, position, velocity, acceleration");
  }
}

Vec3 calcDirection(const StationOutputSpec& spec, NumberEvaluator& numbers, const std::string& owner) {
  const Vec3 direction = calcVec3(numbers, spec.direction, {owner, "direction", ""});
  if (direction.norm() == 0.0) {
    throw SimulationFailure(owner + ": direction must not be zero", spec.direction[0].where);
  }
  return direction.normalize();
}

}  // namespace

std::vector<std::string> getOutputUnits(const std::vector<OutputSpec>& outputs, const SystemNames& names) {
  std::vector<std::string> units;
  for (const OutputSpec& output : outputs) {
    checkOne(output);
    units.emplace_back(findUnit(output, names));
  }
  return units;
}

Outputs::Outputs(const std::vector<OutputSpec>& outputs, const SystemNames& names, NumberEvaluator& numbers) {
  for (const OutputSpec& spec : outputs) {
    const Output output = makeOutput(spec, names, numbers);
    needs_accelerations_ = needs_accelerations_ || output.kind == Kind::kAcceleration;
    const bool position = output.kind == Kind::kPosition;
    const Stage needed = output.kind == Kind::kCoordinate ? Stage::Time
                         : position                       ? Stage::Position
                                                          : Stage::Velocity;
    stage_ = std::max(stage_, needed);
    outputs_.push_back(output);
  }
}

Outputs::Output Outputs::makeOutput(const OutputSpec& spec, const SystemNames& names,
                                    NumberEvaluator& numbers) {
  const std::string owner = "output '" + spec.name.text + "'";
  Output output = makeQuantity(spec, names, numbers);
  const bool has_gain = !spec.gain.text.empty(), has_offset = !spec.offset.text.empty();
  if (has_gain || has_offset) {
    output.sensor = {has_gain ? numbers.calc(spec.gain, {owner, "gain", ""}) : 1.0,
                     has_offset ? numbers.calc(spec.offset, {owner, "offset", findUnit(spec, names)}) : 0.0};
  }
  return output;
}

Outputs::Output Outputs::makeQuantity(const OutputSpec& spec, const SystemNames& names,
                                      NumberEvaluator& numbers) {
  if (spec.coordinate || spec.speed) {
    const Name& name = spec.coordinate ? *spec.coordinate : *spec.speed;
    const Kind kind = spec.coordinate ? Kind::kCoordinate : Kind::kSpeed;
    return {kind, names.findCoordinate(name), Station{0, Vec3(0.0)}, Vec3(0.0), {}};
  }
  const StationOutputSpec& at = spec.position   ? *spec.position
                                : spec.velocity ? *spec.velocity
                                                : *spec.acceleration;
  const Kind kind = spec.position ? Kind::kPosition : spec.velocity ? Kind::kVelocity : Kind::kAcceleration;
  const std::string owner = "output '" + spec.name.text + "'";
  return {kind, -1, calcStation(at.station, names, numbers, owner), calcDirection(at, numbers, owner), {}};
}

void Outputs::calc(LoadedSystem& system, const SimTK::State& state, double t, double* values,
                   std::ptrdiff_t stride) const {
  SimTK::Vector_<SimTK::SpatialVec> accelerations;
  if (needs_accelerations_) {
    const Eigen::VectorXd& udot = system.calcUDot(state, t);
    const SimTK::Vector view(static_cast<int>(udot.size()), udot.data(), true);
    system.getTree().getMatter().calcBodyAccelerationFromUDot(state, view, accelerations);
  }
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const Output& output = outputs_[i];
    const double quantity = output.kind == Kind::kAcceleration
                                ? calcAcceleration(output, system, state, accelerations)
                                : calcQuantity(output, system, state);
    values[static_cast<std::ptrdiff_t>(i) * stride] =
        output.sensor ? output.sensor->gain * quantity + output.sensor->offset : quantity;
  }
}

double Outputs::calcQuantity(const Output& output, const LoadedSystem& system,
                             const SimTK::State& state) const {
  const BodyTree& tree = system.getTree();
  switch (output.kind) {
    case Kind::kCoordinate:
      return state.getQ()[tree.getSlots()[output.coordinate].q];
    case Kind::kSpeed:
      return state.getQDot()[tree.getSlots()[output.coordinate].q];
    case Kind::kPosition:
      return SimTK::dot(
          tree.getBody(output.station.body).findStationLocationInGround(state, output.station.point),
          output.direction);
    default:
      return SimTK::dot(
          tree.getBody(output.station.body).findStationVelocityInGround(state, output.station.point),
          output.direction);
  }
}

/// a + b x r + w x (w x r), with b and a the angular and linear acceleration of the body at its origin.
double Outputs::calcAcceleration(const Output& output, const LoadedSystem& system, const SimTK::State& state,
                                 const SimTK::Vector_<SimTK::SpatialVec>& accelerations) const {
  const SimTK::MobilizedBody& body = system.getTree().getBody(output.station.body);
  const SimTK::SpatialVec& at_origin = accelerations[output.station.body];
  const Vec3 arm = body.expressVectorInGroundFrame(state, output.station.point);
  const Vec3& spin = body.getBodyAngularVelocity(state);
  const Vec3 acceleration =
      at_origin[1] + SimTK::cross(at_origin[0], arm) + SimTK::cross(spin, SimTK::cross(spin, arm));
  return SimTK::dot(acceleration, output.direction);
}

}  // namespace twinmap
