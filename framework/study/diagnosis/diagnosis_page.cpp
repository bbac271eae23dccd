#include "framework/study/diagnosis/diagnosis_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>

#include "framework/base/log/notice.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/diagnosis/picture/output_residuals.hpp"
#include "framework/diagnosis/text/diagnosis_text.hpp"
#include "framework/report/html.hpp"
#include "framework/report/sections/verdict.hpp"
#include "framework/study/diagnosis/drawn_diagnosis.hpp"
#include "framework/study/diagnosis/force_figures.hpp"
#include "framework/study/replay/residual_spectrum.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kMaxTimes = 4000;  // of an output that are drawn, over all recordings

/// Every so manieth value, so that not too many are drawn.
VectorXd pick(const VectorXd& values, Index step) {
  return values(Eigen::seqN(0, (values.size() + step - 1) / step, step));
}

void addResidual(const DrawnDiagnosis& drawn, const OutputResidual& residual, RecordingTable& table,
                 RecordingTable& spectra) {
  const std::vector<ForcedCoordinate>& coordinates = drawn.motion.getCoordinates();
  const Index most = std::max<Index>(1, kMaxTimes / static_cast<Index>(drawn.names.size()));
  const Index step = (residual.times.size() + most - 1) / most;
  NamedColumns columns{{"time", pick(residual.times, step)}, {"before", pick(residual.before, step)}};
  const ResidualSpectrum before = calcResidualSpectrum(residual.times, residual.before);
  NamedColumns powers{{"frequency", before.frequency}, {"before", before.power}};
  if (residual.after.size() > 0) {
    columns.emplace_back("after", pick(residual.after, step));
    powers.emplace_back("after", calcResidualSpectrum(residual.times, residual.after).power);
  }
  for (std::size_t c = 0; c < coordinates.size(); ++c) {
    const auto i = static_cast<Index>(c);
    columns.emplace_back("position_" + coordinates[c].name, pick(residual.positions.col(i), step));
    columns.emplace_back("speed_" + coordinates[c].name, pick(residual.speeds.col(i), step));
  }
  table.add(residual.recording, columns);
  spectra.add(residual.recording, powers);
}

Panel makeResidualPanel(const DrawnDiagnosis& drawn, const std::string& skeleton, const std::string& table,
                        const std::string& output) {
  Panel panel{skeleton, {{"table", table}, {"output", output}}};
  const bool is_found = drawn.diagnosis.found > 0;
  std::vector<std::string> series{"the model"};
  if (is_found) {
    series.emplace_back("with the terms");
  } else {
    panel.without.insert("after");
  }
  panel.values["series"] = std::move(series);
  return panel;
}

Panel makeResidualOverPanel(const DrawnDiagnosis& drawn, const std::string& table, const std::string& output,
                            const std::string& x, const std::string& title) {
  Panel panel = makeResidualPanel(drawn, "residual-over", table, output);
  panel.texts["x"] = x;
  panel.texts["x_title"] = title;
  return panel;
}

/// The number of the coordinate that an output measures, or else the first.
std::size_t findOwnCoordinate(const DrawnDiagnosis& drawn, std::size_t output) {
  const OutputSpec& spec = drawn.diagnosis.corrected.model.outputs[output];
  const std::optional<Name>& name = spec.coordinate ? spec.coordinate : spec.speed;
  const std::vector<ForcedCoordinate>& coordinates = drawn.motion.getCoordinates();
  const auto own = std::find_if(coordinates.begin(), coordinates.end(),
                                [&](const ForcedCoordinate& one) { return name && one.name == name->text; });
  return own == coordinates.end() ? 0 : static_cast<std::size_t>(own - coordinates.begin());
}

