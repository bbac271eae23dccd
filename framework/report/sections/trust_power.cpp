#include "framework/report/html.hpp"
#include "framework/report/sections/sections.hpp"

namespace twinmap {

void addTrustPower(const RunFolder& run, Section& section) {
  const CsvTable& power = run.trust_power;
  if (power.rows.empty()) {
    return;
  }
  CsvTable shown{{"kind", "name", "smallest_change", "unit"}, {}};
  for (std::size_t row = 0; row < power.rows.size(); ++row) {
    const std::string& kind = power.getText(row, "kind");
    shown.rows.push_back({kind, power.getText(row, "name"), power.getText(row, "smallest_change"),
                          kind == "constant" ? "of its value" : power.getText(row, "unit")});
  }
  section.html +=
      makeElement("h3", "What the trust status would find") +
      makeHtmlTable(
          "trust-power",
          "The smallest change of a constant, and the smallest constant offset of an output, that "
          "95 % of the measurements are called a model_mismatch for; a dash where none is found.",
          shown,
          {{"kind", "kind"}, {"name", "name"}, {"smallest_change", "smallest change", 2}, {"unit", "unit"}});
}

}  // namespace twinmap
