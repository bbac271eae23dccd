#include "framework/inference/clock/clock_fault.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/estimation/levels.hpp"

namespace twinmap {
namespace {

std::string describeRate(const NuisanceSize& part) {
  const double rate = part.value / (1.0 - part.value);  // stamps over true times, less 1
  return fmt::format("the clock runs {} % {} (sd {} %)", toShortText(100.0 * std::abs(rate), kStddevDigits),
                     rate > 0.0 ? "fast" : "slow", toShortText(100.0 * part.stddev, kStddevDigits));
}

std::string describeLateness(const NuisanceSize& part, bool is_further) {
  const std::string from =
      part.from ? fmt::format("from t = {} s on ", toShortText(*part.from, kEstimateDigits)) : "";
  const char* direction = is_further         ? (part.value > 0.0 ? "later" : "earlier")
                          : part.value > 0.0 ? "late"
                                             : "early";
  return fmt::format("{}{} {} ms {} (sd {} ms)", from, is_further ? "it is" : "the record is",
                     toShortText(1e3 * std::abs(part.value), kStddevDigits), direction,
                     toShortText(1e3 * part.stddev, kStddevDigits));
}

}  // namespace

bool isRate(const NuisanceSize& part) {
  return part.name == "rate";
}

double calcShape(const NuisanceSize& part, double stamp) {
  return isRate(part) ? stamp : part.from && stamp < *part.from ? 0.0 : 1.0;
}

double calcLateness(const std::vector<NuisanceSize>& parts, double stamp) {
  double lateness = 0.0;
  for (const NuisanceSize& part : parts) {
    lateness += part.value * calcShape(part, stamp);
  }
  return lateness;
}

std::string describeClock(const std::vector<NuisanceSize>& parts) {
  std::vector<NuisanceSize> in_order = parts;
  std::stable_sort(in_order.begin(), in_order.end(),
                   [](const NuisanceSize& a, const NuisanceSize& b) { return a.from < b.from; });
  std::string said;
  for (const NuisanceSize& part : in_order) {
    said += (said.empty() ? "" : "; ") +
            (isRate(part) ? describeRate(part) : describeLateness(part, !said.empty()));
  }
  return said;
}

}  // namespace twinmap
