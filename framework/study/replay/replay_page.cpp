#include "framework/study/replay/replay_page.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "framework/base/log/notice.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/stated_values.hpp"
#include "framework/inference/text/inference_text.hpp"
#include "framework/report/estimate_panel.hpp"
#include "framework/report/html.hpp"
#include "framework/report/mechanism.hpp"
#include "framework/report/response_panels.hpp"
#include "framework/report/sections/verdict.hpp"
#include "framework/study/replay/replay_files.hpp"
#include "framework/study/replay/residual_spectrum.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kShownDigits = 6;
constexpr Index kMaxTimes = 10000;  // that are drawn

HtmlCell makeShownCell(double value, int digits = kShownDigits) {
  return makeNumberCell(toText(value), digits);
}

std::string describeWindow(const MeasuredWindow& window) {
  return window.file.string() + ", from " + toShortText(window.start, kShownDigits) + " s";
}

/// "NRMSE of the updated model: 0.5 % (y), 3 % (theta); of the nominal model: 40 % (y), 30 % (theta)."
std::string describeFits(const Replay& replay) {
  const auto list = [&](const ReplayedModel& model) {
    std::string text;
    for (std::size_t o = 0; o < model.fits.size(); ++o) {
      text += fmt::format("{}{:.3g} % ({})", o == 0 ? "" : ", ", model.fits[o].nrmse_pct,
                          replay.layout.output_names[o]);
    }
    return text;
  };
  return "NRMSE of the updated model: " + list(replay.updated) +
         "; of the nominal model: " + list(replay.nominal) + ".";
}

std::vector<std::string> collectWarnings(const Replay& replay) {
  std::vector<std::string> warnings;
  for (const auto& [name, model] : {std::pair("nominal", &replay.nominal), {"updated", &replay.updated}}) {
    if (!model->nuisance_converged) {
      warnings.push_back(describeNotice(Notice::kNuisanceSearch, name));
    }
  }
  if (replay.inferred.refined && !replay.inferred.refined->isAccepted()) {
    warnings.emplace_back("the refinement was not accepted: " + replay.inferred.refined->message);
  }
  return warnings;
}

Section makeVerdict(const MeasurementReader& reader, const Replay& replay, const std::string& prefix) {
  Section section{prefix + "verdict", "Verdict", "", {}};
  const std::vector<ParameterSpec>& parameters = reader.getExperiment().model.parameters;
  std::istringstream trust(describeTrust(replay.inferred, parameters, reader.getExtractor().getInfos()) +
                           describeMapLimit(replay.inferred, parameters));
  for (std::string line; std::getline(trust, line);) {
    section.html += makeParagraph(line, "class=\"lead\"");
  }
  section.html += makeParagraph(describeFits(replay));
  const std::vector<ParameterSpec>& inputs = reader.getExperiment().model.inputs;
  std::vector<std::pair<std::string, std::string>> facts{
      {"measurement", describeWindow(replay.options.measurement)},
      {"parameters estimated from", describeWindow(replay.options.from)},
      {"experiment", reader.getExperiment().name.text},
      {"draws of the band", std::to_string(replay.options.draws)}};
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    facts.emplace_back(makeLabel(inputs[i]),
                       toShortText(replay.options.known[static_cast<Index>(i)], kShownDigits));
  }
  section.html += makeFacts(facts) + makeWarningList(collectWarnings(replay));
  return section;
}

using Cells = std::vector<HtmlCell>;

std::string makeParameterTable(const MeasurementReader& reader, const Replay& replay) {
  const std::vector<ParameterSpec>& parameters = reader.getExperiment().model.parameters;
  const bool refined = replay.inferred.refined && replay.inferred.refined->isAccepted();
  const Estimate by_estimator =
      replay.inferred.by_estimator.isGiven() ? replay.inferred.by_estimator : selectEstimate(replay.inferred);
  if (!by_estimator.isGiven()) {
    return makeParagraph("Nothing is estimated; the updated model is the best fit.");
  }
  const Bounds95 bounds = by_estimator.calcBounds95();
  std::vector<std::string> headings{"parameter", "unit", "estimated", "sd", "95 % from", "to"};
  if (refined) {
    headings.insert(headings.end(), {"refined", "its sd"});
  }
  headings.emplace_back("nominal");
  std::vector<Cells> rows;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto i = static_cast<Index>(p);
    rows.push_back({makeTextCell(parameters[p].name.text), makeTextCell(parameters[p].unit),
                    makeShownCell(by_estimator.mean[i]), makeShownCell(by_estimator.stddev[i], kStddevDigits),
                    makeShownCell(bounds.lower[i]), makeShownCell(bounds.upper[i])});
    if (refined) {
      rows.back().push_back(makeShownCell(replay.inferred.refined->point[i]));
      rows.back().push_back(makeShownCell(replay.inferred.refined->stddev[i], kStddevDigits));
    }
    rows.back().push_back(makeShownCell(replay.nominal.point[i]));
  }
  return makeHtmlTable("parameters-table",
                       std::string("Parameters to estimate. The updated model is simulated at the ") +
                           (refined ? "refined" : "estimated") +
                           " values, moved to the bounds where they lie beyond.",
                       headings, rows);
}

