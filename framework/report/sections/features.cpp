#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/experiment/check/known_names.hpp"
#include "framework/report/html.hpp"
#include "framework/report/sections/sections.hpp"
#include "framework/store/trained_file.hpp"

namespace twinmap {
namespace {

/// What a feature is, as far as its row of features.csv or its name "y(0.05 s)" says.
struct FeaturePlace {
  std::string name, output;
  double time = NAN;
};

FeaturePlace parseFeature(const std::string& name) {
  const std::size_t open = name.find('('), space = name.find(" s)");
  FeaturePlace place{name, name.substr(0, open), NAN};
  if (open != std::string::npos && space != std::string::npos) {
    place.time = std::strtod(name.c_str() + open + 1, nullptr);
  }
  return place;
}

/// features.csv numbers the outputs as samples.h5 does.
std::string getOutputName(const RunFolder& run, std::size_t row) {
  const std::vector<std::string> names = collectNames(run.experiment.model.outputs);
  const double index = run.features.getNumber(row, "output");
  const bool is_index = index >= 0.0 && index < static_cast<double>(names.size());
  return is_index ? names[static_cast<std::size_t>(index)] : run.features.getText(row, "output");
}

std::vector<FeaturePlace> collectPlaces(const RunFolder& run) {
  std::vector<FeaturePlace> places;
  for (std::size_t row = 0; row < run.features.rows.size(); ++row) {
    places.push_back(
        {run.features.getText(row, "feature"), getOutputName(run, row), run.features.getNumber(row, "time")});
  }
  if (places.empty() && run.map) {
    for (const std::string& name : run.map->feature_names) {
      places.push_back(parseFeature(name));
    }
  }
  return places;
}

std::vector<std::string> collectOutputs(const std::vector<FeaturePlace>& places) {
  std::vector<std::string> outputs;
  for (const FeaturePlace& place : places) {
    if (std::isfinite(place.time) &&
        std::find(outputs.begin(), outputs.end(), place.output) == outputs.end()) {
      outputs.push_back(place.output);
    }
  }
  return outputs;
}

/// A long table: one row per feature and series.
class SeriesTable {
 public:
  void add(const FeaturePlace& place, const std::string& series, double value) {
    feature_.push_back(place.name);
    output_.push_back(place.output);
    time_.push_back(place.time);
    series_.push_back(series);
    value_.push_back(value);
  }
  DataTable make(const std::string& series, const std::string& value) {
    DataTable table;
    table.add("feature", feature_);
    table.add("output", output_);
    table.add("time", time_);
    table.add(series, series_);
    table.add(value, value_);
    return table;
  }

 private:
  std::vector<std::string> feature_, output_, series_;
  std::vector<double> time_, value_;
};

/// A panel for each output, a line for each of `names`, which the skeleton of the figure's name calls
/// `series`.
Figure makeSeriesFigure(const std::string& name, const std::string& title, const std::string& help,
                        const std::vector<std::string>& outputs, const std::string& series,
                        const std::vector<std::string>& names) {
  Figure figure{name, title, help, name, {}, {}, static_cast<int>(std::min<std::size_t>(outputs.size(), 2))};
  for (const std::string& output : outputs) {
    figure.panels.push_back({name, {{"output", output}}, {{series, names}}});
  }
  return figure;
}

void addSensitivities(const RunFolder& run, const std::vector<FeaturePlace>& places, Section& section,
                      Page& page) {
  if (run.features.empty()) {
    section.html += makeParagraph(
        "Sensitivities of the features are not in this run: they come with the information limit "
        "(docs/reference/experiment-file.md, evaluation).",
        "class=\"quiet\"");
    return;
  }
  const std::vector<std::string> names = collectNames(run.experiment.model.parameters);
  SeriesTable table;
  for (std::size_t row = 0; row < places.size(); ++row) {
    for (const std::string& name : names) {
      table.add(places[row], name, run.features.getNumber(row, name));
    }
  }
  page.tables["sensitivities"] = table.make("parameter", "sensitivity");
  addFigure(
      makeSeriesFigure("sensitivities", "Sensitivity of the features",
                       "How far a feature moves, in units of its noise sd, when a parameter crosses its "
                       "whole range (root mean square over the test set): the axis is logarithmic above 1. "
                       "Where a line is below 1, that feature alone says nothing about the parameter.",
                       collectOutputs(places), "parameters", names),
      section);
}

void addLoadings(const RunFolder& run, const std::vector<FeaturePlace>& places, Section& section,
                 Page& page) {
  constexpr Eigen::Index kMaxComponents = 6;
  const Eigen::MatrixXd projection = run.map ? run.map->model.map->getProjection() : Eigen::MatrixXd();
  if (projection.size() == 0 || projection.cols() != static_cast<Eigen::Index>(places.size())) {
    return;
  }
  const Eigen::Index shown = std::min(projection.rows(), kMaxComponents);
  std::vector<std::string> names;
  SeriesTable table;
  for (Eigen::Index k = 0; k < shown; ++k) {
    names.push_back(fmt::format("component {}", k + 1));
    for (Eigen::Index f = 0; f < projection.cols(); ++f) {
      table.add(places[static_cast<std::size_t>(f)], names.back(), projection(k, f));
    }
  }
  page.tables["loadings"] = table.make("component", "loading");
  const std::vector<std::string> outputs = collectOutputs(places);
  if (!outputs.empty()) {
    addFigure(makeSeriesFigure(
                  "loadings", "Loadings of the components",
                  fmt::format("What the estimator sees of a response: each component is the sum of the "
                              "scaled features weighted by these loadings ({} of {} components are drawn).",
                              shown, projection.rows()),
                  outputs, "components", names),
              section);
  }
}

}  // namespace

void addFeatures(const RunFolder& run, Page& page) {
  if (run.features.empty() && !run.map) {
    return;
  }
  Section section{"features", "Features", "", {}};
  const std::vector<FeaturePlace> places = collectPlaces(run);
  addSensitivities(run, places, section, page);
  addLoadings(run, places, section, page);
  addRelevance(run, section, page);
  addCombinations(run, section, page);
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