/// Over the coordinate that the reader chooses, and its speed.
void addMotionPanels(const DrawnDiagnosis& drawn, std::size_t number, const std::string& table,
                     Figure& figure) {
  const std::string& output = drawn.recordings.layout.output_names[number];
  const std::vector<ForcedCoordinate>& coordinates = drawn.motion.getCoordinates();
  if (coordinates.empty()) {
    return;
  }
  const bool has_choice = coordinates.size() > 1;
  const std::string q = has_choice ? "{coordinate}" : coordinates.front().name;
  const std::string label =
      has_choice ? "{coordinate.label}" : makeLabel(coordinates.front().name, coordinates.front().getUnit());
  const bool is_one_kind =
      std::all_of(coordinates.begin(), coordinates.end(),
                  [&](const ForcedCoordinate& one) { return one.is_angle == coordinates.front().is_angle; });
  const std::string speed = makeLabel(q + "_dot", is_one_kind ? makeSpeedUnit(coordinates.front()) : "SI");
  figure.panels.push_back(makeResidualOverPanel(drawn, table, output, "position_" + q, label));
  figure.panels.push_back(makeResidualOverPanel(drawn, table, output, "speed_" + q, speed));
  if (has_choice) {
    Choice choice{"coordinate", "over", {}, findOwnCoordinate(drawn, number)};
    for (const ForcedCoordinate& one : coordinates) {
      choice.options.push_back({one.name, makeLabel(one.name, one.getUnit()), {}});
    }
    figure.choices.push_back(std::move(choice));
  }
}

Figure makeResidualFigure(const DrawnDiagnosis& drawn, std::size_t output, const std::string& table) {
  const std::string& name = drawn.recordings.layout.output_names[output];
  Figure figure{table,
                "Residual of " + name,
                "In standard deviations of the noise; where a model is right, 95 % lie in the grey band, "
                "nothing shows over time, position or speed, and the power is about 1 at all frequencies.",
                table,
                {makeResidualOverPanel(drawn, table, name, "time", "time [s]"),
                 makeResidualPanel(drawn, "residual-spectra", table + "-spectra", name)},
                {},
                2};
  addMotionPanels(drawn, output, table, figure);
  addRecordingChoice(drawn.names, figure);
  return figure;
}

/// The residual of each output over time, over a coordinate and its speed, and its spectrum; their data go to
/// the page.
Section makeResidualSection(const DrawnDiagnosis& drawn, const std::vector<OutputResidual>& residuals,
                            Page& page) {
  Section section{"residuals", "Residuals", "", {}};
  std::map<std::size_t, std::pair<RecordingTable, RecordingTable>> tables;  // by output
  for (const OutputResidual& residual : residuals) {
    auto& [table, spectra] = tables[residual.output];
    addResidual(drawn, residual, table, spectra);
  }
  for (const auto& [output, both] : tables) {
    const std::string table = "residual-" + std::to_string(output);
    page.tables[table] = both.first.make();
    page.tables[table + "-spectra"] = both.second.make();
    addFigure(makeResidualFigure(drawn, output, table), section);
  }
  if (tables.empty()) {
    section.html = makeParagraph("No feature is a sample at a time of its own.");
  }
  return section;
}

constexpr std::size_t kDrawnRecordings = 12;

std::string makeLines(const std::string& text) {
  std::string html;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    html += makeParagraph(line);
  }
  return html;
}

/// Headings, then rows: numbers where they are some.
std::string makeTable(const std::string& id, const std::string& caption, const TextRows& rows) {
  std::vector<std::vector<HtmlCell>> cells;
  for (std::size_t row = 1; row < rows.size(); ++row) {
    cells.emplace_back();
    for (const std::string& text : rows[row]) {
      double value = 0.0;
      constexpr int kDigits = 6;
      const bool is_none = text == "-";
      cells.back().push_back(is_none || parseLiteral(text, value)
                                 ? makeNumberCell(is_none ? "" : text, kDigits)
                                 : makeTextCell(text));
    }
  }
  return makeHtmlTable(id, caption, rows.front(), cells);
}

std::string describeMissing(const Diagnosis& diagnosis) {
  if (diagnosis.process && !diagnosis.process_ties) {
    return "Missing: " + diagnosis.process->what + ", at random";
  }
  return diagnosis.found > 0
             ? fmt::format("Missing: {}{}", fmt::join(diagnosis.listTerms(), ", "),
                           diagnosis.process ? ", or " + diagnosis.process->what + ", at random" : "")
             : "No term is found missing";
}

