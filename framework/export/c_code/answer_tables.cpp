#include <fmt/core.h>

#include "framework/export/c_code/c_model_tables.hpp"
#include "kernels/linalg/packed_lower.hpp"

namespace twinmap {

using Eigen::MatrixXd;

void addTrust(const TrustModel& trust, CTables& tables, CSizes& sizes) {
  const ResidualSpace& space = trust.space;
  const bool diagonal = space.whitener.cols() == 1;
  tables.addWide("whitener", flattenColumns(space.whitener),
                 diagonal ? "1 / noise standard deviation of each feature."
                          : "Root of the inverse covariance of the features' noise, feature by feature.");
  tables.addReal("score_directions", flattenColumns(space.directions),
                 "Directions of the scores among the whitened features, score by score.");
  if (space.unmodelled.cols() > 0) {
    tables.addReal("unmodelled_directions", flattenColumns(space.unmodelled),
                   "Directions of what else moves with the parameters, one after another.");
    tables.addWide("unmodelled_stddev", space.unmodelled_stddev, "Its standard deviations over the bounds.");
  }
  std::vector<int> runs;
  for (const ResidualRun& run : trust.runs) {
    runs.push_back(static_cast<int>(run.first));
    runs.push_back(static_cast<int>(run.count));
  }
  tables.addInts("residual_runs", runs, "Residuals that belong together: the first of a run, how many.");
  tables.addReal("chi_square_reference", trust.chi_square.sorted,
                 "Chi-squares of simulated measurements, sorted.");
  tables.addReal("anomaly_reference", trust.anomaly.sorted,
                 "Anomaly scores of simulated measurements, sorted.");
  const linalg::PackedSamples cloud(trust.cloud.inputs);
  tables.addReal(
      "cloud_inputs", cloud.getValues(),
      fmt::format("Training inputs of the map over cloud_scale, in chunks of {}, number by number.",
                  linalg::PackedSamples::kChunk));
  tables.addWide("cloud_scale", trust.cloud.scale, "Standard deviations of the map's training inputs.");
  tables.addNumber("cloud_reach", trust.cloud.reach,
                   "Largest distance of a simulated measurement to its nearest training input.");
  tables.addNumber("trust_level", trust.level, "Share of false alarms of model_mismatch.");
  sizes.push_back({"RESIDUALS", static_cast<long>(space.directions.rows()), "residuals of the features"});
  sizes.push_back(
      {"UNMODELLED", static_cast<long>(space.unmodelled.cols()), "directions that no score tells"});
  sizes.push_back({"DIAGONAL_WHITENER", diagonal ? 1 : 0, "1: the features' noise is independent"});
  sizes.push_back({"RUNS", static_cast<long>(trust.runs.size()), "stretches of residuals"});
  sizes.push_back({"REFERENCES", static_cast<long>(trust.chi_square.sorted.size()), "reference chi-squares"});
  sizes.push_back(
      {"ANOMALY_REFERENCES", static_cast<long>(trust.anomaly.sorted.size()), "reference anomalies"});
  sizes.push_back({"CLOUD_COUNT", static_cast<long>(trust.cloud.inputs.cols()), "training inputs"});
  sizes.push_back({"CLOUD", static_cast<long>(cloud.paddedSize()), "the same in whole chunks"});
}

void addResult(const ExportedModel& model, const std::string& prefix, CTables& tables, CSizes& sizes) {
  std::vector<std::string> names, units;
  for (const ParameterSpec& parameter : model.experiment.model.parameters) {
    names.push_back(parameter.name.text);
    units.push_back(parameter.unit);
  }
  tables.addStrings(prefix + "_parameter_names", names, "The parameters, in the order of the results.");
  tables.addStrings(prefix + "_parameter_units", units, "Their units.");
  if (model.takesSignals()) {
    tables.addStrings(prefix + "_signal_names", model.layout.output_names, "The measured signals.");
    tables.addStrings(prefix + "_signal_units", model.layout.output_units, "Their units.");
  }
  if (!model.online.map->givesCorrelations()) {
    tables.addWide("parameter_correlation", flattenColumns(model.getCorrelation()),
                   "Correlation of the errors of a sample's parameters.");
  }
  tables.addWide("interval_factor", model.getIntervalFactors(),
                 "Half widths of 95 % intervals in standard deviations.");
  const bool calibrated =
      model.online.map->isCalibrated() && (!model.online.trust || !model.online.trust->coverage.isShort());
  sizes.push_back({"UNCALIBRATED", calibrated ? 0 : 1, "1: the map is known to misjudge its own errors"});
}

}  // namespace twinmap
