#include "framework/study/diagnosis/force_figures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/estimation/interval_factor.hpp"
#include "framework/report/html.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

std::vector<double> toVector(const VectorXd& values) {
  return {values.begin(), values.end()};
}

/// What the line of the term is called; "" without one.
std::string nameTerm(const DrawnDiagnosis& drawn, const UnknownForce& force) {
  return force.term ? drawn.diagnosis.terms[*force.term].candidate.term : "";
}

NamedColumns listCurveColumns(const ForceCurve& curve) {
  return {{"force", curve.mean},
          {"lower", curve.mean - kNormal95 * curve.stddev},
          {"upper", curve.mean + kNormal95 * curve.stddev}};
}

/// Along the recordings.
DataTable makeForceTable(const UnknownForce& force) {
  RecordingTable table;
  for (std::size_t k = 0; k < force.recordings.size(); ++k) {
    const ForceOverTime& one = force.recordings[k];
    NamedColumns columns = listCurveColumns(one.force);
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

}  // namespace twinmap
