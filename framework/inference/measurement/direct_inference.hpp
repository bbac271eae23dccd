#pragma once

#include "framework/inference/measurement/measurement_inference.hpp"
#include "framework/inference/refiner.hpp"

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

  ~DirectInference() override;

  const MeasurementReader& getReader() const override { return reader_; }
  bool refines() const override { return false; }
  bool samplesPosteriors() const override { return false; }
  MissingCells getMissingCells() const override { return MissingCells::kKeep; }

  /// Where samples would be interpolated, features are taken at the times of the table
  /// and the excitation is that of the table, where it has one (MeasurementReader::follow). Samples that the
  /// table lacks are left out of the likelihood (MeasurementReader::readAvailableFeatures); standard
  /// deviations that it states go before the experiment's.
  InferredMeasurement infer(const Table& table, std::optional<double> start,
                            const Eigen::VectorXd& known) override;
  /// From what the reader found in the table.
  InferredMeasurement infer(const Table& table, std::optional<double> start, const AvailableFeatures& found,
                            const Eigen::VectorXd& known);
  /// Cost: that of samplePosterior().
  InferredMeasurement infer(const Eigen::VectorXd& features, const Eigen::VectorXd& known) override;

  /// Whether faults of the recorder's clock explain a model_mismatch (findClockFaults); then they are
  /// what was inferred. Its posterior is the simulator's.
  bool tryClock(const AvailableFeatures& found, const Eigen::VectorXd& known,
                InferredMeasurement& inferred) const;

 private:
  /// What speaks against the model, where it explains nothing and no fault of the recording does.
  std::vector<std::string> listAgainst(const AvailableFeatures& found, const Eigen::VectorXd& known,
                                       const InferredMeasurement& inferred) const;
  /// Whether masses of a thousandth, given in g, explain a misfit; "" where not. Cost: that of
  /// findLeastChiSquare() for each body whose mass is a number, and once more for all of several.
  std::string explainByGrams(const AvailableFeatures& found, const Eigen::VectorXd& known,
                             const SimulatorFit& fit) const;
  struct LikeRecording;

  /// What infers with the times and the excitation of a table (MeasurementReader::follow); null where they
  /// are the experiment's.
  LikeRecording* follow(const Table& table, std::optional<double> start);

  InferredMeasurement infer(const SimulatorRefiner& simulator, const Eigen::VectorXd& features,
                            const Eigen::VectorXd& known, const std::vector<ClippedSample>& clipped) const;

  /// Where a measurement is not explained: the same without its spikes (findSpikedFeatures), if that explains
  /// it or leaves less than half of the misfit. They are then what is not noise, beside whatever else is
  /// wrong.
  void tryWithoutSpikes(const SimulatorRefiner& simulator, AvailableFeatures& found,
                        const Eigen::VectorXd& known, InferredMeasurement& inferred) const;

  /// Where a measurement is not explained: the same without what every other sample is off by
  /// (findAlternation), if that explains it.
  void tryWithoutAlternation(const SimulatorRefiner& simulator, AvailableFeatures& found,
                             const Eigen::VectorXd& known, InferredMeasurement& inferred) const;

  /// The simple fault of the recording that explains a gross misfit, or "".
  std::string explainMisfit(const SimulatorRefiner& simulator, const AvailableFeatures& found,
                            const Eigen::VectorXd& known, const PosteriorEstimate& posterior) const;

  const MeasurementReader& reader_;
  const SimulatorRefiner simulator_;
  SimulatorPosteriorOptions options_;
  std::shared_ptr<const DerivedQuantities> quantities_;  // none where nothing is derived
  std::shared_ptr<const StatedPrior> prior_;             // null where all is uniform
  std::vector<std::string> unused_;                      // parameters
  std::unique_ptr<LikeRecording> followed_;              // of the last table that was followed
};

}  // namespace twinmap
