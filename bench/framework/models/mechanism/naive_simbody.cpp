#include "bench/framework/models/mechanism/naive_simbody.hpp"

#include <Simbody.h>

namespace twinmap::bench {
namespace {

using SimTK::Force;
using SimTK::MobilizedBody;
using SimTK::Vec3;

class Pulses : public Force::Custom::Implementation {
 public:
  Pulses(const MobilizedBody& beam1, const MobilizedBody& beam2) : beam1_(beam1), beam2_(beam2) {}

  void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                 SimTK::Vector_<Vec3>&, SimTK::Vector&) const override {
    if (state.getTime() >= 0.2 && state.getTime() < 0.25) {
      beam1_.applyBodyForce(state, SimTK::SpatialVec(Vec3(0.0), Vec3(0.0, 5.0, 0.0)), body_forces);
      beam2_.applyBodyTorque(state, Vec3(0.075, 0.0, 0.0), body_forces);
    }
  }
  SimTK::Real calcPotentialEnergy(const SimTK::State&) const override { return 0.0; }

 private:
  const MobilizedBody beam1_, beam2_;
};

SimTK::Body::Rigid makeBeam2() {
  const Vec3 center(0.0, 0.034, 0.022);
  const SimTK::Inertia inertia = SimTK::Inertia(1.3e-4).shiftFromMassCenter(center, 0.13);
  return SimTK::Body::Rigid(SimTK::MassProperties(0.13, center, inertia));
}

}  // namespace

Eigen::MatrixXd simulateNaively(const Eigen::Vector4d& parameters, const Eigen::VectorXd& times,
                                double start_theta, double accuracy) {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter(system);
  SimTK::GeneralForceSubsystem forces(system);
  Force::Gravity(forces, matter, Vec3(0.0, 0.0, -9.81));
  const SimTK::Transform y_axis(SimTK::Rotation(SimTK::Pi / 2, SimTK::ZAxis));
  const SimTK::Transform x_axis(SimTK::Rotation(SimTK::Pi / 2, SimTK::YAxis));
  const SimTK::Body::Rigid beam(SimTK::MassProperties(3.3, Vec3(0.0), SimTK::Inertia(0.0)));
  const MobilizedBody::Slider beam1(matter.updGround(), y_axis, beam, y_axis);
  MobilizedBody beam1_handle = beam1;
  const MobilizedBody::Pin beam2(beam1_handle, x_axis, makeBeam2(), x_axis);
  Force::MobilityLinearDamper(forces, beam1, SimTK::MobilizerUIndex(0), parameters[0]);
  Force::MobilityLinearDamper(forces, beam2, SimTK::MobilizerUIndex(0), parameters[1]);
  Force::MobilityLinearSpring(forces, beam1, SimTK::MobilizerQIndex(0), parameters[2], 0.0);
  Force::MobilityLinearSpring(forces, beam2, SimTK::MobilizerQIndex(0), parameters[3], 0.0);
  Force::Custom(forces, new Pulses(beam1, beam2));
  SimTK::State state = system.realizeTopology();
  beam2.setOneQ(state, 0, start_theta);
  SimTK::RungeKuttaMersonIntegrator integrator(system);
  integrator.setAccuracy(accuracy);
  SimTK::TimeStepper stepper(system, integrator);
  stepper.initialize(state);
  Eigen::MatrixXd result(2, times.size());
  for (Eigen::Index i = 0; i < times.size(); ++i) {
    stepper.stepTo(times[i]);
    result(0, i) = beam1.getOneQ(stepper.getState(), 0);
    result(1, i) = beam2.getOneQ(stepper.getState(), 0);
  }
  return result;
}

}  // namespace twinmap::bench
