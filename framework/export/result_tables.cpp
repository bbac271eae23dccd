#include "framework/export/c_model_tables.hpp"

namespace twinmap {

void addResult(const ExportedModel& model, const std::string& prefix, CTables& tables, CSizes& sizes) {
  const SurrogateValidation* validation = model.findValidation();
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
  if (model.findNetwork() == nullptr) {
    tables.addWide("parameter_correlation", flattenColumns(model.getCorrelation()),
                   "Correlation of the errors of a sample's parameters.");
  }
  tables.addWide("interval_factor", model.getIntervalFactors(),
                 "Half widths of 95 % intervals in standard deviations.");
  const bool calibrated = validation == nullptr || validation->status == SurrogateStatus::kOk;
  sizes.push_back({"UNCALIBRATED", calibrated ? 0 : 1, "1: the map is known to misjudge its own errors"});
}

}  // namespace twinmap