Section makeVerdict(const Diagnosis& diagnosis, const ExperimentSpec& experiment,
                    const std::vector<std::string>& names) {
  Section section{"verdict", "Verdict", "", {}};
  section.html += makeParagraph(describeMissing(diagnosis), "class=\"lead\"");
  section.html += makeParagraph("The model: " + describeBefore(diagnosis) + ".");
  if (diagnosis.found > 0) {
    section.html += makeParagraph("With what is missing: " + describeFit(diagnosis.after) + ".");
  }
  const std::string noise = describeNoise(diagnosis);
  section.html += noise.empty() ? "" : makeParagraph(noise + ".");
  const std::string bounds = describeBounds(diagnosis);
  section.html += bounds.empty() ? "" : makeParagraph(bounds);
  if (diagnosis.process) {
    section.html += makeParagraph(describeProcess(diagnosis));
  }
  if (diagnosis.isIncomplete()) {
    section.html +=
        makeLines(std::string(diagnosis.getStatus()) + ": " + describeNotice(Notice::kModelIncomplete));
  }
  constexpr std::size_t kListed = 3;
  section.html += makeFacts(
      {{diagnosis.found > 0 ? "status of the model with what was found" : "status of the model as it is",
        diagnosis.getStatus()},
       {"experiment", experiment.name.text},
       {names.size() > 1 ? "recordings" : "recording",
        names.size() > kListed ? fmt::format("{}, and {} more", names.front(), names.size() - 1)
                               : fmt::format("{}", fmt::join(names, ", "))}});
  return section;
}

Section makeTerms(const Diagnosis& diagnosis) {
  Section section{"terms", "Terms", "", {}};
  for (std::size_t i = 0; i < diagnosis.steps.size(); ++i) {
    const DiagnosisStep& step = diagnosis.steps[i];
    if (!step.ranked.empty()) {
      section.html += makeLines(describeStep(step, i + 1, diagnosis.level)) +
                      makeTable("terms-" + std::to_string(i + 1),
                                fmt::format("Candidates of step {}, those of the largest evidence.", i + 1),
                                listTermRows(step, diagnosis.corrected.model.parameters));
    }
  }
  return section;
}

std::string makeProcess(const std::string& id, const std::string& what, const Remainder& process,
                        const Diagnosis& diagnosis) {
  const TextRows rows = listRemainderRows(process, diagnosis.corrected.model.parameters);
  return makeParagraph(what) + (rows.empty() ? "" : makeTable(id, "Parameters with that.", rows));
}

Section makeParameters(const Diagnosis& diagnosis) {
  Section section{"parameters", "Parameters", "", {}};
  section.html = makeTable("parameters-table", "By the model, and with what was found missing.",
                           listParameterRows(diagnosis));
  if (diagnosis.found > 0 && !diagnosis.after.posterior.isReliable()) {
    section.html += makeParagraph("No estimate: " + diagnosis.after.posterior.message + ".");
  }
  if (diagnosis.remainder) {
    section.html +=
        makeProcess("remainder-table", describeRemainder(diagnosis), *diagnosis.remainder, diagnosis);
  }
  if (diagnosis.process) {
    section.html += makeProcess(
        "process-table", "With the random process in the place of all terms:", *diagnosis.process, diagnosis);
  }
  return section;
}

}  // namespace

std::vector<std::string> nameRecordings(const std::vector<std::string>& files,
                                        const std::vector<double>& starts) {
  std::vector<std::string> names;
  for (const std::string& file : files) {
    for (const double start : starts) {
      names.push_back(fmt::format("{}, from {} s", file, toShortText(start, 6)));
    }
    if (starts.empty()) {
      names.push_back(file);
    }
  }
  return names;
}

std::string makeDiagnosisPage(const Diagnosis& diagnosis, const ExperimentSpec& experiment,
                              const RecordedFeatures& recordings, const std::vector<std::string>& names) {
  const FitMotion motion(diagnosis, experiment, recordings);
  DrawnDiagnosis drawn{diagnosis, recordings, motion, names};
  drawn.names.resize(std::min(names.size(), kDrawnRecordings));
  Page page;
  page.title = fmt::format("What {} lacks", experiment.name.text);
  page.sections.push_back(makeVerdict(diagnosis, experiment, names));
  page.sections.push_back(makeForceSection(
      drawn, estimateUnknownForces(diagnosis, recordings, motion, drawn.names.size()), page));
  page.sections.push_back(makeResidualSection(
      drawn, listOutputResiduals(diagnosis, experiment, recordings, motion, drawn.names.size()), page));
  page.sections.push_back(makeTerms(diagnosis));
  page.sections.push_back(makeParameters(diagnosis));
  return makePage(page);
}

}  // namespace twinmap
