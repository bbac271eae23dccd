#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/estimation/posterior/simulator_posterior.hpp"
#include "framework/inference/inferrer.hpp"
#include "framework/inference/segments/segment_experiment.hpp"

namespace twinmap {

/// Infers a machine from recordings that are cut into short segments (multiple shooting): each is simulated
/// from a start of its own with the excitation that the recording has, and all share the parameters. For
/// machines whose motion cannot be predicted over a whole recording: unstable ones, held by a controller that
/// the file does not know, and chaotic ones. One thread.
class SegmentInference {
 public:
  /// Of a round: a thousand segments make a posterior narrow and normal, whose standard deviation is then
  /// right to 2 %.
  static constexpr int kDefaultDraws = 2048;

  /// experiment: without its measured signals, which come from each recording. length: of a segment, s.
  /// known: q. draws: of a round.
  SegmentInference(ExperimentSpec experiment, double length, Eigen::VectorXd known, int draws);

  const ExperimentSpec& getExperiment() const { return experiment_; }
  /// The columns that a recording must or may have, for readTable().
  std::vector<std::string> listColumns() const;

  /// From `start` (default: that of the experiment's measurement) to the recording's end. The posterior is
  /// sampled as that of any measurement (samplePosterior), each segment's initial state eliminated
  /// (SegmentedMisfit). Where the stated noise does not explain it, spikes and other noise are supposed
  /// (supposeNoise). Throws ExperimentError (makeSegmentGrid) and MeasurementError. Cost: some 1000
  /// simulations of the recording with derivatives, however many segments it has.
  InferredMeasurement infer(const Table& table, std::optional<double> start) const;

 private:
  const ExperimentSpec experiment_;
  const double length_;
  const Eigen::VectorXd known_;
  const SimulatorPosteriorOptions options_;
};

}  // namespace twinmap
