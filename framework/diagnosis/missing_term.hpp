#pragma once

#include <optional>

#include "framework/diagnosis/problem/recorded_problem.hpp"
#include "framework/inference/inferrer.hpp"
#include "framework/inference/joint/joint_inference.hpp"

namespace twinmap {

/// The point of the unknown parameters (u) that explains a measurement best, as far as was found; else the
/// middle of their box.
Eigen::VectorXd findExplanation(const InferredMeasurement& inferred,
                                const std::vector<ParameterSpec>& unknown);

/// What a measurement that was inferred says of terms that the model lacks, of those that diagnose() knows;
/// those with states are asked where the residual is suspicious. Sets inferred.model_test. Of a misfit or a
/// nuisance of the recording that is the first term that diagnose() would name. Any other term has evidence
/// (kTiedEvidence), stands out of what remains with it, and moves a parameter by more than its standard
/// deviation. Nothing is asked of a model that is not a system simulated in time. Nor is it where no
/// simulation is known that explains the measurement, but for a misfit. Cost: one simulation with derivatives
/// along all candidates, and fits with the three best where one of them stands out, some 50 simulations with
/// derivatives.
void testModel(const ExperimentSpec& experiment, const RecordedFeatures& recording,
               InferredMeasurement& inferred);

/// The same of a window of a table, as `reader` infers it at `known` inputs. Left out are a reduced response,
/// a measurement that a fault explains, and a table that is not a recording of the model. Returns the
/// recording for a diagnosis, after a misfit, a nuisance, or a term that is missing.
std::optional<RecordedFeatures> testModel(const MeasurementReader& reader, const Table& table,
                                          std::optional<double> start, const Eigen::VectorXd& known,
                                          InferredMeasurement& inferred);

/// The same of recordings together, of an experiment or of the trials that it combines. Each has the size of
/// noise and the offsets that were found of it; those with a nuisance are left out.
void testModel(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
               JointInference& inferred);
/// The same, which are read anew. Throws as JointInferrer does.
void testModel(const std::string& experiment_file, const std::vector<Recording>& recordings,
               const std::vector<std::string>& known, JointInference& inferred);

}  // namespace twinmap
