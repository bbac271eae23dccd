#include <fmt/core.h>

#include "framework/report/sections/calibration_tables.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {
namespace {

constexpr const char* kRanks = "ranks";

/// A quantity of sbc.csv: a parameter, or all together.
struct RankedQuantity {
  std::string name;
  double p_value = 0.0;
};

std::vector<RankedQuantity> listQuantities(const CsvTable& sbc) {
  std::vector<RankedQuantity> quantities;
  for (std::size_t row = 0; row < sbc.rows.size(); ++row) {
    const std::string& name = sbc.getText(row, "quantity");
    if (quantities.empty() || quantities.back().name != name) {
      quantities.push_back({name, sbc.getNumber(row, "p_value")});
    }
  }
  return quantities;
}

DataTable makeRankTable(const CsvTable& sbc) {
  DataTable table;
  table.add("quantity", sbc.listTexts("quantity"));
  for (const char* column : {"lower", "upper", "count"}) {
    table.add(column, sbc.listNumbers(column));
  }
  return table;
}

Panel makeRankPanel(const RankedQuantity& quantity, bool is_joint, const std::string& color,
                    const CountBand& band) {
  const std::string label =
      fmt::format("{} (p = {:.2g})", is_joint ? "all together" : quantity.name, quantity.p_value);
  return {kRanks,
          {{"name", quantity.name}, {"label", label}, {"color", color}},
          {{"low", band.lower}, {"high", band.upper}}};
}

}  // namespace

void addRanks(const RunFolder& run, Section& section, Page& page) {
  if (run.sbc.empty()) {
    return;
  }
  page.tables[kRanks] = makeRankTable(run.sbc);
  const auto measurements = static_cast<int>(run.sbc.getNumber(0, "measurements"));
  const auto unreliable = static_cast<int>(run.sbc.getNumber(0, "unreliable"));
  const std::vector<RankedQuantity> quantities = listQuantities(run.sbc);
  const CountBand band =
      calcCountBand(measurements, static_cast<int>(run.sbc.rows.size() / quantities.size()));
  Figure figure{kRanks,
                "Calibration of the posteriors",
                fmt::format("Ranks of the true values among draws of the posteriors that infer --posterior "
                            "samples, of {} test samples ({} unreliable ones are left out): flat within the "
                            "grey band where calibrated. p: how often right posteriors look no flatter.",
                            measurements, unreliable),
                kRanks,
                {},
                {},
                quantities.size() >= 4 ? 4 : 0};
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    const bool is_joint = q + 1 == quantities.size();
    figure.panels.push_back(
        makeRankPanel(quantities[q], is_joint, is_joint ? "var(--quiet)" : getColor(q), band));
  }
  addFigure(std::move(figure), section);
}

}  // namespace twinmap