/// What follows from the parameters, and those that are determined where the others are not.
std::string makeValueTable(const std::vector<ParameterSpec>& parameters,
                           const InferredMeasurement& inferred) {
  const Estimate believed = selectEstimate(inferred);
  const StatedValues stated = stateValues(inferred, believed, parameters);
  std::vector<Cells> rows;
  const auto add = [&](const std::string& name, const std::string& unit, double mean, double stddev,
                       double lower, double upper) {
    rows.push_back({makeTextCell(name), makeTextCell(unit), makeShownCell(mean),
                    makeShownCell(stddev, kStddevDigits), makeShownCell(lower), makeShownCell(upper)});
  };
  for (std::size_t p = 0; p < parameters.size() && !believed.isGiven(); ++p) {
    if (const auto i = static_cast<Index>(p); isStated(stated.estimate, i)) {
      const auto [lower, upper] = stated.estimate.findIntervals(i, Coverage::k95).front();
      add(parameters[p].name.text, parameters[p].unit, stated.estimate.mean[i], stated.estimate.stddev[i],
          lower, upper);
    }
  }
  for (const std::vector<DerivedValue>* values : {&stated.derived, &stated.identified}) {
    for (const DerivedValue& value : *values) {
      if (value.isStated()) {
        add(value.name, value.unit, value.mean, value.stddev, value.lower95, value.upper95);
      }
    }
  }
  return rows.empty()
             ? ""
             : makeHtmlTable("values-table",
                             "What is determined besides: derived quantities, combinations of parameters "
                             "and, where no estimate of all can be given, single parameters.",
                             {"quantity", "unit", "estimated", "sd", "95 % from", "to"}, rows);
}

std::string makeNuisanceTable(const ModelSpec& model, const Replay& replay) {
  const std::vector<DerivedValue> known = listNuisance(replay.inferred.posterior);
  std::vector<Cells> rows;
  for (std::size_t n = 0; n < model.nuisance.size(); ++n) {
    const auto i = static_cast<Index>(model.parameters.size() + n);
    rows.push_back({makeTextCell(model.nuisance[n].name.text), makeTextCell(model.nuisance[n].unit),
                    makeShownCell(replay.updated.point[i]), makeShownCell(replay.nominal.point[i])});
    const bool has_stddev = n < known.size();
    rows.back().push_back(has_stddev ? makeShownCell(known[n].mean) : makeTextCell(""));
    rows.back().push_back(has_stddev ? makeShownCell(known[n].stddev, kStddevDigits) : makeTextCell(""));
  }
  return rows.empty()
             ? ""
             : makeHtmlTable("nuisance-table",
                             "Nuisance parameters, fitted to the replayed measurement for either model, so "
                             "that the comparison is fair.",
                             {"nuisance parameter", "unit", "updated", "nominal", "estimated", "sd"}, rows);
}

std::string makeFitHtml(const Replay& replay) {
  constexpr int kDigits = 4;
  const std::vector<CsvRow> fits = listFits(replay);
  std::vector<Cells> rows;
  for (std::size_t row = 1; row < fits.size(); ++row) {
    rows.push_back({makeTextCell(fits[row][0])});
    for (std::size_t column = 1; column < fits[row].size(); ++column) {
      rows.back().push_back(makeNumberCell(fits[row][column], kDigits));
    }
  }
  return makeHtmlTable("fit-table",
                       "NRMSE: rms of the residual over rms of the measured output about its mean. Residuals "
                       "in standard deviations of the noise: where the model is right, their rms is about 1.",
                       {"output", "NRMSE %", "rms residual / sd", "largest", "nominal NRMSE %",
                        "nominal rms / sd", "nominal largest"},
                       rows);
}

DataTable makeTable(const Replay& replay, Index output) {
  const Index times = replay.layout.times.size();
  const Index step = (times + kMaxTimes - 1) / kMaxTimes;
  const auto pick = [&](const VectorXd& rows, Index first) {
    std::vector<double> values;
    for (Index i = 0; i < times; i += step) {
      values.push_back(rows[first + i]);
    }
    return values;
  };
  const Index first = replay.layout.getRow(output, 0);
  DataTable table;
  table.add("time", pick(replay.layout.times, 0));
  table.add("measured", pick(replay.measured, first));
  table.add("nominal", pick(replay.nominal.response, first));
  table.add("updated", pick(replay.updated.response, first));
  table.add("lower", pick(replay.lower, first));
  table.add("upper", pick(replay.upper, first));
  table.add("noise_stddev", pick(replay.noise_stddev, first));
  return table;
}

std::string makeHelp(const Replay& replay) {
  std::string help =
      "Points: measured; dashed: the nominal model, at the centre of the bounds; solid: the updated model, "
      "with the 95 % band that the uncertainty of the parameters leaves. Below: measured minus updated; "
      "where the updated model is right, 95 % lie in the grey band of \u00b12 noise sd. Drag and scroll to "
      "move and zoom the axis of time, double-click to take it back.";
  if (replay.layout.times.size() > kMaxTimes) {
    help += " Not all times are drawn; replay.csv has them all.";
  }
  return help;
}

