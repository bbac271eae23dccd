#pragma once

#include "framework/experiment/inverse_map_spec.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

constexpr double kNoise = 0.02;

inline ParameterSpec makeParameter(const char* name, double lower, double upper) {
  ParameterSpec parameter;
  parameter.name.text = name;
  parameter.bounds.lower = lower;
  parameter.bounds.upper = upper;
  return parameter;
}

inline NetworkMapSpec makeSpec(int steps) {
  NetworkMapSpec spec;
  spec.hidden = {24, 24};
  spec.steps = steps;
  spec.batch = 128;
  spec.learning_rate = 0.005;
  return spec;
}

}  // namespace twinmap
