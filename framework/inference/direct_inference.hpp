#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/data/noise/feature_noise.hpp"
#include "framework/estimation/posterior/residual_test.hpp"
#include "framework/estimation/posterior/simulator_posterior.hpp"
#include "framework/inference/measurement_reader.hpp"

namespace twinmap {

/// What a measurement says about the machine, by simulation alone.
struct DirectInference {
  std::string source;  ///< the file
  double start = 0.0;  ///< time in the file that is 0 of the model, s
  SimulatorPosterior posterior;
  ResidualTest test;  ///< of the residual at the best point; where anything could be simulated
};

/// Names of all that is to be said against it, the most severe first: "not_simulated", "model_mismatch"
/// (below kMismatchLevel), "unreliable" (the draws do not stand for the posterior), "multimodal",
/// "uninformative" (a parameter's sd is above 0.9 of that of its bounds); {"ok"} where nothing is.
std::vector<std::string> listStatuses(const DirectInference& inferred,
                                      const std::vector<ParameterSpec>& parameters);

/// Infers measurements from an experiment alone, without a run: samplePosterior() for each. For one thread.
class DirectInferrer {
 public:
  /// draws: of a round. Throws ExperimentError where the simulator cannot be made or a feature has no noise.
  explicit DirectInferrer(ExperimentSpec experiment, int draws = SimulatorPosteriorOptions{}.draws);

  const MeasurementReader& getReader() const { return reader_; }
  const std::vector<ParameterSpec>& getParameters() const { return reader_.getExperiment().model.parameters; }

  const std::vector<ParameterSpec>& getUnknown() const { return model_->getUnknown(); }
  /// A measurement as a part of a joint problem: all but which of its unknown parameters these are. It refers
  /// to this object, which simulates for it. Throws MeasurementError for a table that cannot be used.
  MeasuredTrial prepare(const Table& table, std::optional<double> start, const Eigen::VectorXd& known);

  /// known: the inputs of the set-up (q). Throws MeasurementError for a table that cannot be used. Cost: that
  /// of samplePosterior().
  DirectInference infer(const Table& table, std::optional<double> start, const Eigen::VectorXd& known);

 private:
  MeasurementReader reader_;
  std::unique_ptr<Simulator> prototype_, simulator_;  // a clone of the first, which simulates
  FeatureNoise noise_;
  std::unique_ptr<const RefinementModel> model_;
  SimulatorPosteriorOptions options_;
};

/// A table for people: the status with its numbers, a row per parameter, how the posterior was found.
std::string makeDirectTable(const DirectInference& inferred, const std::vector<ParameterSpec>& parameters,
                            const std::vector<FeatureInfo>& features);

/// CSV: a row per measurement and parameter, in the columns of makeInferenceCsvHeader().
std::string makeDirectCsvRows(const DirectInference& inferred, const std::vector<ParameterSpec>& parameters);

/// One line of JSON, without a line end (docs/how-to/estimate-from-measurements.md).
std::string makeDirectJson(const DirectInference& inferred, const std::vector<ParameterSpec>& parameters);

/// CSV of the draws, a row each: source, start, draw, weight, then all unknown parameters; the row of names,
/// and the rows of one measurement, none where its posterior is not reliable.
std::string makeDirectDrawsHeader(const std::vector<ParameterSpec>& unknown);
std::string makeDirectDrawsRows(const DirectInference& inferred);

}  // namespace twinmap
