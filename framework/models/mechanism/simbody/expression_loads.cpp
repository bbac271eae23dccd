#include "framework/models/mechanism/simbody/expression_loads.hpp"

#include "framework/models/mechanism/simbody/mass_properties.hpp"

namespace twinmap {
namespace {

using SimTK::Vec3;

Vec3 calcInGround(const std::array<CompiledExpression, 3>& components, ForceFrame frame,
                  const SimTK::MobilizedBody& body, const SimTK::State& state) {
  const Vec3 value(components[0].calc(), components[1].calc(), components[2].calc());
  return frame == ForceFrame::kBody ? body.expressVectorInGroundFrame(state, value) : value;
}

}  // namespace

ExpressionLoads::ExpressionLoads(const ModelSpec& model, const SystemNames& names,
                                 const ExpressionScope& numbers)
    : model_(model), names_(names) {
  defineNames(numbers);
  compileLoads();
}

void ExpressionLoads::defineNames(const ExpressionScope& numbers) {
  for (const std::string& name : numbers.getNames()) {
    scope_.define(name);
  }
  first_coordinate_ = static_cast<int>(scope_.getNames().size());
  for (const BodySpec& body : model_.system.bodies) {
    for (const Name& coordinate : body.joint.coordinates) {
      defineName(scope_, coordinate);
    }
  }
  first_speed_ = static_cast<int>(scope_.getNames().size());
  for (const BodySpec& body : model_.system.bodies) {
    for (const Name& coordinate : body.joint.coordinates) {
      defineName(scope_, {coordinate.text + "_dot", coordinate.where});
    }
  }
  first_signal_ = static_cast<int>(scope_.getNames().size());
  for (const SignalSpec& signal : model_.excitation) {
    defineName(scope_, signal.name);
  }
  time_ = scope_.define("t");
}

void ExpressionLoads::compileLoads() {
  for (const AppliedForceSpec& force : model_.system.applied_forces) {
    const Station station{names_.findBody(force.station.body), Eigen::Vector3d::Zero()};
    forces_.push_back({force, station, compile3(force.force), force.frame});
  }
  for (const AppliedMomentSpec& moment : model_.system.applied_moments) {
    moments_.push_back({names_.findBody(moment.body), compile3(moment.moment), moment.frame});
  }
  for (const ForceLawSpec& law : model_.system.force_laws) {
    laws_.push_back({names_.findForcedCoordinate(law.coordinate), scope_.compile(law.force)});
  }
}

ExpressionLoads::Components ExpressionLoads::compile3(const Expression3& expressions) {
  return {scope_.compile(expressions[0]), scope_.compile(expressions[1]), scope_.compile(expressions[2])};
}

void ExpressionLoads::update(const ExpressionScope& values, NumberEvaluator& numbers) {
  for (int i = 0; i < first_coordinate_; ++i) {
    scope_.upd(i) = values.get(i);
  }
  for (AppliedForce& force : forces_) {
    force.station = calcAppliedStation(force.spec, names_, numbers);
  }
}

void ExpressionLoads::setValues(double t, const std::vector<double>& signals, const ForceSum& sum) {
  const SimTK::Vector& q = sum.getState().getQ();
  const SimTK::Vector& qdot = sum.getTree().getMatter().getQDot(sum.getState());
  const std::vector<BodyTree::Slot>& slots = sum.getTree().getSlots();
  for (std::size_t i = 0; i < slots.size(); ++i) {
    scope_.upd(first_coordinate_ + static_cast<int>(i)) = q[slots[i].q];
    scope_.upd(first_speed_ + static_cast<int>(i)) = qdot[slots[i].q];
  }
  for (std::size_t i = 0; i < signals.size(); ++i) {
    scope_.upd(first_signal_ + static_cast<int>(i)) = signals[i];
  }
  scope_.upd(time_) = t;
}

void ExpressionLoads::add(double t, const std::vector<double>& signals, ForceSum& sum) {
  if (forces_.empty() && moments_.empty() && laws_.empty()) {
    return;
  }
  setValues(t, signals, sum);
  for (const AppliedForce& force : forces_) {
    const SimTK::MobilizedBody& body = sum.getBody(force.station.body);
    sum.addForce(force.station.body, toVec3(force.station.point),
                 calcInGround(force.components, force.frame, body, sum.getState()));
  }
  for (const AppliedMoment& moment : moments_) {
    const SimTK::MobilizedBody& body = sum.getBody(moment.body);
    sum.addMoment(moment.body, calcInGround(moment.components, moment.frame, body, sum.getState()));
  }
  for (const ForceLaw& law : laws_) {
    sum.addOnCoordinate(law.coordinate, law.force.calc());
  }
}

}  // namespace twinmap
