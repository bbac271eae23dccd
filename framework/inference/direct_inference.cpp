#include "framework/inference/direct_inference.hpp"

#include <limits>

#include "framework/base/text/source_location.hpp"
#include "framework/inference/derived_values.hpp"
#include "framework/inference/measurement/measurement_faults.hpp"

namespace twinmap {

namespace {

/// Whether nothing speaks against the stated noise: neither a test of what is too much, nor a sum of squares
/// that is too small, in one of a thousand good measurements.
bool isPlausible(const SimulatorFit& fit) {
  constexpr double kTooSmallLevel = 1e-3;
  return fit.test.calcPValue() >= kMismatchLevel && 1.0 - fit.test.chi_square_p >= kTooSmallLevel;
}

}  // namespace

DirectInference::DirectInference(const MeasurementReader& reader, int draws)
    : reader_(reader),
      simulator_(reader.getExperiment(), reader.getLayout(), SimulatorRefiner::Model::kToBeChecked),
      options_(makePosteriorOptions(reader.getExperiment(), draws)),
      quantities_(makeDerivedQuantities(reader.getExperiment())) {
  simulator_.requireNoise();
}

InferredMeasurement DirectInference::infer(const Table& table, std::optional<double> start,
                                           const Eigen::VectorXd& known) {
  const AvailableFeatures found = reader_.readAvailableFeatures(table, start);
  InferredMeasurement inferred = infer(found.features, known);
  inferred.source = table.source;
  inferred.start = reader_.getStart(start);
  inferred.left_out = found.remarks;
  inferred.fault = findFault(found, known, *inferred.posterior);
  return inferred;
}

std::string DirectInference::findFault(const AvailableFeatures& found, const Eigen::VectorXd& known,
                                       const PosteriorEstimate& posterior) const {
  const SimulatorFit& fit = *posterior.fit;
  if (!fit.isSimulated() || isPlausible(fit)) {
    return "";
  }
  const auto calcMisfit = [&](const Eigen::VectorXd& corrected) {
    const Eigen::VectorXd features = simulator_.getExtractor().extract(corrected);
    return features.array().isFinite().count() == static_cast<Eigen::Index>(found.available.size())
               ? simulator_.findLeastChiSquare(features, known)
               : std::numeric_limits<double>::infinity();
  };
  return explainByFault(found.response, reader_.getLayout(), fit.chi_square, fit.residual.size(), calcMisfit);
}

PosteriorEstimate DirectInference::sample(const Eigen::VectorXd& features,
                                          const Eigen::VectorXd& known) const {
  PosteriorEstimate plain = simulator_.samplePosterior(features, known, {}, options_);
  if (!plain.fit->isSimulated() || isPlausible(*plain.fit)) {
    return plain;
  }
  for (const LossKind loss : {LossKind::kOutliers, LossKind::kUnknownNoise}) {
    PosteriorEstimate other = simulator_.samplePosterior(features, known, {}, options_, loss);
    constexpr double kMaxOutliers = 0.05;  // of the samples: more are no longer exceptions
    const auto outliers = static_cast<double>(other.fit->outliers.size());
    if (other.isReliable() && isPlausible(*other.fit) &&
        outliers <= kMaxOutliers * static_cast<double>(plain.fit->residual.size())) {
      return other;
    }
  }
  return plain;
}

InferredMeasurement DirectInference::infer(const Eigen::VectorXd& features, const Eigen::VectorXd& known) {
  InferredMeasurement inferred;
  inferred.posterior = sample(features, known);
  inferred.ridges = simulator_.findRidges(inferred.posterior->estimate.draws, known);
  inferred.quantities = quantities_;
  return inferred;
}

}  // namespace twinmap
