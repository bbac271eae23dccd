#pragma once

#include <vector>

#include "framework/experiment/model/body_spec.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"

namespace twinmap {

struct SystemSpec {
  Expression3 gravity;  ///< m/s2, in the ground frame; zero by default
  std::vector<BodySpec> bodies;
  ForceElements<Expression> elements;

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
  f.optional("gravity", s.gravity, "in the ground frame", Unit{"m/s2"});
  f.requiredMap("bodies", s.bodies, "each with its joint to a parent declared before");
  describeElements(f, s.elements);
}

}  // namespace twinmap
