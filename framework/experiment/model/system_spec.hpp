#pragma once

#include <vector>

#include "framework/experiment/model/body_spec.hpp"
#include "framework/experiment/model/force_spec.hpp"

namespace twinmap {

struct SystemSpec {
  Expression3 gravity;  ///< m/s2, in the ground frame; zero by default
  std::vector<BodySpec> bodies;
  std::vector<SpringSpec> springs;
  std::vector<DamperSpec> dampers;
  std::vector<TwoPointSpringSpec> two_point_springs;
  std::vector<TwoPointDamperSpec> two_point_dampers;
  std::vector<BushingSpec> bushings;
  std::vector<AppliedForceSpec> applied_forces;
  std::vector<AppliedMomentSpec> applied_moments;
  std::vector<ForceLawSpec> force_laws;

  // compiled once (experiment_spec.cpp)
  SystemSpec();
  SystemSpec(const SystemSpec&);
  SystemSpec(SystemSpec&&) noexcept;
  SystemSpec& operator=(const SystemSpec&);
  SystemSpec& operator=(SystemSpec&&) noexcept;
  ~SystemSpec();
};

inline bool isGiven(const SystemSpec& system) {
  return !system.bodies.empty();
}

template <class Fields>
void describe(Fields& f, SystemSpec& s) {
  f.optional("gravity", s.gravity, "in the ground frame; m/s2");
  f.requiredMap("bodies", s.bodies, "each with its joint to a parent declared before");
  f.optional("springs", s.springs, "linear springs on coordinates");
  f.optional("dampers", s.dampers, "linear dampers on coordinates");
  f.optional("two_point_springs", s.two_point_springs, "linear springs between two stations");
  f.optional("two_point_dampers", s.two_point_dampers, "linear dampers between two stations");
  f.optional("bushings", s.bushings, "linear 6-component elements between two frames");
  f.optional("applied_forces", s.applied_forces, "forces at stations");
  f.optional("applied_moments", s.applied_moments, "moments on bodies");
  f.optional("force_laws", s.force_laws, "generalized forces on coordinates, by expression");
}

}  // namespace twinmap
