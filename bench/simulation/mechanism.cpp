#include "bench/simulation/mechanism.hpp"

#include <fmt/core.h>

#include <cmath>

namespace twinmap::bench {
namespace {

// Bodies are counted from 1 (0 is the world), joints from 0.

void updateTwoBeam(const Point& parameters, mjModel& model) {
  model.dof_damping[0] = parameters[0];
  model.dof_damping[1] = parameters[1];
  model.jnt_stiffness[0] = parameters[2];
  model.jnt_stiffness[1] = parameters[3];
}

void applyTwoBeamPulses(const Point&, double time, mjData& data) {
  const bool is_on = time > 0.2 && time < 0.25;
  data.qfrc_applied[0] = is_on ? 5.0 : 0.0;
  data.qfrc_applied[1] = is_on ? 0.075 : 0.0;
}

void updateSixPins(const Point& parameters, mjModel& model) {
  for (int body = 1; body <= 6; ++body) {
    model.body_mass[body] = parameters[0];
    model.body_ipos[3 * body + 2] = -parameters[1];
    model.body_pos[3 * body + 2] = body == 1 ? 0.0 : -parameters[1];
  }
  model.opt.gravity[2] = -parameters[2];
}

void updateCrane(const Point& parameters, mjModel& model) {
  model.body_mass[1] = parameters[0];
  model.body_mass[2] = parameters[1];
  model.body_ipos[3 * 2 + 2] = -parameters[2];
  model.jnt_stiffness[0] = parameters[3] + parameters[4];
  model.dof_damping[0] = parameters[6];
  model.dof_damping[1] = parameters[7];
}

void applyCraneForces(const Point& parameters, mjData& data) {
  const double t = data.time, y = data.qpos[0];
  const double cycles = 0.5 * t + (3.0 - 0.5) / 4.0 * t * t / 2.0;
  data.qfrc_applied[0] = 15.0 * std::sin(2.0 * mjPI * cycles) - parameters[5] * y * y * y;
}

void updateGantry(const Point& parameters, mjModel& model) {
  model.jnt_stiffness[0] = parameters[0];
  model.dof_damping[0] = parameters[1];
  model.jnt_stiffness[1] = parameters[2];
  model.dof_damping[1] = parameters[3];
  model.dof_damping[2] = parameters[4];
  model.body_mass[3] = parameters[5];
}

void applyGantryForces(const Point& parameters, double time, mjData& data) {
  data.qfrc_applied[0] = parameters[6] + (time > 0.1 && time < 0.3 ? 60.0 : 0.0);
}

void updateDoublePendulum(const Point& parameters, mjModel& model) {
  constexpr double kUpperMass = 0.5, kLowerLength = 0.25;
  const double mass = parameters[3], length = parameters[4];
  model.jnt_stiffness[0] = parameters[0];
  model.dof_damping[0] = parameters[1];
  model.dof_damping[1] = parameters[2];
  model.body_ipos[3 * 2 + 1] = -0.5 * length;
  model.body_pos[3 * 3 + 1] = -length;
  model.body_mass[3] = mass;
  for (int axis = 0; axis < 3; ++axis) {  // the motion is plane: only that about z counts
    model.body_inertia[3 * 2 + axis] = kUpperMass * length * length / 12.0;
    model.body_inertia[3 * 3 + axis] = mass * kLowerLength * kLowerLength / 12.0;
  }
}

void applyDoublePendulumPulse(const Point&, double time, mjData& data) {
  data.qfrc_applied[0] = time > 0.1 && time < 0.3 ? 40.0 : 0.0;
}

void updateFourStoreys(const Point& parameters, mjModel& model) {
  for (int storey = 0; storey < 4; ++storey) {
    model.jnt_stiffness[storey] = parameters[storey];
    model.dof_damping[storey] = parameters[4 + storey];
  }
}

void applyFourStoreysPulse(const Point&, double time, mjData& data) {
  for (int storey = 0; storey < 4; ++storey) {  // each storey slides on the one below
    data.qfrc_applied[storey] = time > 0.05 && time < 0.15 ? 40.0 : 0.0;
  }
}

void updateSpatialArm(const Point& parameters, mjModel& model) {
  model.jnt_stiffness[0] = parameters[0];
  model.jnt_stiffness[2] = parameters[1];
  for (int axis = 0; axis < 3; ++axis) {
    model.dof_damping[axis] = parameters[2];
  }
  model.body_mass[2] = parameters[3];
  model.jnt_stiffness[3] = model.jnt_stiffness[4] = parameters[4];
}

void applySpatialArmPulses(const Point&, double time, mjData& data) {
  constexpr int kTip = 3;
  data.xfrc_applied[6 * kTip + 1] = time > 0.05 && time < 0.1 ? 20.0 : 0.0;
  data.xfrc_applied[6 * kTip + 2] = time > 0.3 && time < 0.35 ? 15.0 : 0.0;
}

/// Samples of the coordinates every 0.05 s, which the edges of all pulses are multiples of.
std::vector<std::string> makeCoordinateOutputs(const std::vector<std::string>& coordinates, int count) {
  std::string outputs, names, noise;
  for (const std::string& name : coordinates) {
    const std::string comma = names.empty() ? "" : ", ";
    outputs += fmt::format("{0}{1}: {{coordinate: {1}}}", comma, name);
    names += comma + name;
    noise += comma + name + ": 1e-3";
  }
  return {"outputs={" + outputs + "}", "noise.stddev={" + noise + "}",
          fmt::format("features=[{{samples: {{outputs: [{}], start: 0.05, interval: 0.05, count: {}}}}}]",
                      names, count)};
}

}  // namespace

std::vector<Mechanism> makeMechanisms() {
  const std::string source = TWINMAP_SOURCE_DIR, here = source + "/bench/simulation/";
  return {
      {"two beams",
       source + "/experiments/two_beam/table1.yaml",
       here + "two_beam.xml",
       {},
       updateTwoBeam,
       applyTwoBeamPulses,
       nullptr},
      {"six pins", here + "six_pins.yaml", here + "six_pins.xml", {}, updateSixPins, nullptr, nullptr},
      {"crane",
       source + "/experiments/crane/crane.yaml",
       here + "crane.xml",
       {},
       updateCrane,
       nullptr,
       applyCraneForces},
      {"gantry", here + "gantry.yaml", here + "gantry.xml", {}, updateGantry, applyGantryForces, nullptr}};
}

std::vector<Mechanism> makeCurveMechanisms() {
  const std::string source = TWINMAP_SOURCE_DIR, here = source + "/bench/simulation/";
  const std::string experiments = source + "/experiments/mechanisms/";
  return {
      makeMechanisms().front(),
      {"double pendulum", experiments + "double_pendulum.yaml", here + "double_pendulum.xml",
       makeCoordinateOutputs({"x", "a1", "a2"}, 80), updateDoublePendulum, applyDoublePendulumPulse, nullptr},
      {"four masses in a chain", experiments + "four_storeys.yaml", here + "four_storeys.xml",
       makeCoordinateOutputs({"s1", "s2", "s3", "s4"}, 80), updateFourStoreys, applyFourStoreysPulse,
       nullptr},
      {"spatial arm", experiments + "spatial_arm.yaml", here + "spatial_arm.xml",
       makeCoordinateOutputs({"qx", "qy", "qz", "p", "r"}, 60), updateSpatialArm, applySpatialArmPulses,
       nullptr}};
}

}  // namespace twinmap::bench
