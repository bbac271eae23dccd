#pragma once

#include "framework/cli/commands/commands.hpp"
#include "framework/inference/measurement/measurement_inference.hpp"

namespace twinmap::cli {

/// As --json or --csv ask for it, or as a table.
void printInferred(const InferArguments& arguments, const InferredMeasurement& inferred,
                   const MeasurementReader& reader, const MeasurementInference& session);

/// The values of --set, for all inputs of the experiment.
Eigen::VectorXd readKnown(const InferArguments& arguments, const MeasurementReader& reader);

/// Recordings by the estimator that a run trained on all trials together. False where there is none, or it
/// needs more than these recordings have.
bool inferTrialsByRun(const InferArguments& arguments);

}  // namespace twinmap::cli
