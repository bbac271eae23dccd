#include "framework/report/html.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {

void addTrustPower(const RunFolder& run, Section& section) {
  const CsvTable& power = run.trust_power;
  if (power.rows.empty()) {
    return;
  }
  std::vector<std::vector<HtmlCell>> rows;
  for (std::size_t row = 0; row < power.rows.size(); ++row) {
    const bool relative = power.getText(row, "kind") == "constant";
    rows.push_back({makeTextCell(power.getText(row, "kind")), makeTextCell(power.getText(row, "name")),
                    makeNumberCell(power.getText(row, "smallest_change"), 2),
                    makeTextCell(relative ? "of its value" : power.getText(row, "unit"))});
  }
  section.html +=
      makeElement("h3", "What the trust status would find") +
      makeHtmlTable("trust-power",
                    "The smallest change of a constant, and the smallest constant offset of an output, that "
                    "95 % of the measurements are called a model_mismatch for; a dash where none is found.",
                    {"kind", "name", "smallest change", "unit"}, rows);
}

}  // namespace twinmap
