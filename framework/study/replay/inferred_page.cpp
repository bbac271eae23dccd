#include "framework/study/replay/inferred_page.hpp"

#include <sstream>

#include "framework/report/history/history_page.hpp"
#include "framework/report/html.hpp"
#include "framework/study/replay/replay_page.hpp"

namespace twinmap {
namespace {

/// What the table says, where nothing can be drawn.
Section makeTextSection(const DrawnMeasurement& measurement, const std::string& prefix) {
  Section section{prefix + "verdict", "Verdict", "", {}};
  std::istringstream lines(measurement.text);
  for (std::string line; std::getline(lines, line);) {
    section.html += makeParagraph(line);
  }
  return section;
}

/// Titles name the measurement where there are several.
void addMeasurement(const MeasurementReader& reader, const DrawnMeasurement& measurement,
                    const std::string& prefix, Page& page) {
  const std::size_t first = page.sections.size();
  if (measurement.replay) {
    addReplay(reader, *measurement.replay, prefix, page);
  } else {
    page.sections.push_back(makeTextSection(measurement, prefix));
  }
  for (std::size_t i = first; i < page.sections.size() && !prefix.empty(); ++i) {
    page.sections[i].title = measurement.name + ": " + page.sections[i].title;
  }
}

}  // namespace

std::string makeInferredPage(const std::string& title, const MeasurementReader& reader,
                             const std::vector<DrawnMeasurement>& drawn, const History& history,
                             const std::optional<std::vector<Course>>& courses) {
  Page page;
  page.title = title;
  if (drawn.size() != 1) {
    addHistory(history, courses, page);
  }
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    addMeasurement(reader, drawn[i], drawn.size() == 1 ? "" : "m" + std::to_string(i + 1) + "-", page);
  }
  addProfiles(history, page);
  return makePage(page);
}

}  // namespace twinmap
