#include "framework/cli/commands/measurements/infer_estimate.hpp"

#include "framework/cli/commands/measurements/infer_options.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/diagnosis/missing_term.hpp"
#include "framework/inference/known_value.hpp"
#include "framework/inference/measurement/inference_source.hpp"
#include "framework/inference/text/inference_text.hpp"

namespace twinmap::cli {

robots::RobotEstimate inferEstimate(const std::string& run, const std::string& measurement,
                                    std::optional<double> start, const std::vector<std::string>& known) {
  const InferenceSource source(run);
  const ModelSpec& model = source.getExperiment().model;
  const std::unique_ptr<MeasurementInference> session =
      source.makeSession(makeSessionOptions(InferArguments{}));
  const Eigen::VectorXd inputs = collectKnown(model.inputs, parseKnownValues(known));
  const Table table = readTable(measurement, source.getReader().listColumns(), session->getMissingCells());
  InferredMeasurement inferred = session->infer(table, start, inputs);
  testModel(source.getReader(), table, start, inputs, inferred);
  return robots::readEstimate(
      makeInferenceJson(inferred, model.parameters, source.getReader().getExtractor().getInfos()),
      measurement);
}

}  // namespace twinmap::cli
