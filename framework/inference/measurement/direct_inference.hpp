#pragma once

#include "framework/inference/measurement/explained_recording.hpp"
#include "framework/inference/measurement/measurement_inference.hpp"

namespace twinmap {

/// Infers measurements from an experiment alone, without a run: the posterior of each by simulation
/// (samplePosterior).
class DirectInference final : public MeasurementInference {
 public:
  /// draws: of a round; profiles: whether each posterior has them too. The reader must outlive the object.
  /// Throws ExperimentError where the simulator cannot be made, a feature has no noise or the draws are fewer
  /// than kMinPosteriorDraws.
  explicit DirectInference(const MeasurementReader& reader, int draws = SimulatorPosteriorOptions{}.draws,
                           SimulatorRefiner::Model model = SimulatorRefiner::Model::kToBeChecked,
                           bool profiles = false);

  const MeasurementReader& getReader() const override { return *setup_.reader; }
  bool refines() const override { return false; }
  bool samplesPosteriors() const override { return false; }
  MissingCells getMissingCells() const override { return MissingCells::kKeep; }

  /// Where samples would be interpolated, features are taken at the times of the table
  /// and the excitation is that of the table, where it has one (MeasurementReader::follow). Samples that the
  /// table lacks are left out of the likelihood (MeasurementReader::readAvailableFeatures); standard
  /// deviations that it states go before the experiment's.
  InferredMeasurement infer(const Table& table, std::optional<double> start,
                            const Eigen::VectorXd& known) override;
  /// Cost: that of samplePosterior().
  InferredMeasurement infer(const Eigen::VectorXd& features, const Eigen::VectorXd& known) override;

  /// twinmap::tryNuisance() of its experiment.
  void tryNuisance(const AvailableFeatures& found, const Eigen::VectorXd& known,
                   InferredMeasurement& inferred) const;

 private:
  /// What infers with the times and the excitation of a table (MeasurementReader::follow); null where they
  /// are the experiment's.
  const RecordingSetup* follow(const Table& table, std::optional<double> start);
  /// Adds what the experiment says.
  void describe(InferredMeasurement& inferred) const;

  const RecordingSetup setup_;
  SimulatorPosteriorOptions options_;
  std::shared_ptr<const DerivedQuantities> quantities_;  // none where nothing is derived
  std::shared_ptr<const StatedPrior> prior_;             // null where all is uniform
  std::vector<std::string> unused_;                      // parameters
  std::optional<RecordingSetup> followed_;               // of the last table that was followed
};

}  // namespace twinmap
