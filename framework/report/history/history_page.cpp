#include "framework/report/history/history_page.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "framework/base/text/number_text.hpp"
#include "framework/report/html.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

constexpr const char *kTable = "history", *kProfiles = "profiles";

std::vector<double> listFigures(const History& history, std::size_t parameter,
                                Eigen::VectorXd HistoryPoint::*figure) {
  std::vector<double> values;
  for (const HistoryPoint& point : history.points) {
    values.push_back((point.*figure)[static_cast<Index>(parameter)]);
  }
  return values;
}

/// The course at the points that count, NaN at the others.
std::vector<double> spreadCourse(const History& history, const Course& course) {
  std::vector<double> values(history.points.size(), std::numeric_limits<double>::quiet_NaN());
  const std::vector<std::size_t> counted = listCounted(history);
  for (std::size_t i = 0; i < counted.size(); ++i) {
    values[counted[i]] = course.fitted[static_cast<Index>(i)];
  }
  return values;
}

DataTable makeHistoryTable(const History& history, const std::optional<std::vector<Course>>& courses) {
  DataTable table;
  std::vector<std::string> sources, statuses, judgements;
  for (const HistoryPoint& point : history.points) {
    sources.push_back(point.source);
    statuses.push_back(point.status);
    judgements.emplace_back(point.counts ? "counts" : "left out");
  }
  table.add("place", listPlaces(history));
  table.add("source", std::move(sources));
  table.add("status", std::move(statuses));
  table.add("judgement", std::move(judgements));
  for (std::size_t p = 0; p < history.parameters.size(); ++p) {
    const std::string& name = history.parameters[p].name.text;
    table.add("mean_" + name, listFigures(history, p, &HistoryPoint::mean));
    table.add("lower_" + name, listFigures(history, p, &HistoryPoint::lower95));
    table.add("upper_" + name, listFigures(history, p, &HistoryPoint::upper95));
    if (courses) {
      table.add("course_" + name, spreadCourse(history, (*courses)[p]));
    }
  }
  return table;
}

Panel makeHistoryPanel(const History& history, std::size_t p, bool has_course) {
  const ParameterSpec& parameter = history.parameters[p];
  Panel panel{"history",
              {{"name", parameter.name.text},
               {"label", makeLabel(parameter)},
               {"place", isOneFile(history) ? "start [s]" : "measurement"}}};
  if (!has_course) {
    panel.without.insert("course");
  }
  return panel;
}

/// A row for each value of each profile.
DataTable makeProfilesTable(const History& history) {
  std::vector<std::string> parameters, measurements;
  std::vector<double> values, ratios;
  const std::vector<double> places = listPlaces(history);
  for (std::size_t k = 0; k < history.points.size(); ++k) {
    const HistoryPoint& point = history.points[k];
    for (const HistoryProfile& profile : point.profiles) {
      for (Index i = 0; i < profile.log_ratios.size(); ++i) {
        parameters.push_back(history.parameters[profile.parameter].name.text);
        measurements.push_back(point.source + (isOneFile(history) ? " at " + toText(places[k]) + " s" : ""));
        values.push_back(profile.values[i]);
        ratios.push_back(profile.log_ratios[i]);
      }
    }
  }
  DataTable table;
  table.add("parameter", std::move(parameters));
  table.add("measurement", std::move(measurements));
  table.add("value", std::move(values));
  table.add("ratio", std::move(ratios));
  return table;
}

std::string makeEstimatesTable(const History& history) {
  constexpr int kDigits = 6, kStddevDigits = 3;
  std::vector<std::string> headings{isOneFile(history) ? "start [s]" : "measurement", "file", "status"};
  for (const ParameterSpec& parameter : history.parameters) {
    headings.push_back(makeLabel(parameter));
    headings.emplace_back("its sd");
  }
  const std::vector<double> places = listPlaces(history);
  std::vector<std::vector<HtmlCell>> rows;
  for (std::size_t i = 0; i < history.points.size(); ++i) {
    const HistoryPoint& point = history.points[i];
    rows.push_back(
        {makeNumberCell(toText(places[i]), kDigits), makeTextCell(point.source), makeTextCell(point.status)});
    for (Index p = 0; p < point.mean.size(); ++p) {
      rows.back().push_back(makeNumberCell(toText(point.mean[p]), kDigits));
      rows.back().push_back(makeNumberCell(toText(point.stddev[p]), kStddevDigits));
    }
  }
  return makeHtmlTable("estimates", "Each measurement's estimate.", headings, rows);
}

Section makeHistoryVerdict(const History& history, const std::optional<std::vector<Course>>& courses) {
  Section section{"verdict", "Verdict", "", {}};
  for (std::size_t p = 0; courses && p < courses->size(); ++p) {
    section.html += makeParagraph(describeCourse(history, p, (*courses)[p]) + ".", "class=\"lead\"");
  }
  section.html += makeParagraph(
      courses ? fmt::format("From {} of {} measurements; those whose status says that the estimate misleads "
                            "are left out. Where nothing changes, a change is named in 1 of 100 histories.",
                            listCounted(history).size(), history.points.size())
              : fmt::format("Changes are looked for from {} measurements on that can be relied on, in the "
                            "order of their times; these are {}.",
                            kFewestOfCourse, listCounted(history).size()));
  return section;
}

}  // namespace

void addProfiles(const History& history, Page& page) {
  if (std::all_of(history.points.begin(), history.points.end(),
                  [](const HistoryPoint& point) { return point.profiles.empty(); })) {
    return;
  }
  page.tables[kProfiles] = makeProfilesTable(history);
  Figure figure{"profiles",
                "Profile likelihoods",
                "Each parameter is held at a value, and the others are fitted anew: how much less likely the "
                "best fit becomes. Above the dashed line at -1.92 is a normal 95 % interval; what stays near "
                "0 is a direction that the measurement leaves open.",
                kProfiles,
                {},
                {},
                0};
  for (const ParameterSpec& parameter : history.parameters) {
    figure.panels.push_back({"profile", {{"name", parameter.name.text}, {"label", makeLabel(parameter)}}});
  }
  Section section{"profiles", "Profile likelihoods", "", {}};
  addFigure(std::move(figure), section);
  page.sections.push_back(std::move(section));
}

void addHistory(const History& history, const std::optional<std::vector<Course>>& courses, Page& page) {
  page.sections.push_back(makeHistoryVerdict(history, courses));
  page.tables[kTable] = makeHistoryTable(history, courses);
  Figure figure{"history",
                "Parameters over the measurements",
                "Points are estimates, bars their 95 % intervals; the line is the course that fits them: "
                "constant, a step or a bend. Hollow points have a status that warns of them.",
                kTable,
                {},
                {},
                1};
  for (std::size_t p = 0; p < history.parameters.size(); ++p) {
    figure.panels.push_back(makeHistoryPanel(history, p, courses.has_value()));
  }
  Section section{"history", "Parameters over the measurements", "", {}};
  addFigure(std::move(figure), section);
  section.html += makeFolded("All estimates", makeEstimatesTable(history));
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
