#include <algorithm>

#include "framework/report/html.hpp"
#include "framework/report/sections/samples_table.hpp"
#include "framework/report/sections/sections.hpp"
#include "framework/report/sections/selected_responses.hpp"

namespace twinmap {
namespace {

/// The true parameters, which hovering over a sample shows.
std::vector<Texts> listParameters(const std::vector<ParameterSpec>& parameters) {
  std::vector<Texts> listed;
  for (const ParameterSpec& parameter : parameters) {
    listed.push_back({{"each", parameter.name.text}, {"each_label", makeLabel(parameter)}});
  }
  return listed;
}

/// True against inferred, or true against the error.
Panel makeInferredPanel(const RunFolder& run, std::size_t p, bool of_error) {
  const std::vector<ParameterSpec>& parameters = run.experiment.model.parameters;
  const ParameterSpec& parameter = parameters[p];
  const std::string& name = parameter.name.text;
  const Bounds& bounds = parameter.bounds;
  const std::string title = (of_error ? "error of " : "estimated ") + makeLabel(parameter);
  const Texts texts{{"name", name},
                    {"label", makeLabel(parameter)},
                    {"title", title},
                    {"column", of_error ? getErrorColumn(name) : getInferredColumn(name)},
                    {"color", getColor(p)}};
  return {"estimates",
          texts,
          {{"lower", bounds.lower},
           {"upper", bounds.upper},
           {"line_start", of_error ? 0.0 : bounds.lower},
           {"line_end", of_error ? 0.0 : bounds.upper},
           {"parameters", listParameters(parameters)}}};
}

Figure makeFigure(const RunFolder& run, bool of_error) {
  const std::size_t count = run.experiment.model.parameters.size();
  Figure figure;
  figure.name = of_error ? "errors" : "inferred";
  figure.table = "samples";
  figure.title = of_error ? "Error against the true value" : "Estimated against true";
  figure.help = of_error ? "Each bar spans \u00b12 sd around the error (estimated \u2212 true); where they "
                           "are calibrated, about 95 % of the bars cross the dashed line at 0."
                         : describeDrawnSamples(run) +
                               "Points on the dashed line are exact; bars span \u00b12 sd. Drag over points, "
                               "or press one, to highlight the same samples in every figure.";
  figure.columns = count > 1 ? static_cast<int>(std::min<std::size_t>(count, 4)) : 0;
  figure.columns = count == 4 ? 2 : std::min(figure.columns, 3);
  for (std::size_t p = 0; p < count; ++p) {
    figure.panels.push_back(makeInferredPanel(run, p, of_error));
  }
  return figure;
}

constexpr const char* kComponents = "components";

/// A row for each test sample that is drawn and each of its answers, but for the unlikeliest.
DataTable makeComponentsTable(const RunFolder& run) {
  constexpr double kMin = 0.02;  // cannot be seen below
  const std::vector<ParameterSpec>& parameters = run.experiment.model.parameters;
  std::vector<double> samples, weights;
  std::vector<std::vector<double>> truth(parameters.size()), mean(truth), stddev(truth);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const ParameterPredictions found = collectPredictions(run, parameters[p].name.text);
    for (std::size_t i = 0; i < std::min(run.mixtures.size(), kMaxDrawnSamples); ++i) {
      const Mixture& mixture = run.mixtures[i];
      for (Eigen::Index c = 0; c < mixture.countComponents(); ++c) {
        if (mixture.weights[c] < kMin) {
          continue;
        }
        if (p == 0) {
          samples.push_back(found.samples[i]);
          weights.push_back(mixture.weights[c]);
        }
        truth[p].push_back(found.truth[i]);
        mean[p].push_back(mixture.means(static_cast<Eigen::Index>(p), c));
        stddev[p].push_back(mixture.stddevs(static_cast<Eigen::Index>(p), c));
      }
    }
  }
  DataTable table;
  table.add("sample", std::move(samples));
  table.add("weight", std::move(weights));
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const std::string& name = parameters[p].name.text;
    table.add(getTrueColumn(name), std::move(truth[p]));
    table.add("mean_" + name, std::move(mean[p]));
    table.add(getStddevColumn(name), std::move(stddev[p]));
  }
  return table;
}

/// All answers of mixtures against the truth.
Figure makeComponentsFigure(const RunFolder& run) {
  const std::vector<ParameterSpec>& parameters = run.experiment.model.parameters;
  Figure figure;
  figure.name = kComponents;
  figure.table = kComponents;
  figure.title = "Estimates against true";
  figure.help = describeDrawnSamples(run) +
                "Each sample has as many estimates as its mixture has components, the darker the likelier; "
                "bars span \u00b12 sd. Where several fit, one of them lies on the dashed line.";
  figure.columns = static_cast<int>(std::min<std::size_t>(parameters.size(), 3));
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    figure.panels.push_back(
        {kComponents,
         {{"name", parameters[p].name.text}, {"label", makeLabel(parameters[p])}, {"color", getColor(p)}},
         {{"lower", parameters[p].bounds.lower}, {"upper", parameters[p].bounds.upper}}});
  }
  return figure;
}

}  // namespace

void addInferred(const RunFolder& run, Page& page) {
  if (run.predictions.empty()) {
    return;
  }
  Section section{"inferred", "Estimated against true", "", {}};
  if (run.mixtures.empty()) {
    addFigure(makeFigure(run, false), section);
    addFigure(makeFigure(run, true), section);
  } else {
    page.tables[kComponents] = makeComponentsTable(run);
    addFigure(makeComponentsFigure(run), section);
  }
  addSelectedResponses(run, section, page);
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
