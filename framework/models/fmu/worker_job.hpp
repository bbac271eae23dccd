#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/models/fmu/package/package.hpp"
#include "framework/models/fmu/run/run_setting.hpp"
#include "framework/models/fmu/run/sensitivity_plan.hpp"

namespace twinmap::fmi {

/// All that a worker process needs to simulate samples of an FMU; travels as YAML.
struct WorkerJob {
  std::string file;             ///< the FMU's, for messages
  std::string folder, library;  ///< unpacked
  FmuKind kind = FmuKind::kCoSimulation;
  ModelSpec model;
  std::vector<double> times;  ///< s, of the outputs
};

std::string writeWorkerJob(const WorkerJob& job);
WorkerJob readWorkerJob(const std::string& text);

/// The model's names bound to the FMU's variables: its parameters and constants to what can be set, its
/// signals to inputs, its outputs to anything. A parameter without `variable` whose name the FMU does not
/// know must be used in an expression. Throws ExperimentError for what does not fit (bind_variables.hpp).
RunSetting makeRunSetting(const ModelDescription& description, Kind kind, const ModelSpec& model,
                          const std::vector<double>& times);

/// planSensitivities() for the sampled parameters; none where an expression uses one of them too.
std::optional<SensitivityPlan> makeSensitivityPlan(const ModelDescription& description,
                                                   const ModelSpec& model, const RunSetting& setting);

Kind toKind(FmuKind kind);
FmuKind toFmuKind(Kind kind);

}  // namespace twinmap::fmi
