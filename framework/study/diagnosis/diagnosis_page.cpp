#include "framework/study/diagnosis/diagnosis_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "framework/base/log/notice.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/diagnosis/text/diagnosis_text.hpp"
#include "framework/report/html.hpp"
#include "framework/report/sections/verdict.hpp"
#include "framework/study/diagnosis/force_figures.hpp"
#include "framework/study/diagnosis/residual_figures.hpp"

namespace twinmap {
namespace {

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
  if (diagnosis.process) {
    return "Missing: " + diagnosis.process->what + ", at random";
  }
  return diagnosis.found > 0 ? fmt::format("Missing: {}", fmt::join(diagnosis.listTerms(), ", "))
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
