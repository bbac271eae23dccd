#pragma once

#include <array>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/joint_type.hpp"
#include "tests/framework/models/mechanism/run_model.hpp"

namespace twinmap::testing {

inline std::vector<JointType> listJoints() {
  std::vector<JointType> types;
  for (const JointTraits& joint : kJoints) {
    types.push_back(joint.value);
  }
  return types;
}

inline std::vector<std::string> makeNames(const std::string& prefix, JointType type) {
  std::vector<std::string> names;
  for (int i = 0; i < getCoordinateCount(type); ++i) {
    names.push_back(prefix + std::to_string(i));
  }
  return names;
}

/// Two branches on a pinned base: the joint under test carries a body that carries a slider; a pin beside it.
inline ModelSpec makeTree(JointType type) {
  ModelSpec model = makeModel(1.0);
  model.system.gravity = ex3("0.3", "-2", "-9.81");
  const Expression3 moments = ex3("0.02", "0.03", "0.04");
  JointSpec tested = joint(type, makeNames("q", type), "base");
  tested.in_parent.point = ex3("0.1", "0.2", "-0.3");
  tested.in_parent.orientation = ex3("0.3", "-0.2", "0.1");
  tested.in_body.point = ex3("-0.2", "0.05", "0.1");
  tested.in_body.orientation = ex3("-0.1", "0.4", "0.2");
  tested.pitch = ex("0.2");
  model.system.bodies = {
      body("base", "2", ex3("0.1", "0", "0.2"), moments,
           joint(JointType::kPin, ex3("1", "1", "0"), {"base_turn"})),
      body("tested", "0.5", ex3("0.1", "-0.2", "0.05"), moments, tested),
      body("rider", "0.3", ex3("0.2", "0.1", "0"), moments,
           joint(JointType::kSlider, ex3("0", "1", "1"), {"ride"}, "tested")),
      body("beside", "0.4", ex3("0", "0.3", "0.1"), moments, joint(JointType::kPin, {"swing"}, "base"))};
  model.system.bodies[1].inertia.products = ex3("0.001", "-0.002", "0.003");
  model.system.elements.get<Spring>() = {{name("ride"), ex("7"), ex("0.1")}};
  model.system.elements.get<Damper>() = {{name("swing"), ex("0.3")}};
  model.system.elements.get<TwoPointSpring>() = {
      {station("beside", ex3("0.1", "0", "0")), station("rider", ex3("0", "0.2", "0")), ex("5"), ex("0.1")}};
  model.system.elements.get<TwoPointDamper>() = {
      {station("beside", ex3("0.1", "0", "0")), station("rider", ex3("0", "0.2", "0")), ex("2")}};
  model.system.elements.get<AppliedForce>() = {
      {station("rider", ex3("0.1", "0", "0.2")), ex3("t", "2 * ride", "swing_dot"), ForceFrame::kBody}};
  return model;
}

/// Outputs of every kind on the model of makeTree.
inline void addAllOutputs(ModelSpec& model) {
  const StationOutputSpec at = along("rider", ex3("0.1", "-0.2", "0.3"), ex3("1", "2", "-2"));
  model.outputs = {coordinateOutput("ride"), speedOutput("swing"), {}, {}, {}};
  for (const std::string& own : makeNames("q", model.system.bodies[1].joint.type)) {
    model.outputs.push_back(speedOutput(own));
  }
  model.outputs[2].position = at;
  model.outputs[3].velocity = at;
  model.outputs[4].acceleration = at;
  model.outputs[4].gain = ex("1.5");
  model.outputs[4].offset = ex("0.25");
}

/// Two chains of two bodies each on one body, all by the same joint; moments and forces by expression.
inline ModelSpec makeBranches(JointType type) {
  ModelSpec model = makeModel(1.0);
  model.system.gravity = ex3("0", "-9.81", "1");
  const Expression3 moments = ex3("0.02", "0.03", "0.04");
  const std::array<const char*, 5> parents{"ground", "b0", "b1", "b0", "b3"};
  for (int i = 0; i < 5; ++i) {
    const std::string own = "b" + std::to_string(i);
    JointSpec link = joint(type, makeNames(own + "q", type), parents[i]);
    link.in_parent = {ex3("0.1", "0.3", "-0.2"), ex3("0.5", "-0.3", "0.2")};
    link.in_body = {ex3("0", "-0.2", "0.1"), ex3("0.1", "0.2", "-0.4")};
    link.pitch = ex("0.3");
    if (hasAxis(type)) {
      link.axis = ex3("1", "-2", "0.5");
    }
    model.system.bodies.push_back(body(own, "0.5 + 0.1", ex3("0.05", "0.1", "-0.1"), moments, link));
  }
  model.excitation = {pulse("push", "3", "0", "2")};
  model.system.elements.get<AppliedMoment>() = {
      {name("b2"), ex3("push", "0.1", "t"), ForceFrame::kBody},
      {name("b4"), ex3("0", "push * t", "0.2"), ForceFrame::kGround}};
  model.system.elements.get<AppliedForce>() = {
      {station("b4", ex3("0.1", "0", "0.2")), ex3("push", "-1", "sin(t)"), ForceFrame::kGround}};
  return model;
}

/// Two free bodies joined by a bushing.
inline ModelSpec makeBushedBodies() {
  ModelSpec model = makeModel(1.0);
  const Expression3 moments = ex3("0.02", "0.03", "0.04");
  model.system.bodies = {body("one", "2", ex3("0.1", "0", "0.2"), moments,
                              joint(JointType::kFree, makeNames("p", JointType::kFree))),
                         body("two", "1", ex3("0", "0.2", "0"), moments,
                              joint(JointType::kFree, makeNames("q", JointType::kFree)))};
  Bushing<Expression> bushing;
  bushing.from = {name("one"), {ex3("0.1", "0.2", "0.3"), ex3("0.3", "0.1", "-0.2")}};
  bushing.to = {name("two"), {ex3("-0.2", "0.1", "0"), ex3("0.1", "0.2", "0.2")}};
  bushing.stiffness = {ex("1"), ex("2"), ex("3"), ex("40"), ex("50"), ex("60")};
  bushing.damping = {ex("0.1"), ex("0.2"), ex("0.3"), ex("4"), ex("5"), ex("6")};
  model.system.elements.get<Bushing>() = {bushing};
  return model;
}

}  // namespace twinmap::testing
