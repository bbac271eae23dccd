#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "framework/models/fmu/run/run_setting.hpp"

namespace twinmap::fmi {

/// How the derivatives of a Model Exchange FMU's outputs by the sampled parameters follow from its
/// directional derivatives: with S = dx/dp, S' = df/dx S + df/dp from S(0), and dy/dp = dg/dx S + dg/dp.
struct SensitivityPlan {
  struct Parameter {
    std::optional<std::uint32_t> known;  ///< its value reference, where f or g depend on it
    int state = -1;                      ///< the state that it is the start value of; -1: none
    double factor = 1.0;                 ///< from the experiment's unit to the FMU's
  };
  struct Output {
    int state = -1;  ///< the state that it is; -1: none
    std::uint32_t reference = 0;
    double factor = 1.0;  ///< from the FMU's unit to the experiment's
  };
  std::vector<Parameter> parameters;
  std::vector<Output> outputs;
  std::vector<std::uint32_t> states, derivatives;  ///< value references, in the order of the FMU
};

/// None where derivatives by some of the first `sampled` values cannot be had from the FMU: it offers no
/// directional derivatives; a parameter is neither an input nor the exact start value of a state nor, in FMI
/// 3.0, tunable and listed among the dependencies of an output or state derivative (FMI 2.0 knows no
/// derivatives by parameters); a state begins at what the FMU calculates; an output is neither a continuous
/// output nor a state; a state is an array.
std::optional<SensitivityPlan> planSensitivities(const ModelDescription& description,
                                                 const RunSetting& setting, std::size_t sampled);

}  // namespace twinmap::fmi
