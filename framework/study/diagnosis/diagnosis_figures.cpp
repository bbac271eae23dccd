#include "framework/study/diagnosis/diagnosis_figures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "framework/base/text/number_text.hpp"
#include "framework/report/html.hpp"
#include "framework/study/replay/residual_spectrum.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kNormal95 = 1.959964;
constexpr Index kMaxTimes = 4000;  // of an output that are drawn, over all recordings

std::vector<double> toVector(const VectorXd& values) {
  return {values.begin(), values.end()};
}

/// Columns that grow by one recording after the other; the first names it by its number.
class RecordingTable {
 public:
  void add(std::size_t recording, const std::vector<std::pair<std::string, VectorXd>>& columns) {
    const auto rows = static_cast<std::size_t>(columns.front().second.size());
    recordings_.insert(recordings_.end(), rows, std::to_string(recording + 1));
    for (const auto& [name, values] : columns) {
      std::vector<double>& column = columns_[name];
      column.insert(column.end(), values.begin(), values.end());
    }
  }

  DataTable make() const {
    DataTable table;
    table.add("recording", recordings_);
    for (const auto& [name, values] : columns_) {
      table.add(name, values);
    }
    return table;
  }

 private:
  std::vector<std::string> recordings_;
  std::map<std::string, std::vector<double>> columns_;
};

/// Which recording is shown: the reader's choice, where there are several.
void addRecordingChoice(const std::vector<std::string>& names, Figure& figure) {
  if (names.size() < 2) {
    for (Panel& panel : figure.panels) {
      panel.texts["recording"] = "1";
    }
    return;
  }
  Choice choice{"recording", "recording", {}, 0};
  for (std::size_t k = 0; k < names.size(); ++k) {
    choice.options.push_back({std::to_string(k + 1), names[k], {}});
  }
  figure.choices.push_back(std::move(choice));
}

std::string makeSpeedUnit(const ForcedCoordinate& coordinate) {
  return std::string(coordinate.getUnit()) + "/s";
}

// ---- Forces
// -------------------------------------------------------------------------------------------------

/// What the line of the term is called; "" without one.
std::string nameTerm(const DrawnDiagnosis& drawn, const UnknownForce& force) {
  return force.term ? drawn.diagnosis.terms[*force.term].candidate.term : "";
}

std::vector<std::pair<std::string, VectorXd>> listCurveColumns(const ForceCurve& curve) {
  return {{"force", curve.mean},
          {"lower", curve.mean - kNormal95 * curve.stddev},
          {"upper", curve.mean + kNormal95 * curve.stddev}};
}

/// Along the recordings.
DataTable makeForceTable(const UnknownForce& force) {
  RecordingTable table;
  for (std::size_t k = 0; k < force.recordings.size(); ++k) {
    const ForceOverTime& one = force.recordings[k];
    std::vector<std::pair<std::string, VectorXd>> columns = listCurveColumns(one.force);
    columns.insert(
        columns.end(),
        {{"time", one.force.at}, {"position", one.coordinate.position}, {"speed", one.coordinate.speed}});
    table.add(k, columns);
  }
  return table.make();
}

