#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "framework/base/json/json_fwd.hpp"
#include "framework/base/log/notice.hpp"
#include "framework/inference/inferrer.hpp"

namespace twinmap {

/// Whether the remedy of a status goes against that of another beside it, or is the same in other words.
/// Bounds are not to be widened where they are to exclude, nor twice.
bool isAdvisedElse(const std::string& status, const std::vector<std::string>& statuses);

/// A term that a model most likely lacks, and what it does to the parameters; ends in what to do.
std::string explainMissingTerm(const MissingTerm& missing, const std::vector<ParameterSpec>& parameters);

/// What could be missing all the same, below an "ok"; "" where nothing would matter.
std::string describeUnnoticed(const std::optional<ModelTest>& test,
                              const std::vector<ParameterSpec>& parameters);

/// Name -> number, of the first parameters.
Json nameValues(const Eigen::VectorXd& values, const std::vector<ParameterSpec>& parameters);

/// Adds the same to JSON: what terms the model lacks, or may lack unnoticed, and whether any was asked for.
void addModelTest(const std::optional<ModelTest>& test, const std::vector<ParameterSpec>& parameters,
                  Json& json);

/// The status with its numbers, then for each thing that is wrong a line that says what, and one that says
/// what to do.
std::string describeTrust(const InferredMeasurement& inferred, const std::vector<ParameterSpec>& parameters,
                          const std::vector<FeatureInfo>& features);

using LabelledMeasurements = std::vector<std::pair<std::string, const InferredMeasurement*>>;

/// What a status of a recording (listRecordingFaults) says of each recording that has it, of the first
/// four of many. Then what to do.
std::string explainFaults(const std::string& status, const LabelledMeasurements& recordings);

/// The lines below it. own: of statuses that have another text than that of one recording.
std::string explainStatuses(const InferredMeasurement& inferred, const Estimate& estimate,
                            const std::vector<ParameterSpec>& parameters,
                            const std::vector<FeatureInfo>& features,
                            const std::map<std::string, std::string>& own = {});

/// How far the map's estimate is from what the measurement allows, where it is estimator_limited; a line
/// each, or "".
std::string describeMapLimit(const InferredMeasurement& inferred,
                             const std::vector<ParameterSpec>& parameters);

/// A human-readable table: the status with its numbers, then a row per parameter; where the estimate is not
/// the map's, the map's follows.
std::string makeInferenceTable(const InferredMeasurement& inferred,
                               const std::vector<ParameterSpec>& parameters,
                               const std::vector<FeatureInfo>& features);

/// CSV: a row per measurement and parameter; `refined`, `posterior`: with the columns of these, as
/// MeasurementInference::refines() and samplesPosteriors() say.
std::string makeInferenceCsvHeader(bool refined, bool posterior);
std::string makeInferenceCsvRows(const InferredMeasurement& inferred,
                                 const std::vector<ParameterSpec>& parameters, bool posterior);

/// The same of an answer from one recording or several: the estimate that is believed, with its statuses,
/// and what is said beside. p_value: of the test that speaks for or against it.
std::string describeEstimate(const InferredMeasurement& inferred, const Estimate& estimate,
                             const std::vector<ParameterSpec>& parameters);
std::string makeAnswerCsvRows(const InferredMeasurement& inferred, const Estimate& estimate,
                              const std::string& p_value, const std::vector<ParameterSpec>& parameters,
                              bool posterior);
Json makeAnswerJson(const InferredMeasurement& inferred, const Estimate& estimate,
                    const std::vector<ParameterSpec>& parameters, const std::vector<FeatureInfo>& features);

/// One line of JSON, without a line end (docs/how-to/estimate-from-measurements.md).
std::string makeInferenceJson(const InferredMeasurement& inferred,
                              const std::vector<ParameterSpec>& parameters,
                              const std::vector<FeatureInfo>& features);
/// The same for a measurement that could not be used.
std::string makeErrorJson(const std::string& source, double start, const std::string& error);

/// CSV of the draws of posteriors, a row each: source, start, draw, weight, then all unknown parameters; the
/// row of names, and the rows of one measurement, none where its posterior is not reliable.
std::string makeDrawsCsvHeader(const std::vector<ParameterSpec>& unknown);
std::string makeDrawsCsvRows(const InferredMeasurement& inferred);

/// CSV of profile likelihoods, a row a value: source, start, parameter, value, log_likelihood_ratio, then all
/// unknown parameters there; likewise.
std::string makeProfileCsvHeader(const std::vector<ParameterSpec>& unknown);
std::string makeProfileCsvRows(const InferredMeasurement& inferred,
                               const std::vector<ParameterSpec>& unknown);

/// "the largest misfit is in y between 0.1 s and 0.4 s"; "" without a trust model.
std::string describeAnomaly(const Trust& trust, const std::vector<FeatureInfo>& features);

/// How a measurement was read and what of it was left out, a line each, which begins so.
std::string describeReading(const InferredMeasurement& inferred, const std::string& begin);

}  // namespace twinmap
