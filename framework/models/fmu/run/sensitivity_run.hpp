#pragma once

#include "framework/models/fmu/run/sample_run.hpp"
#include "framework/models/fmu/run/sensitivity_plan.hpp"

namespace twinmap::fmi {

/// Derivatives of the response (rows of the response x parameters) along the steps that a simulation of the
/// same sample has taken (`run.path`, explicit): those of its numerical solution, exact up to rounding. False
/// where an event makes them unknown. Throws SimulationFailure where the FMU fails. Cost: beside the
/// simulation's, two calls for directional derivatives an evaluation and parameter at most.
bool runSensitivities(SampleRun& run, const SensitivityPlan& plan, Eigen::Ref<Eigen::MatrixXd> derivatives);

}  // namespace twinmap::fmi
