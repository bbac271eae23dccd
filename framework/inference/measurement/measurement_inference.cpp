#include "framework/inference/measurement/measurement_inference.hpp"

namespace twinmap {

InferredMeasurement MeasurementInference::infer(const Table& table, std::optional<double> start,
                                                const Eigen::VectorXd& known) {
  const MeasurementReader& reader = getReader();
  reader.requireExcitation(table, start);
  const Eigen::VectorXd response = reader.readResponse(table, start);
  reader.warnOfInterpolation(table, start);
  return inferResponse(table, start, response, extractFeatures(reader.getExtractor(), response, table.source),
                       known);
}

InferredMeasurement MeasurementInference::inferResponse(const Table& table, std::optional<double> start,
                                                        const Eigen::VectorXd& response,
                                                        const Eigen::VectorXd& features,
                                                        const Eigen::VectorXd& known) {
  InferredMeasurement inferred = infer(features, known);
  if (response.array().isFinite().any()) {  // not of features that were measured themselves
    inferred.fault = findFault(response, known, inferred);
  }
  inferred.source = table.source;
  inferred.start = getReader().getStart(table, start);
  return inferred;
}

std::string MeasurementInference::findFault(const Eigen::VectorXd&, const Eigen::VectorXd&,
                                            const InferredMeasurement&) {
  return "";
}

}  // namespace twinmap
