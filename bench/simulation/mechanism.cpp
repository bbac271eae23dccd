#include "bench/simulation/mechanism.hpp"

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

}  // namespace

std::vector<Mechanism> makeMechanisms() {
  const std::string source = TWINMAP_SOURCE_DIR, here = source + "/bench/simulation/";
  return {{"two beams", source + "/experiments/two_beam/table1.yaml", here + "two_beam.xml", updateTwoBeam,
           applyTwoBeamPulses, nullptr},
          {"six pins", here + "six_pins.yaml", here + "six_pins.xml", updateSixPins, nullptr, nullptr},
          {"crane", source + "/experiments/crane/crane.yaml", here + "crane.xml", updateCrane, nullptr,
           applyCraneForces},
          {"gantry", here + "gantry.yaml", here + "gantry.xml", updateGantry, applyGantryForces, nullptr}};
}

}  // namespace twinmap::bench