/// The force without the samples at which the speed jumps, as at a bounce: a line would cross the picture
/// there.
VectorXd cutAtJumps(const VectorXd& force, const VectorXd& speed) {
  constexpr double kJump = 0.2;  // of the range: 1001 samples of 60 periods change by less
  VectorXd cut = force;
  for (Index i = 1; i < speed.size(); ++i) {
    if (std::abs(speed[i] - speed[i - 1]) > kJump * (speed.maxCoeff() - speed.minCoeff())) {
      cut[i] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return cut;
}

/// Of the term, likewise.
DataTable makeTermTable(const UnknownForce& force) {
  RecordingTable table;
  for (std::size_t k = 0; k < force.recordings.size(); ++k) {
    const ForceOverTime& one = force.recordings[k];
    table.add(k, {{"time", one.fine_times},
                  {"position", one.fine.position},
                  {"speed", one.fine.speed},
                  {"force", cutAtJumps(one.term_force, one.fine.speed)}});
  }
  return table.make();
}

/// A function of one quantity where the recordings say more of it than was assumed before.
DataTable makeCurveTable(const ForceCurve& curve) {
  constexpr double kKnown = 0.8;  // of the standard deviation before
  DataTable table;
  table.add("at", toVector(curve.at));
  for (auto [name, values] : listCurveColumns(curve)) {
    for (Index i = 0; i < values.size(); ++i) {
      if (curve.stddev[i] > kKnown * curve.prior_stddev) {
        values[i] = std::numeric_limits<double>::quiet_NaN();
      }
    }
    table.add(name, toVector(values));
  }
  return table;
}

Panel makeForcePanel(const std::string& skeleton, const ForcedCoordinate& coordinate,
                     const std::string& table, const std::string& term, std::vector<std::string> series) {
  Panel panel{skeleton,
              {{"table", table},
               {"coordinate", coordinate.name},
               {"label", makeLabel("force on " + coordinate.name, coordinate.getForceUnit())},
               {"term", term},
               {"and_term", term.empty() ? "" : ", and that of " + term}}};
  if (term.empty()) {
    panel.without.insert("term");
  } else {
    series.push_back(term);
  }
  panel.values["series"] = std::move(series);
  return panel;
}

/// Over the speed or the position. The function, whose data go to the page, is left out where the recordings
/// speak against one.
Panel makeForceOverPanel(const ForcedCoordinate& coordinate, const UnknownForce& force,
                         const std::string& table, const std::string& term, bool is_speed, Page& page) {
  const std::string quantity = is_speed ? "speed" : "position";
  const ForceCurve& curve = is_speed ? force.over_speed : force.over_position;
  std::vector<std::string> series{"at each time"}, colors{"var(--quiet)"};
  if (force.mayBe(curve)) {
    series.push_back("by " + quantity);
    colors.push_back(getColor(0));
    page.tables[table + "-" + quantity] = makeCurveTable(curve);
  }
  Panel panel = makeForcePanel("force-over", coordinate, table, term, std::move(series));
  colors.push_back(getColor(1));
  panel.values["colors"] = std::move(colors);
  panel.texts["quantity"] = quantity;
  panel.texts["x_title"] = is_speed ? makeLabel(coordinate.name + "_dot", makeSpeedUnit(coordinate))
                                    : makeLabel(coordinate.name, coordinate.getUnit());
  if (!force.mayBe(curve)) {
    panel.without.insert("curve");
  }
  return panel;
}

/// Whether the recordings ask for a force at all.
bool isAskedFor(const UnknownForce& force) {
  return force.term || force.getEvidenceOverTime() > 0.0 || force.mayBe(force.over_speed) ||
         force.mayBe(force.over_position);
}

std::string describeEvidence(const UnknownForce& force) {
  const auto write = [](double evidence) {
    return std::isfinite(evidence) ? fmt::format("{:.1f}", evidence) : std::string("-");
  };
  std::string text = fmt::format(
      "Log evidence against no force: {} for a function of speed alone, {} of position alone, {} for what "
      "changes with time as it likes; a difference of 3 is 20 to 1.",
      write(force.over_speed.log_evidence), write(force.over_position.log_evidence),
      write(force.getEvidenceOverTime()));
  if (!isAskedFor(force)) {
    text += " The recordings ask for none.";
  } else if (!force.mayBe(force.over_speed) || !force.mayBe(force.over_position)) {
    text += " A function that this speaks against is not drawn.";
  }
  return text;
}

void addForceFigures(const DrawnDiagnosis& drawn, const UnknownForce& force, const std::string& table,
                     Page& page, Section& section) {
  const ForcedCoordinate& coordinate = drawn.motion.getCoordinates()[force.coordinate];
  const std::string term = nameTerm(drawn, force);
  const std::string title = "Force on " + coordinate.name + (term.empty() ? "" : " in the place of " + term);
  page.tables[table] = makeForceTable(force);
  if (force.term) {
    page.tables[table + "-term"] = makeTermTable(force);
  }
  Figure over{table,
              title + ", over speed and position",
              "A step over the speed is dry friction, a curve over the position a spring. Points: at each "
              "time; line: as a function, with its 95 % band. " +
                  describeEvidence(force),
              table,
              {makeForceOverPanel(coordinate, force, table, term, true, page),
               makeForceOverPanel(coordinate, force, table, term, false, page)},
              {},
              2};
  addRecordingChoice(drawn.names, over);
  addFigure(std::move(over), section);
  Figure over_time{table + "-time",
                   title + ", over time",
                   "The band holds 95 %. Drag and scroll to move and zoom the axis of time.",
                   table,
                   {makeForcePanel("force-over-time", coordinate, table, term, {"at each time"})},
                   {},
                   1};
  addRecordingChoice(drawn.names, over_time);
  addFigure(std::move(over_time), section);
}

/// Beside what the forces stand that are drawn.
template <class IsDrawn>
std::string describeForces(const std::vector<UnknownForce>& forces, const IsDrawn& isDrawn) {
  const bool has_term = !forces.empty() && forces.front().term;
  const bool has_other = std::any_of(
      forces.begin(), forces.end(), [&](const UnknownForce& force) { return !force.term && isDrawn(force); });
  std::string html;
  if (has_term) {
    html += makeParagraph(
        "In the place of a term that was found: what the recordings ask for there, whatever its law, beside "
        "the model with the other terms and with the parameters of the fit with all of them.");
  }
  if (has_other) {
    html += makeParagraph(fmt::format(
        "{} model, whose parameters are free and take up what they can.",
        has_term ? "Without a term: beside the corrected" : "What the recordings ask for beside the"));
  }
  return html;
}

// ---- Residuals
// ----------------------------------------------------------------------------------------------

/// Every so manieth value, so that not too many are drawn.
VectorXd pick(const VectorXd& values, Index step) {
  return values(Eigen::seqN(0, (values.size() + step - 1) / step, step));
}

void addResidual(const DrawnDiagnosis& drawn, const OutputResidual& residual, RecordingTable& table,
                 RecordingTable& spectra) {
  const std::vector<ForcedCoordinate>& coordinates = drawn.motion.getCoordinates();
  const Index most = std::max<Index>(1, kMaxTimes / static_cast<Index>(drawn.names.size()));
  const Index step = (residual.times.size() + most - 1) / most;
  std::vector<std::pair<std::string, VectorXd>> columns{{"time", pick(residual.times, step)},
                                                        {"before", pick(residual.before, step)}};
  const ResidualSpectrum before = calcResidualSpectrum(residual.times, residual.before);
  std::vector<std::pair<std::string, VectorXd>> powers{{"frequency", before.frequency},
                                                       {"before", before.power}};
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

}  // namespace

Section makeForceSection(const DrawnDiagnosis& drawn, const std::vector<UnknownForce>& forces, Page& page) {
  Section section{"forces", "Unknown forces", "", {}};
  const bool is_any = std::any_of(forces.begin(), forces.end(), &isAskedFor);
  const auto isDrawn = [&](const UnknownForce& force) { return !is_any || isAskedFor(force); };
  section.html = describeForces(forces, isDrawn);
  std::string none;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    if (isDrawn(forces[i])) {
      addForceFigures(drawn, forces[i], "force-" + std::to_string(i), page, section);
    } else {
      none += (none.empty() ? "" : ", ") + drawn.motion.getCoordinates()[forces[i].coordinate].name;
    }
  }
  if (!none.empty()) {
    section.html += makeParagraph("Not drawn, as the recordings ask for no force there: " + none + ".");
  }
  return section;
}

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

}  // namespace twinmap
