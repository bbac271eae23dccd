#include "framework/models/mechanism/simbody/outputs.hpp"

#include "framework/models/mechanism/constraint_numbers.hpp"
#include "framework/models/mechanism/simbody/mass_properties.hpp"

namespace twinmap {

Outputs::Outputs(const std::vector<OutputSpec>& outputs, const SystemNames& names, ModelNumbers& numbers) {
  for (const OutputSpec& spec : outputs) {
    const OutputNumbers output = calcOutputNumbers(spec, names, numbers);
    const bool of_expression = output.kind == OutputKind::kExpression;
    has_expressions_ = has_expressions_ || of_expression;
    needs_accelerations_ = needs_accelerations_ || of_expression ||
                           output.kind == OutputKind::kAcceleration ||
                           output.kind == OutputKind::kSpecificForce ||
                           output.kind == OutputKind::kReaction || output.kind == OutputKind::kForce;
    const bool position = output.kind == OutputKind::kPosition;
    const SimTK::Stage needed = output.kind == OutputKind::kCoordinate ? SimTK::Stage::Time
                                : position                             ? SimTK::Stage::Position
                                                                       : SimTK::Stage::Velocity;
    stage_ = std::max(stage_, needed);
    outputs_.push_back(output);
  }
}

void Outputs::calc(LoadedSystem& system, const SimTK::State& state, double t, double* values,
                   std::ptrdiff_t stride) const {
  SimTK::Vector_<SimTK::SpatialVec> accelerations;
  if (needs_accelerations_) {
    const Eigen::VectorXd& udot = system.calcUDot(state, t);
    const SimTK::Vector view(static_cast<int>(udot.size()), udot.data(), true);
    system.getTree().getMatter().calcBodyAccelerationFromUDot(state, view, accelerations);
    if (has_expressions_) {
      system.nameAccelerations(state, view);
    }
  }
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const OutputNumbers& output = outputs_[i];
    const bool of_acceleration =
        output.kind == OutputKind::kAcceleration || output.kind == OutputKind::kSpecificForce;
    const double quantity = of_acceleration ? calcAcceleration(output, system, state, accelerations)
                            : output.kind == OutputKind::kReaction ? calcReaction(output, system, state)
                            : output.kind == OutputKind::kForce    ? calcForce(output, system, state)
                                                                   : calcQuantity(output, system, state);
    values[static_cast<std::ptrdiff_t>(i) * stride] =
        output.sensor ? output.sensor->gain * quantity + output.sensor->offset : quantity;
  }
}

double Outputs::calcQuantity(const OutputNumbers& output, const LoadedSystem& system,
                             const SimTK::State& state) const {
  const BodyTree& tree = system.getTree();
  switch (output.kind) {
    case OutputKind::kCoordinate:
      return state.getQ()[tree.getSlots()[output.coordinate].q];
    case OutputKind::kSpeed:
      return state.getQDot()[tree.getSlots()[output.coordinate].q];
    case OutputKind::kPosition:
      return SimTK::dot(
          tree.getBody(output.station.body).findStationLocationInGround(state, toVec3(output.station.point)),
          toVec3(output.direction));
    case OutputKind::kExpression:
      return system.calcExpression(*output.expression);
    case OutputKind::kAngularVelocity: {
      const SimTK::MobilizedBody& body = tree.getBody(output.station.body);
      return SimTK::dot(body.getBodyAngularVelocity(state),
                        body.expressVectorInGroundFrame(state, toVec3(output.direction)));
    }
    default:
      return SimTK::dot(
          tree.getBody(output.station.body).findStationVelocityInGround(state, toVec3(output.station.point)),
          toVec3(output.direction));
  }
}

/// In the axes of the parent.
double Outputs::calcReaction(const OutputNumbers& output, const LoadedSystem& system,
                             const SimTK::State& state) {
  const BodyTree& tree = system.getTree();
  tree.getSystem().realize(state, SimTK::Stage::Acceleration);
  SimTK::Vector_<SimTK::SpatialVec> reactions;
  tree.getMatter().calcMobilizerReactionForces(state, reactions);
  const SimTK::SpatialVec& reaction = reactions[output.station.body];
  const SimTK::MobilizedBody& parent = tree.getBody(output.station.body).getParentMobilizedBody();
  return parent.expressGroundVectorInBodyFrame(
      state, reaction[isMoment(*output.component) ? 0 : 1])[getAxis(*output.component)];
}