Figure makeFigure(const Replay& replay, Index output, const std::string& prefix) {
  const auto o = static_cast<std::size_t>(output);
  const std::string table = prefix + "replay-" + std::to_string(output);
  const ResponseData data{table, replay.layout.output_names[o], replay.layout.output_units[o]};
  constexpr ResponseLook kLook{true, true};
  return {table, replay.layout.output_names[o] + ": measured, nominal, updated",   makeHelp(replay),
          table, {makeResponsePanel(data, kLook), makeResidualPanel(data, kLook)}, {},
          1};
}

/// The spectrum of an output's residual; none where it has no noise or too few times.
std::optional<Figure> makeSpectrum(const Replay& replay, Index output, const std::string& prefix,
                                   Page& page) {
  constexpr Index kMin = 16;
  const Index times = replay.layout.times.size(), first = replay.layout.getRow(output, 0);
  const VectorXd all = (replay.measured - replay.updated.response)
                           .segment(first, times)
                           .cwiseQuotient(replay.noise_stddev.segment(first, times));
  std::vector<Index> there;
  for (Index i = 0; i < times; ++i) {
    if (std::isfinite(all[i])) {
      there.push_back(i);
    }
  }
  if (static_cast<Index>(there.size()) < kMin) {
    return std::nullopt;
  }
  const ResidualSpectrum spectrum = calcResidualSpectrum(replay.layout.times(there), all(there));
  const std::string name = prefix + "spectrum-" + std::to_string(output);
  DataTable& table = page.tables[name];
  table.add("frequency", std::vector<double>(spectrum.frequency.begin(), spectrum.frequency.end()));
  table.add("power", std::vector<double>(spectrum.power.begin(), spectrum.power.end()));
  const std::string& label = replay.layout.output_names[static_cast<std::size_t>(output)];
  return Figure{name,
                label + ": spectrum of the residual",
                "Where the updated model is right, the residual is noise and its power about 1 at all "
                "frequencies (dashed). A peak is a vibration that the model lacks.",
                name,
                {{"spectrum", {{"table", name}, {"output", label}}}},
                {},
                1};
}

/// What was estimated beside the bounds, and the tables of all numbers.
Section makeParameters(const MeasurementReader& reader, const Replay& replay, const std::string& prefix,
                       Page& page) {
  const ModelSpec& model = reader.getExperiment().model;
  Section section{prefix + "parameters", "Parameters", "", {}};
  const Estimate estimate = selectEstimate(replay.inferred);
  const Bounds95 bounds = estimate.isGiven() ? estimate.calcBounds95() : Bounds95{};
  std::vector<ShownEstimate> shown;
  for (Index p = 0; p < estimate.mean.size(); ++p) {
    shown.push_back({estimate.mean[p], estimate.stddev[p], bounds.lower[p], bounds.upper[p]});
  }
  if (!shown.empty()) {
    addFigure(makeEstimateFigure(prefix + "intervals", "Estimates within their bounds", model.parameters,
                                 shown, page),
              section);
  }
  section.html += makeParameterTable(reader, replay) + makeValueTable(model.parameters, replay.inferred) +
                  makeNuisanceTable(model, replay);
  return section;
}

/// Whether anything of an output was measured: of a frequency response nothing is over time.
bool isMeasured(const Replay& replay, Index output) {
  const Index first = replay.layout.getRow(output, 0);
  return replay.measured.segment(first, replay.layout.times.size()).array().isFinite().any();
}

}  // namespace

void addReplay(const MeasurementReader& reader, const Replay& replay, const std::string& prefix, Page& page) {
  page.sections.push_back(makeVerdict(reader, replay, prefix));
  Section responses{prefix + "responses", "Responses", "", {}};
  for (Index output = 0; output < replay.layout.getOutputCount(); ++output) {
    if (!isMeasured(replay, output)) {
      continue;
    }
    page.tables[prefix + "replay-" + std::to_string(output)] = makeTable(replay, output);
    addFigure(makeFigure(replay, output, prefix), responses);
    if (std::optional<Figure> spectrum = makeSpectrum(replay, output, prefix, page)) {
      addFigure(std::move(*spectrum), responses);
    }
  }
  if (!responses.figures.empty()) {
    page.sections.push_back(std::move(responses));
  }
  page.sections.push_back(makeParameters(reader, replay, prefix, page));
  page.sections.push_back({prefix + "fit", "Fit", makeFitHtml(replay), {}});
}

std::string makeReplayPage(const MeasurementReader& reader, const Replay& replay) {
  Page page;
  page.title = "Replay of " + replay.options.measurement.file.filename().string();
  addMechanism(reader.getExperiment(), "twinmap view " + listArguments(replay.inferred.asked), page);
  addReplay(reader, replay, "", page);
  return makePage(page);
}

}  // namespace twinmap
