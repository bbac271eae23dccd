#include <fmt/core.h>

#include <algorithm>

#include "framework/experiment/check/known_names.hpp"
#include "framework/report/sections/calibration_tables.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

constexpr int kBins = 10;  // of the PIT histogram

Figure makeReliability(const std::vector<std::string>& names, int n, Page& page) {
  page.tables["reliability-band"] = makeReliabilityBand(n);
  return {"reliability",
          "Reliability",
          fmt::format(
              "A line above the diagonal means intervals wider than needed, one below means overconfidence; "
              "within the grey band (95 % for each level, {} samples) the difference may be chance.",
              n),
          "reliability",
          {{"reliability", {}, {{"parameters", names}}}},
          {},
          1};
}

/// Counts of the PIT in equal bins, with the band of a uniform histogram.
Panel makePitPanel(const std::string& name, std::size_t p, int n) {
  const CountBand band = calcCountBand(n, kBins);
  return {"pit", {{"name", name}, {"color", getColor(p)}}, {{"low", band.lower}, {"high", band.upper}}};
}

Figure makePit(const std::vector<std::string>& names, int n) {
  Figure figure{"pit",
                "PIT histogram",
                "The probability that the estimate gave to values below the true one: flat within the grey "
                "band where calibrated, a U where the sd is too small, a hump where it is too large.",
                "samples",
                {},
                {},
                names.size() >= 4 ? 4 : 0};
  for (std::size_t p = 0; p < names.size(); ++p) {
    figure.panels.push_back(makePitPanel(names[p], p, n));
  }
  return figure;
}

Figure makeQuantiles(const std::vector<std::string>& names) {
  Figure figure{"z-scores",
                "z-scores against the normal distribution",
                "Points on the dashed line and within the grey band (95 % for each point) are as a normal "
                "distribution with the estimated sd says; steeper means overconfident, an offset means bias.",
                "z-scores",
                {},
                {},
                names.size() >= 4 ? 4 : 0};
  for (std::size_t p = 0; p < names.size(); ++p) {
    figure.panels.push_back({"z-scores", {{"name", names[p]}, {"color", getColor(p)}}});
  }
  return figure;
}

}  // namespace

void addCalibration(const RunFolder& run, Page& page) {
  if (run.predictions.empty()) {
    return;
  }
  const std::vector<std::string> names = collectNames(run.experiment.model.parameters);
  page.tables["reliability"] = makeReliabilityTable(run);
  page.tables["z-scores"] = makeQuantileTable(run);
  const int n = std::max(1, static_cast<int>(page.tables["z-scores"].countRows() / names.size()));
  Section section{"calibration", "Calibration", "", {}};
  addFigure(makeReliability(names, n, page), section);
  addFigure(makePit(names, n), section);
  addFigure(makeQuantiles(names), section);
  addPosterior(run, section, page);
  addRanks(run, section, page);
  page.sections.push_back(std::move(section));
}

}  // namespace twinmap
