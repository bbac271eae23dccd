#include <algorithm>

#include "framework/report/estimate_panel.hpp"
#include "framework/report/sections/samples_table.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

/// The test sample whose error is the median one, as responses.csv has it; the first where that is absent.
double findMedianSample(const RunFolder& run, const ParameterPredictions& predictions) {
  for (std::size_t row = 0; row < run.responses.rows.size(); ++row) {
    if (run.responses.getText(row, "case") == "median") {
      return run.responses.getNumber(row, "sample");
    }
  }
  return predictions.samples.front();
}

ShownEstimate makeShown(const ParameterPredictions& predictions, double sample) {
  constexpr double kNormal95 = 1.959963984540054;
  const auto found = std::find(predictions.samples.begin(), predictions.samples.end(), sample);
  const auto i = found == predictions.samples.end() ? 0 : found - predictions.samples.begin();
  const auto at = static_cast<std::size_t>(i);
  const double mean = predictions.inferred[at], stddev = predictions.stddev[at];
  return {mean, stddev, mean - kNormal95 * stddev, mean + kNormal95 * stddev, predictions.truth[at]};
}

}  // namespace

void addParameters(const RunFolder& run, Page& page) {
  const std::vector<ParameterSpec>& parameters = run.experiment.model.parameters;
  if (run.predictions.empty()) {
    return;
  }
  Section section{"parameters", "Parameters", "", {}};
  std::vector<ShownEstimate> shown;
  double sample = 0.0;
  for (const ParameterSpec& parameter : parameters) {
    const ParameterPredictions predictions = collectPredictions(run, parameter.name.text);
    sample = findMedianSample(run, predictions);
    shown.push_back(makeShown(predictions, sample));
  }
  if (run.mixtures.empty()) {
    addFigure(makeEstimateFigure("intervals",
                                 "A typical estimate within its bounds, test sample " +
                                     std::to_string(static_cast<int>(sample)),
                                 parameters, shown, page),
              section);
  }
  addCorrelations(run, section, page);
  if (!section.figures.empty()) {
    page.sections.push_back(std::move(section));
  }
}

}  // namespace twinmap
