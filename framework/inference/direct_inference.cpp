#include "framework/inference/direct_inference.hpp"

#include "framework/base/text/source_location.hpp"
#include "framework/inference/derived_values.hpp"
#include "framework/inference/measurement/measurement_faults.hpp"

namespace twinmap {

DirectInference::DirectInference(const MeasurementReader& reader, int draws, SimulatorRefiner::Model model)
    : reader_(reader),
      simulator_(reader.getExperiment(), reader.getLayout(), model),
      options_(makePosteriorOptions(reader.getExperiment(), draws)),
      quantities_(makeDerivedQuantities(reader.getExperiment())),
      prior_(findStatedPrior(reader.getExperiment().model)) {
  simulator_.requireNoise();
}

InferredMeasurement DirectInference::infer(const Table& table, std::optional<double> start,
                                           const Eigen::VectorXd& known) {
  return infer(table, start, reader_.readAvailableFeatures(table, start), known);
}

InferredMeasurement DirectInference::infer(const Table& table, std::optional<double> start,
                                           const AvailableFeatures& found, const Eigen::VectorXd& known) {
  std::optional<SimulatorRefiner> own;  // with the noise that the measurement states
  if (found.stated.isGiven()) {
    own.emplace(reader_.getExperiment(), reader_.getLayout(), SimulatorRefiner::Model::kTrusted,
                found.stated);
  }
  const SimulatorRefiner& simulator = own ? *own : simulator_;
  InferredMeasurement inferred = infer(simulator, found.features, known, found.clipped);
  inferred.source = table.source;
  inferred.start = reader_.getStart(table, start);
  inferred.left_out = found.remarks;
  inferred.fault = explainMisfit(simulator, found, known, *inferred.posterior);
  return inferred;
}

std::string DirectInference::explainMisfit(const SimulatorRefiner& simulator, const AvailableFeatures& found,
                                           const Eigen::VectorXd& known,
                                           const PosteriorEstimate& posterior) const {
  const SimulatorFit& fit = *posterior.fit;
  if (!fit.isSimulated() || fit.isPlausible()) {
    return "";
  }
  const auto calcMisfit = [&](const Eigen::VectorXd& corrected) {
    return simulator.findLeastChiSquare(simulator.getExtractor().extract(corrected), known,
                                        static_cast<Eigen::Index>(found.available.size()));
  };
  return explainByFault(found.response, reader_.getLayout(), fit.chi_square, fit.residual.size(), calcMisfit);
}

InferredMeasurement DirectInference::infer(const Eigen::VectorXd& features, const Eigen::VectorXd& known) {
  return infer(simulator_, features, known, {});
}

InferredMeasurement DirectInference::infer(const SimulatorRefiner& simulator, const Eigen::VectorXd& features,
                                           const Eigen::VectorXd& known,
                                           const std::vector<ClippedSample>& clipped) const {
  InferredMeasurement inferred;
  const std::string failure = simulator.findFailure(known);
  if (!failure.empty()) {
    inferred.posterior = simulator.makeFailed(features, known, failure);
    inferred.quantities = quantities_;
    return inferred;
  }
  inferred.posterior =
      simulator.samplePosterior(features, known, simulator.describeNoise(clipped), {}, options_);
  inferred.ridges = simulator.findRidges(inferred.posterior->estimate.draws, known);
  inferred.quantities = quantities_;
  inferred.prior = prior_;
  return inferred;
}

}  // namespace twinmap