double Outputs::calcForce(const OutputNumbers& output, LoadedSystem& system, const SimTK::State& state) {
  const equations::Exerted<double> exerted = output.force->constraint >= 0
                                                 ? calcConstraintForce(*output.force, system, state)
                                                 : system.calcElementForce(*output.force);
  return output.component ? equations::getComponent(exerted.force, exerted.moment, *output.component)
                          : exerted.along;
}

/// Of Simbody's multipliers, whose forces have the opposite sign and act at the body's origin.
equations::Exerted<double> Outputs::calcConstraintForce(const NamedForce& force, const LoadedSystem& system,
                                                        const SimTK::State& state) {
  const BodyTree& tree = system.getTree();
  SimbodyContext& context = system.getContext();
  const SystemSpec& spec = context.model.system;
  SimTK::SpatialVec on_to(SimTK::Vec3(0.0), SimTK::Vec3(0.0));
  for (const SimTK::ConstraintIndex index : tree.getConstraints()[force.constraint]) {
    SimTK::Vector_<SimTK::SpatialVec> on_bodies;
    SimTK::Vector on_speeds;
    tree.getMatter().getConstraint(index).getConstraintForcesAsVectors(state, on_bodies, on_speeds);
    if (force.coordinate) {
      const int coordinate = context.names.findCoordinate(*force.coordinate);
      return {-on_speeds[context.names.getCoordinates()[coordinate].local], {}, {}};
    }
    on_to -= on_bodies[1];
  }
  const ConstraintNumbers one = calcConstraintNumbers(spec, context.names, context.numbers)[force.constraint];
  const SimTK::MobilizedBody &from = tree.getBody(one.from.body), &to = tree.getBody(one.to.body);
  const SimTK::Vec3 arm = to.expressVectorInGroundFrame(state, toVec3(one.to.point));
  const SimTK::Vec3 place = to.findStationLocationInGround(state, toVec3(one.to.point));
  const SimTK::Vec3 from_place = from.findStationLocationInGround(state, toVec3(one.from.point));
  const SimTK::Vec3 direction = spec.constraints[force.constraint].rod
                                    ? from_place - place
                                    : from.expressVectorInGroundFrame(state, toVec3(one.normal));
  const double length = direction.norm();
  const SimTK::Vec3 moment = on_to[0] - SimTK::cross(arm, on_to[1]);
  const auto to_vector = [](const SimTK::Vec3& v) { return algebra::Vec3<double>{v[0], v[1], v[2]}; };
  return {length > 0.0 ? SimTK::dot(on_to[1], direction) / length : 0.0, to_vector(on_to[1]),
          to_vector(moment)};
}

/// a + b x r + w x (w x r), with b and a the angular and linear acceleration of the body at its origin; of a
/// specific force less gravity, and along the body's own direction.
double Outputs::calcAcceleration(const OutputNumbers& output, const LoadedSystem& system,
                                 const SimTK::State& state,
                                 const SimTK::Vector_<SimTK::SpatialVec>& accelerations) const {
  const SimTK::MobilizedBody& body = system.getTree().getBody(output.station.body);
  const SimTK::SpatialVec& at_origin = accelerations[output.station.body];
  const SimTK::Vec3 arm = body.expressVectorInGroundFrame(state, toVec3(output.station.point));
  const SimTK::Vec3& spin = body.getBodyAngularVelocity(state);
  const SimTK::Vec3 acceleration =
      at_origin[1] + SimTK::cross(at_origin[0], arm) + SimTK::cross(spin, SimTK::cross(spin, arm));
  const SimTK::Vec3 direction = toVec3(output.direction);
  return output.kind == OutputKind::kAcceleration
             ? SimTK::dot(acceleration, direction)
             : SimTK::dot(acceleration - system.getGravity(),
                          body.expressVectorInGroundFrame(state, direction));
}

}  // namespace twinmap
