#include "framework/study/diagnosis/residual_figures.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "framework/report/html.hpp"
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

}  // namespace

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
