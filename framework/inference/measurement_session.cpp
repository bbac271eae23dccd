#include "framework/inference/measurement_session.hpp"

#include "framework/inference/answer.hpp"

namespace twinmap {

MeasurementSession::MeasurementSession(const Inferrer& inferrer, std::optional<bool> refine)
    : inferrer_(inferrer), workspace_(inferrer) {
  if (refine.value_or(inferrer.getExperiment().refine != RefineMode::kNever)) {
    refiner_.emplace(inferrer.getExperiment(), inferrer.getLayout());
    if (!refine && !refiner_->isWanted()) {
      refiner_.reset();
    }
  }
}

double MeasurementSession::getStart(std::optional<double> start) const {
  return start.value_or(inferrer_.getExperiment().measurement.start);
}

InferredMeasurement MeasurementSession::infer(const Table& table, std::optional<double> start,
                                              const Eigen::VectorXd& known) {
  inferrer_.requireExcitation(table, start);
  InferredMeasurement inferred =
      infer(inferrer_.extractFeatures(inferrer_.readResponse(table, start), table.source), known);
  inferred.source = table.source;
  inferred.start = getStart(start);
  return inferred;
}

InferredMeasurement MeasurementSession::infer(const Eigen::VectorXd& features, const Eigen::VectorXd& known) {
  InferredMeasurement inferred = inferrer_.infer(features, known, workspace_);
  if (refiner_) {
    const std::optional<TrustModel>& trust = inferrer_.getTrustModel();
    refiner_->refineAndJudge(features, known, trust ? &*trust : nullptr, inferred);
  }
  return inferred;
}

Eigen::MatrixXd calcAnswerCovariance(const Inferrer& inferrer, const InferredMeasurement& inferred) {
  const Eigen::VectorXd stddev = chooseAnswer(inferred).stddev;
  if (inferred.refined && inferred.refined->isAccepted()) {
    const Eigen::MatrixXd covariance =
        inferred.refined->covariance.topLeftCorner(stddev.size(), stddev.size());
    return 0.5 * (covariance + covariance.transpose());  // an inverse is symmetric to rounding only
  }
  return inferrer.getMap().getResidualCorrelation().cwiseProduct(stddev * stddev.transpose());
}

}  // namespace twinmap
