#include "framework/inference/measurement_inference.hpp"

namespace twinmap {

InferredMeasurement MeasurementInference::infer(const Table& table, std::optional<double> start,
                                                const Eigen::VectorXd& known) {
  InferredMeasurement inferred = infer(getReader().readFeatures(table, start), known);
  inferred.source = table.source;
  inferred.start = getReader().getStart(start);
  return inferred;
}

}  // namespace twinmap
