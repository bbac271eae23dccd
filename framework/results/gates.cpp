#include "framework/results/gates.hpp"

#include <fmt/core.h>

#include <cmath>

#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

std::string makeCondition(const GateSpec& gate) {
  std::string text = gate.min ? toText(*gate.min) + " \u2264 " : "";
  text += gate.metric.text;
  text += gate.max ? " \u2264 " + toText(*gate.max) : "";
  return text + ", " + (gate.parameter ? gate.parameter->text : "every parameter");
}

bool isWithin(const GateSpec& gate, double value) {
  return std::isfinite(value) && (!gate.min || value >= *gate.min) && (!gate.max || value <= *gate.max);
}

std::string makeFound(const CsvTable& metrics, std::size_t row, double value) {
  return metrics.getText(row, "parameter") + " " +
         (std::isfinite(value) ? toShortText(value, kFigureDigits) : "no value");
}

/// "d_y 0.99; 3 of 4 values passed": what failed first, for many values that alone.
std::string summarize(const std::string& passed, const std::string& failed, int passed_count, int count) {
  constexpr int kMaxListed = 8;
  if (count <= kMaxListed) {
    return failed.empty() ? passed : "failed: " + failed + (passed.empty() ? "" : "; passed: " + passed);
  }
  const std::string counts = fmt::format("{} of {} values passed", passed_count, count);
  return failed.empty() ? counts : counts + "; failed first: " + failed.substr(0, failed.find(','));
}

void append(std::string& list, const std::string& item) {
  list += (list.empty() ? "" : ", ") + item;
}

}  // namespace

GateResult checkGate(const GateSpec& gate, const CsvTable& metrics) {
  std::string passed, failed;
  int passed_count = 0, count = 0;
  for (std::size_t row = 0; row < metrics.rows.size(); ++row) {
    if (gate.parameter && metrics.getText(row, "parameter") != gate.parameter->text) {
      continue;
    }
    const double value = metrics.getNumber(row, gate.metric.text);
    const bool within = isWithin(gate, value);
    append(within ? passed : failed, makeFound(metrics, row, value));
    passed_count += within ? 1 : 0;
    ++count;
  }
  if (!metrics.hasColumn(gate.metric.text) || count == 0) {
    return {makeCondition(gate), "metrics.csv has no value of it", false};
  }
  return {makeCondition(gate), summarize(passed, failed, passed_count, count), passed_count == count};
}

std::vector<GateResult> checkGates(const std::vector<GateSpec>& gates, const CsvTable& metrics) {
  std::vector<GateResult> results;
  for (const GateSpec& gate : gates) {
    results.push_back(checkGate(gate, metrics));
  }
  return results;
}

}  // namespace twinmap
