#include "framework/report/recording_figures.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include "framework/analysis/residual_spectrum.hpp"
#include "framework/report/response_panels.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kMaxTimes = 10000;  // that are drawn

DataTable makeTable(const ShownRecording& shown, Index output) {
  const Index times = shown.layout.times.size();
  const Index step = (times + kMaxTimes - 1) / kMaxTimes;
  DataTable table;
  const auto add = [&](const char* name, const VectorXd& rows, Index first) {
    if (rows.size() > 0) {
      const VectorXd picked = rows(Eigen::seqN(first, (times + step - 1) / step, step));
      table.add(name, std::vector<double>(picked.begin(), picked.end()));
    }
  };
  const Index first = shown.layout.getRow(output, 0);
  add("time", shown.layout.times, 0);
  add("measured", shown.measured, first);
  add("nominal", shown.nominal, first);
  add("updated", shown.updated, first);
  add("lower", shown.lower, first);
  add("upper", shown.upper, first);
  add("noise_stddev", shown.noise_stddev, first);
  return table;
}

std::string makeHelp(const ShownRecording& shown) {
  std::string help = "Points: measured";
  if (shown.nominal.size() > 0) {
    help += "; dashed: the nominal model, at the centre of the bounds";
  }
  help += "; solid: the updated model";
  if (shown.lower.size() > 0) {
    help += ", with the 95 % band that the uncertainty of the parameters leaves";
  }
  help +=
      ". Below: measured minus updated; where the updated model is right, 95 % lie in the grey band of "
      "\u00b12 "
      "noise sd. Drag and scroll to move and zoom the axis of time, double-click to take it back.";
  if (shown.layout.times.size() > kMaxTimes) {
    help += " Not all times are drawn" +
            (shown.all_times.empty() ? "." : "; " + shown.all_times + " has them all.");
  }
  return help;
}

Figure makeResponses(const ShownRecording& shown, Index output) {
  const auto o = static_cast<std::size_t>(output);
  const std::string table = shown.id + "-" + std::to_string(output);
  const ResponseData data{table, shown.layout.output_names[o], shown.layout.output_units[o]};
  const ResponseLook look{shown.lower.size() > 0, true, shown.nominal.size() > 0};
  return {table,
          shown.layout.output_names[o] +
              (look.nominal ? ": measured, nominal, updated" : ": measured and fitted"),
          makeHelp(shown),
          table,
          {makeResponsePanel(data, look), makeResidualPanel(data, look)},
          {},
          1};
}

/// The spectrum of an output's residual; none where it has no noise or too few samples.
std::optional<Figure> makeSpectrum(const ShownRecording& shown, Index output, Page& page) {
  constexpr Index kFewest = 16;
  std::vector<double> times, residual;
  for (Index i = 0; i < shown.layout.times.size(); ++i) {
    const Index row = shown.layout.getRow(output, i);
    const double in_sd = (shown.measured[row] - shown.updated[row]) / shown.noise_stddev[row];
    if (std::isfinite(in_sd)) {
      times.push_back(shown.layout.times[i]);
      residual.push_back(in_sd);
    }
  }
  const auto count = static_cast<Index>(times.size());
  if (count < kFewest) {
    return std::nullopt;
  }
  const ResidualSpectrum spectrum =
      calcResidualSpectrum(VectorXd::Map(times.data(), count), VectorXd::Map(residual.data(), count));
  const std::string name = shown.id + "-spectrum-" + std::to_string(output);
  DataTable& table = page.tables[name];
  table.add("frequency", std::vector<double>(spectrum.frequency.begin(), spectrum.frequency.end()));
  table.add("power", std::vector<double>(spectrum.power.begin(), spectrum.power.end()));
  const std::string& label = shown.layout.output_names[static_cast<std::size_t>(output)];
  return Figure{name,
                label + ": spectrum of the residual",
                "Where the updated model is right, the residual is noise and its power about 1 at all "
                "frequencies (dashed). A peak is a vibration that the model lacks.",
                name,
                {{"spectrum", {{"table", name}, {"output", label}}}},
                {},
                1};
}

}  // namespace

void addRecordingFigures(const ShownRecording& shown, Page& page, Section& section) {
  for (Index output = 0; output < shown.layout.getOutputCount(); ++output) {
    page.tables[shown.id + "-" + std::to_string(output)] = makeTable(shown, output);
    addFigure(makeResponses(shown, output), section);
    if (std::optional<Figure> spectrum = makeSpectrum(shown, output, page)) {
      addFigure(std::move(*spectrum), section);
    }
  }
}

}  // namespace twinmap
